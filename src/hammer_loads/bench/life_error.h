/// How far the damage-equivalent range of an estimated load is from that of the true one.
#pragma once

#include <string>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/exact_cycles.h"
#include "hammer_loads/life/load_error.h"

namespace hammer_loads::accuracy {

constexpr double kLifeSlope = 5.0;  ///< of the S-N line; damage errs about this many times as much

/// Of the damage-equivalent range, over the true one: the error, > 0 too large, and the standard deviations that are
/// said of it, of turns and of what is the same in all of them; NaN: none is.
struct LifeFigure {
  double error{}, own{}, common{};
};

/// Both series sample by sample; cycles counted by ASTM E1049, without a grid.
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

/// Of what a ledger has counted of a channel, its instants between samples among them, against the true load's cycles.
LifeFigure figureOf(const life::CycleCount& counted, const life::ExactCycles& right);

/// As a JSON object; what is not known is null.
std::string json(const LifeFigure& figure);

}  // namespace hammer_loads::accuracy
