/// Classes of equal width over a channel's declared full scale, which bound the memory of a count.
#pragma once

#include <cmath>
#include <cstdint>

#include "hammer_loads/util/checked.h"

namespace hammer_loads::life {

/// Class i holds [least + i width, least + (i + 1) width) and stands for its centre; the last one holds `greatest` too.
/// The error of an extreme is at most half a width, that of a range less than one width.
class LoadGrid {
 public:
  static constexpr std::uint32_t kMostClasses = 16384;  ///< a matrix of 268 MB

  /// `least` < `greatest`, both finite, in the channel's unit; 2 to kMostClasses classes.
  static Checked<LoadGrid> make(double least, double greatest, std::int64_t classes);

  double least() const { return least_; }
  double greatest() const { return greatest_; }
  std::uint32_t classes() const { return classes_; }
  double width() const { return width_; }  ///< [channel's unit]

  /// Class of a value within the full scale; values beyond it fall into the outer classes.
  std::uint32_t classOf(double value) const noexcept {
    const double place = (value - least_) * per_width_;
    if (!(place > 0.0)) return 0;
    return place < last_ ? static_cast<std::uint32_t>(place) : classes_ - 1;
  }
  /// Centre of a class.
  double level(std::uint32_t index) const noexcept { return least_ + (index + 0.5) * width_; }
  /// Between the centres of two classes that are `steps` apart.
  double range(std::uint32_t steps) const noexcept { return steps * width_; }
  /// Middle between the centres of class `low` and of the one `steps` above.
  double mean(std::uint32_t low, std::uint32_t steps) const noexcept {
    return least_ + (low + 0.5 * steps + 0.5) * width_;
  }

  bool operator==(const LoadGrid& other) const {
    return least_ == other.least_ && greatest_ == other.greatest_ && classes_ == other.classes_;
  }
  bool operator!=(const LoadGrid& other) const { return !(*this == other); }

 private:
  LoadGrid(double least, double greatest, std::uint32_t classes)
      : least_(least),
        greatest_(greatest),
        classes_(classes),
        width_((greatest - least) / classes),
        per_width_(classes / (greatest - least)),
        last_(classes - 1.0) {}

  double least_, greatest_;
  std::uint32_t classes_;
  double width_, per_width_, last_;
};

}  // namespace hammer_loads::life
