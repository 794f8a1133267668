/// Errors of estimates beside their stated standard deviations: of figures, of signals, and of the damage-equivalent
/// range of a load.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/life/turn_loads.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::accuracy {

class FigureErrors {
 public:
  struct Result {
    double rms{}, stated{};  ///< root mean squares of errors and of standard deviations
    double covered{};        ///< part of the errors within two of their deviations
    double bias{};           ///< mean error
    double worst{};          ///< largest magnitude of an error
  };

  void add(double error, double deviation) {
    ++count_;
    sum_ += error, squares_ += square(error), stated_ += square(deviation);
    inside_ += std::abs(error) <= 2.0 * deviation;
    worst_ = std::max(worst_, std::abs(error));
  }
  void addRelative(double found, double truth, double deviation) {
    add((found - truth) / truth, deviation / std::abs(truth));
  }
  /// In parts of `unit`.
  Result result(double unit = 1.0) const {
    return {std::sqrt(squares_ / count_) / unit, std::sqrt(stated_ / count_) / unit, inside_ / count_,
            sum_ / count_ / unit, worst_ / unit};
  }
  double count() const { return count_; }
  double squares() const { return squares_; }  ///< sum of the squares of the errors

 private:
  double count_{}, sum_{}, squares_{}, stated_{}, inside_{}, worst_{};
};

/// Errors over root mean square and over the largest of the truth.
struct SignalError {
  double square{}, size{}, worst{}, largest{}, sum[2]{}, squares[2]{}, product{};
  double lowest{1e300}, highest{-1e300};
  int count{};
  void add(double estimate, double truth) {
    sum[0] += estimate, sum[1] += truth, squares[0] += estimate * estimate, squares[1] += truth * truth;
    product += estimate * truth;
    square += std::pow(estimate - truth, 2), size += truth * truth, ++count;
    lowest = std::min(lowest, truth), highest = std::max(highest, truth);
    worst = std::max(worst, std::abs(estimate - truth)), largest = std::max(largest, std::abs(truth));
  }
  double range() const { return highest - lowest; }
  double rms() const { return std::sqrt(square / size); }
  double rmsOfRange() const { return std::sqrt(square / count) / range(); }
  double rmsOfLargest() const { return std::sqrt(square / count) / largest; }
  double correlation() const {
    return (product - sum[0] * sum[1] / count) /
           std::sqrt((squares[0] - sum[0] * sum[0] / count) * (squares[1] - sum[1] * sum[1] / count));
  }
  double worstOfLargest() const { return worst / largest; }
};

constexpr double kLifeSlope = 5.0;  ///< slope of the S-N line; the damage errs about this many times as much

/// Error of the damage-equivalent range over the true one, > 0 too large, and its stated standard deviations, of single
/// revolutions and of the part equal in all of them; NaN: none.
struct LifeFigure {
  double error{}, own{}, common{};
};

/// Cycles of both series, sample by sample, counted by ASTM E1049, without a grid.
struct LifeError {
  void add(double estimate, double truth, const life::LoadError& stated = {}) {
    estimated_.add(estimate);
    turn_.add(estimate, stated);
    right_.add(truth);
  }
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
