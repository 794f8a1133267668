/// Comparison of the computed load on the hull with a measured one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Agreement of one component of the computed load with the measured one.
struct ReferenceFigures {
  std::uint64_t samples{};
  double rms{kNaN};             ///< root mean square of the measured load [N, N m]
  double rms_error{kNaN};       ///< root mean square of computed minus measured [N, N m]
  double bias{kNaN};            ///< mean of computed minus measured [N, N m]
  double scale{kNaN};           ///< slope of the computed load over the measured one, by least squares [-]
  double correlation{kNaN};     ///< Pearson's [-]
  double within_two_std{kNaN};  ///< fraction of errors within two of the stated standard deviations [-]
};

/// Compares at the stamps of the measured load. The computed load is interpolated between two samples. Measured loads
/// between samples with a blow or a gap, or more than kKept samples back, are left out. No output depends on it.
class ReferenceComparison {
 public:
  static constexpr std::size_t kComponents = 3;  ///< force x, force z, torque y
  static constexpr std::array<const char*, kComponents> kNames{"force_x", "force_z", "torque_y"};
  using Values = std::array<double, kComponents>;

  /// Takes a measured load on the hull as in ~hull_wrench. NaN: that component is not measured.
  void measured(StampNs stamp, const Values& values);
  /// Takes a computed load; stamps increase. continues: neither a gap nor a blow since the previous sample.
  void computed(StampNs stamp, const HullWrench& wrench, const HullWrench& deviation, bool continues);

  std::uint64_t received() const { return received_; }  ///< number of measured loads
  std::uint64_t leftOut() const { return left_out_; }   ///< number of samples without a computed load at their instant
  ReferenceFigures figures(std::size_t component) const;

 private:
  static constexpr std::size_t kKept = 1024;
  struct Computed {
    StampNs stamp{};
    Values load{}, deviation{};
    bool continues{};
  };
  struct Measured {
    StampNs stamp{};
    Values load{};
  };
  /// Means and sums of products about them, by Welford's recursion.
  struct Sums {
    std::uint64_t count{}, within{};
    double mean_computed{}, mean_measured{}, computed_square{}, measured_square{}, product{};
    void add(double computed, double measured, double deviation) noexcept;
  };

  void match();
  void compare(const Computed& before, const Computed& after, const Measured& measured) noexcept;

  std::deque<Computed> computed_;
  std::deque<Measured> waiting_;
  std::array<Sums, kComponents> sums_;
  std::uint64_t received_{}, left_out_{};
};

}  // namespace hammer_loads
