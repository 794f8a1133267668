/// Errors of frequent figures, beside their stated standard deviations.
#pragma once

#include <cmath>

#include "hammer_loads/util/functions.h"

namespace hammer_loads::accuracy {

class FigureErrors {
 public:
  struct Result {
    double rms{}, said{};  ///< root mean squares of errors and of standard deviations
    double covered{};      ///< part of the errors within two of their deviations
  };

  void add(double error, double deviation) {
    ++count_;
    sum_ += error, squares_ += square(error), said_ += square(deviation);
    inside_ += std::abs(error) <= 2.0 * deviation;
  }
  void addRelative(double found, double truth, double deviation) {
    add((found - truth) / truth, deviation / std::abs(truth));
  }
  /// In parts of `unit`.
  Result result(double unit = 1.0) const {
    return {std::sqrt(squares_ / count_) / unit, std::sqrt(said_ / count_) / unit, inside_ / count_};
  }
  double bias() const { return sum_ / count_; }  ///< mean error
  double count() const { return count_; }

 private:
  double count_{}, sum_{}, squares_{}, said_{}, inside_{};
};

}  // namespace hammer_loads::accuracy
