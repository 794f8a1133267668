/// Uncertain constants: their effect on the filter, and the estimate of the sensor's constants from the innovations.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "hammer_loads/crank/unknowns.h"
#include "hammer_loads/estimation/constant_fit.h"
#include "hammer_loads/linkage/machine_columns.h"

namespace hammer_loads {

/// Errors b of the constants of kUnknowns, in their order, followed by those of the hammer, each in units of its
/// standard deviation (MachineColumn), which are considered but not estimated. The filter carries the derivative of its
/// state by each of them. An innovation is its derivative by b times b plus noise: weighted least squares over some
/// minutes.
///
/// The residual torque of a supply has an effect similar to that of the sensor's mounting: 0.1 to 0.2 deg with the
/// shipped machine, 0.4 deg with jitter or 1024 counts, some three standard deviations. deviation() contains it. The
/// supply's error is therefore estimated as if the sensor's mounting were right, since the two can hardly be separated.
class ConstantErrors {
 public:
  static constexpr int kTable = kUnknowns.size(), kSize = kTable + kMachineColumns, kPlace = countSeen();
  static constexpr int kZero = indexOfUnknown("zero"), kSupply = indexOfUnknown("supply"),
                       kLatency = indexOfUnknown("latency"), kSpeedLag = indexOfUnknown("speed lag"),
                       kSpeedScale = indexOfUnknown("speed scale");
  static constexpr double kUnknownZero = 0.09;     ///< [rad]: a coupling slips by up to 10 deg
  static constexpr double kCalibratedZero = 0.02;  ///< [rad]: a zero of a smaller standard deviation needs no proof
  /// Standard deviation of estimate() by an elastic connecting rod, which imitates an error of the zero [rad].
  static constexpr double kRodHides = 0.01;
  using Row = Eigen::Matrix<double, 1, kSize>;      ///< derivative of a number by b
  using Vector = Eigen::Matrix<double, kTable, 1>;  ///< errors of the table alone
  using Matrix = Eigen::Matrix<double, kTable, kTable>;

  /// Standard deviations of the table.
  static Vector priors() noexcept {
    Vector prior;
    for (int i = 0; i < kTable; ++i) prior[i] = kUnknowns[static_cast<std::size_t>(i)].prior;
    return prior;
  }
  /// prior: standard deviations, >= 0. zero_std: of the encoder's zero until the turns show its error [rad], >= 0.
  explicit ConstantErrors(const Vector& prior = priors(), double zero_std = kUnknownZero) noexcept;

  /// d(reading)/db.
  static Row ofAngle(const ReadingPlace& at) noexcept {
    return row([&](const Unknown& u) { return u.of_angle(at); }, kIndices);
  }
  /// d(measured speed)/db.
  static Row ofSpeed(const ReadingPlace& at) noexcept {
    return row([&](const Unknown& u) { return u.of_speed(at); }, kIndices);
  }
  /// d(the filter's torque)/db by a step.
  static Row ofTorque(const SupplyLaw& supply, double lead) noexcept {
    return row([&](const Unknown& u) { return u.of_torque(supply, lead); }, kIndices);
  }

  /// innovation of an angle, its variance and its derivative by b.
  void learn(double innovation, double variance, const Row& by_error) noexcept;
  /// Once a turn. growth: what variances are to be multiplied with; count: of the encoder [rad].
  void endTurn(double growth, double count) noexcept;

  /// Sets the improved standard deviation of a considered constant.
  void consider(int constant, double deviation) noexcept;
  /// Present standard deviation of a considered constant.
  double considered(int constant) const noexcept { return prior_[constant]; }
  /// Notes that the encoder's zero was moved by an amount with this variance [rad2].
  void stepZero(double variance) noexcept;
  /// Notes a change of the supply's stiffness [SupplyLaw::unit].
  void takeSupply(double change) noexcept;
  /// 0 before some turns. deviation: of the sensor's place alone.
  const Vector& estimate() const noexcept { return estimate_; }
  const Vector& deviation() const noexcept { return deviation_; }
  /// Error of the sensor's zero by the turns so far, for a correct hammer [rad]; 0 if it does not exceed that of a
  /// clean machine. It is available from the first turn on, before estimate().
  double zeroSeen() const noexcept { return zero_is_seen_ ? zero_looks_ : 0.0; }
  /// zeroSeen() without the threshold of a clean machine: an elastic rod has such an error.
  double zeroLooks() const noexcept { return zero_looks_; }
  /// Returns true after enough turns for estimate() and deviation().
  bool knows() const noexcept;
  int turns() const noexcept { return turns_; }
  /// Returns true if the turns have shown the zero, or if its given deviation is small. Until then moment() contains
  /// the given deviation, since the estimate of a zero that is 8 deg off may pass through 0 in the first turns.
  bool zeroIsShown() const noexcept { return zeroIsGiven() || (knows() && !zero_is_doubted_); }
  bool zeroIsGiven() const noexcept { return zero_given_ < kCalibratedZero; }
  /// Sets whether the search over the whole turn contradicts estimate().
  void doubtZero(bool doubted) noexcept { zero_is_doubted_ = doubted; }
  /// The zero's estimate is linear: the filter adapts to a zero that is off, so that 2 deg look like 1.7 deg and 3.4
  /// deg like 1.1 to 1.6 deg. Standard deviation by that [rad], beside deviation().
  double zeroNotLinear() const noexcept { return kNotLinear * estimate_[kZero] * estimate_[kZero]; }
  /// Standard deviation of the dead centre's place in the encoder's readings [rad]. It includes the apparent error of a
  /// correct zero on a clean machine.
  double zeroDeviation() const noexcept;
  /// Second moment of b by the innovations: contribution of an uncorrected b to the uncertainty.
  const Matrix& moment() const noexcept { return moment_; }
  /// L with L L^T = moment(): its columns are errors that are independent of each other.
  const Matrix& root() const noexcept { return root_; }
  /// Derivatives by the constants become columns of independent errors of one standard deviation each.
  template <int numbers>
  static void toColumns(const Matrix& root, ByConstants<numbers, kSize>& by) noexcept {
    const ByConstants<numbers, kTable> of_table = by.template leftCols<kTable>().lazyProduct(root);
    by.template leftCols<kTable>() = of_table;
  }

 private:
  static constexpr double kNotLinear = 17.0;  ///< [1/rad]: 0.3 deg of 1 deg
  static constexpr auto kIndices = std::make_integer_sequence<std::size_t, kUnknowns.size()>{};
  /// Unrolled, so that what does not enter costs nothing.
  template <typename Function, std::size_t... i>
  static Row row(const Function& of, std::integer_sequence<std::size_t, i...>) noexcept {
    Row all = Row::Zero();
    ((all[i] = of(kUnknowns[i])), ...);
    return all;
  }
  void considerPriors() noexcept;

  Vector prior_;
  double zero_given_{};  ///< [rad]
  ConstantFit<kTable> fit_;
  ByConstants<kPlace, kMachineColumns> beside_{
      ByConstants<kPlace, kMachineColumns>::Zero()};  ///< derivatives of fit_'s score by the hammer's errors
  Vector estimate_{Vector::Zero()}, deviation_{Vector::Zero()};
  Matrix moment_{Matrix::Zero()}, root_{Matrix::Zero()};
  double zero_looks_{};  ///< [rad]
  bool zero_is_seen_{}, zero_is_doubted_{};
  double stepped_{};         ///< variance of the zero's steps [rad2]
  int turns_{}, samples_{};  ///< samples: of this turn
};

}  // namespace hammer_loads
