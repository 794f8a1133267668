/// Error of the damage-equivalent range of an estimated load.
#pragma once

#include <string>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/life/turn_loads.h"

namespace hammer_loads::accuracy {

constexpr double kLifeSlope = 5.0;  ///< slope of the S-N line; the damage errs about this many times as much

/// Error of the damage-equivalent range over the true one, > 0 too large, and its stated standard deviations, of single
/// revolutions and of the part equal in all of them; NaN: none.
struct LifeFigure {
  double error{}, own{}, common{};
};

/// Cycles of both series, sample by sample, counted by ASTM E1049, without a grid.
struct LifeError {
  void add(double estimate, double truth, const life::LoadError& said = {}) {
    addEstimate(estimate, said), addTruth(truth);
  }
  void addEstimate(double estimate, const life::LoadError& said) {
    estimated_.add(estimate);
    turn_.add(estimate, said);
  }
  void addTruth(double truth) { right_.add(truth); }
  /// Ranges and their deviations are those of turns, as LifeRecorder has them.
  void endTurn();
  LifeFigure figure() const;

 private:
  life::ExactCycles estimated_, right_;
  life::TurnExtremes turn_;
  double square_{}, own_{}, common_{};
};

/// Error of a ledger's count of a channel, which includes instants between samples, against the true load's cycles.
LifeFigure figureOf(const life::CycleCount& counted, const life::ExactCycles& right);

/// Figure as a JSON object; an unknown value is null.
std::string json(const LifeFigure& figure);

}  // namespace hammer_loads::accuracy
