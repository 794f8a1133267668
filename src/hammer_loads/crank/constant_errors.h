/// Uncertain constants of crank sensor and drive: their table, their effect on the filter, and their estimate from the
/// innovations.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/machine_columns.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {

/// Least squares for errors of constants. An innovation is its derivative by the constants times their errors, plus
/// noise. Information and score are summed over the measurements; old ones fade.
template <int constants>
class ConstantFit {
 public:
  using Row = Eigen::Matrix<double, 1, constants>;
  using Vector = Eigen::Matrix<double, constants, 1>;
  using Matrix = Eigen::Matrix<double, constants, constants>;

  /// Restarts from the priors: standard deviation of each error, >= 0. 0 adds no information: it is not estimated.
  void begin(const Vector& prior) noexcept {
    information_ = (prior.array() > 0.0).select(prior.cwiseAbs2().cwiseInverse(), 0.0).matrix().asDiagonal();
    score_.setZero();
  }
  /// Adds an innovation and returns its weight; beyond the gate it counts as the gate. by_constant: dz/dp - H V.
  double learn(double innovation, double variance, const Row& by_constant) noexcept {
    const double weight = weightWithin(gate::kRare, innovation, variance) / variance;
    information_.noalias() += (weight * by_constant.transpose()) * by_constant;
    score_ += (weight * innovation) * by_constant.transpose();
    return weight;
  }
  /// Notes that one of the constants has been changed by this amount.
  void shift(int constant, double change) noexcept { score_ += information_.col(constant) * change; }
  /// Reduces the weight of earlier measurements to this part.
  void fade(double part) noexcept { information_ *= part, score_ *= part; }

  const Matrix& information() const noexcept { return information_; }
  const Vector& score() const noexcept { return score_; }
  /// Covariance of the first `count` constants for exact others, since all together may hardly be separable.
  template <int count>
  Eigen::Matrix<double, count, count> covarianceOfFirst() const noexcept {
    return information_.template topLeftCorner<count, count>().inverse();
  }

 private:
  Matrix information_{Matrix::Zero()};
  Vector score_{Vector::Zero()};
};

/// Place of a reading on the shaft of the encoder.
struct ReadingPlace {
  double offset{};        ///< offset from the blow, within half a revolution [rad]
  double speed{};         ///< [rad/s]
  double acceleration{};  ///< [rad/s2]
};

/// Sine and cosine within 0.1 % for |x| <= 3/4 of a revolution, by two parabolas.
constexpr double roughSine(double x) noexcept {
  const double part = x * (2.0 / kTwoPi), y = 4.0 * part * (1.0 - (part < 0.0 ? -part : part));
  return y * (0.775 + 0.225 * (y < 0.0 ? -y : y));
}
constexpr double roughCosine(double x) noexcept { return roughSine(0.25 * kTwoPi - (x < 0.0 ? -x : x)); }

/// The error p of one constant: its prior, and its effect on readings and torque.
struct Unknown {
  enum class Use {
    kSeen,        ///< estimated from the innovations; not corrected, but reported and included in the deviations
    kTakenUp,     ///< estimated from the innovations, separately; its owner corrects the constant
    kConsidered,  ///< considered with its prior, not estimated
  };
  const char* name;  ///< name of its warning; adjacent rows of one name are one amount, root of the sum of squares
  const char* key;   ///< key in the parameter file
  Use use;
  double prior;                                        ///< default standard deviation
  double unmodelled;                                   ///< apparent standard deviation on a correct machine, for kSeen
  double (*of_angle)(const ReadingPlace&);             ///< d(read angle)/dp
  double (*of_speed)(const ReadingPlace&);             ///< d(read speed)/dp
  double (*of_torque)(const SupplyLaw&, double lead);  ///< d(change of the filter's torque in a step)/dp
  double notable;                                      ///< threshold of the warning
  std::string (*warning)(double amount, double deviation);
  bool of_reading{};  ///< true if its key refers to the reading: the amount there is that of the crank angle over the
                      ///< sensor's gain
};

namespace unknown {

inline constexpr double kDegree = kTwoPi / 360.0;

inline double notOfReading(const ReadingPlace&) { return 0.0; }
inline double notOfTorque(const SupplyLaw&, double) { return 0.0; }

inline std::string ofZero(double amount, double deviation) {
  return format(
      "crank_zero_rad: the readings look as if the blow came at %.2g rad (%.2g deg, deviation "
      "%.1g deg) more than given; a tool met before the dead centre or a supply without oil "
      "compliance looks alike: run calibrate",
      amount, amount / kDegree, deviation / kDegree);
}
inline std::string ofEccentricity(double amount, double deviation) {
  return format(
      "crank encoder: looks eccentric by %.2g deg (crank_eccentricity_1_rad: %.2g rad, "
      "deviation %.1g deg) more than given: run calibrate",
      amount / kDegree, amount, deviation / kDegree);
}

}  // namespace unknown

/// Table of the constants; those of kSeen come first. A sensor reads angle + b0 + b1 sin(angle) + b2 (cos(angle) - 1)
/// [rad], so that b0 alone shifts the blow. Correct machines show 0.10, 0.11 and 0.23 deg of these. From 0.3 and 0.5
/// deg on the wrench is some 0.9 % worse. The priors of the speed rows hold for a drive that filters. With a quarter of
/// them and a lag of 10 ms the error in the first second would be twice the allowed one.
inline constexpr std::array<Unknown, 7> kUnknowns{{
    {"zero", "crank_zero_rad", Unknown::Use::kSeen, 0.05, 1.7e-3, [](const ReadingPlace&) { return 1.0; },
     unknown::notOfReading, unknown::notOfTorque, 0.3 * unknown::kDegree, unknown::ofZero, true},
    {"eccentricity", "crank_eccentricity_1_rad", Unknown::Use::kSeen, 0.05, 2e-3,
     [](const ReadingPlace& at) { return roughSine(at.offset); },
     [](const ReadingPlace& at) { return at.speed * roughCosine(at.offset); }, unknown::notOfTorque,
     0.5 * unknown::kDegree, unknown::ofEccentricity},
    {"eccentricity", "crank_eccentricity_1_rad", Unknown::Use::kSeen, 0.05, 4e-3,
     [](const ReadingPlace& at) { return roughCosine(at.offset) - 1.0; },
     [](const ReadingPlace& at) { return -at.speed * roughSine(at.offset); }, unknown::notOfTorque,
     0.5 * unknown::kDegree, unknown::ofEccentricity},
    {"supply", nullptr, Unknown::Use::kTakenUp, 0.2, 0.0, unknown::notOfReading, unknown::notOfReading,
     [](const SupplyLaw& supply, double lead) { return -supply.unit * lead; }, 0.0, nullptr},
    {"latency", "crank_latency_s", Unknown::Use::kConsidered, 0.0, 0.0,
     [](const ReadingPlace& at) { return -at.speed; }, [](const ReadingPlace& at) { return -at.acceleration; },
     unknown::notOfTorque, 0.0, nullptr},
    {"speed lag", nullptr, Unknown::Use::kConsidered, 4e-3, 0.0, unknown::notOfReading,
     [](const ReadingPlace& at) { return -at.acceleration; }, unknown::notOfTorque, 0.0, nullptr},
    {"speed scale", nullptr, Unknown::Use::kConsidered, 0.04, 0.0, unknown::notOfReading,
     [](const ReadingPlace& at) { return at.speed; }, unknown::notOfTorque, 0.0, nullptr},
}};

/// Number of constants of kSeen, which come first.
constexpr int countSeen() noexcept {
  int count = 0;
  for (const Unknown& u : kUnknowns) count += u.use == Unknown::Use::kSeen;
  return count;
}
/// Index in the table; an unknown name does not compile where the index is needed at compile time.
constexpr int indexOfUnknown(const char* name) {
  std::size_t i = 0;
  for (bool found = false; i < kUnknowns.size() && !found; i += !found) {
    const char *a = kUnknowns[i].name, *b = name;
    while (*a != '\0' && *a == *b) ++a, ++b;
    found = *a == *b;
  }
  return i < kUnknowns.size() ? static_cast<int>(i) : throw "no such unknown";  // in one expression, for GCC 9
}

/// Errors b of the constants of kUnknowns, in their order, followed by those of the hammer in units of their standard
/// deviations (MachineColumn). The latter are considered but not estimated. The filter carries the derivative of its
/// state by each of them. An innovation is its derivative by b times b plus noise: weighted least squares over some
/// minutes.
///
/// The residual torque of a supply has an effect similar to that of the sensor's mounting: 0.1 to 0.2 deg with the
/// shipped machine, 0.4 deg with jitter or 1024 counts, some three standard deviations. deviation() contains it. The
/// supply's error is therefore estimated as if the sensor's mounting were right, since the two can hardly be separated.
class ConstantErrors {
 public:
  /// kSize: rounded up, since four columns are computed at once; the last ones may be zero.
  static constexpr int kTable = kUnknowns.size(), kSize = (kTable + kMachineColumns + 3) / 4 * 4, kPlace = countSeen();
  static constexpr int kZero = indexOfUnknown("zero"), kSupply = indexOfUnknown("supply"),
                       kLatency = indexOfUnknown("latency"), kSpeedLag = indexOfUnknown("speed lag"),
                       kSpeedScale = indexOfUnknown("speed scale");
  static constexpr double kUnknownZero = 0.09;     ///< [rad]: a coupling slips by up to 10 deg
  static constexpr double kCalibratedZero = 0.02;  ///< [rad]: a smaller standard deviation needs no proof
  /// Standard deviation of estimate() by an elastic connecting rod, which imitates an error of the zero [rad].
  static constexpr double kRodHides = 0.01;
  // Prior: kUnknownZero, kRodHides
  using Row = ByConstants<1, kSize>;                ///< derivative of a number by b
  using Vector = Eigen::Matrix<double, kTable, 1>;  ///< errors of the table alone
  using Matrix = Eigen::Matrix<double, kTable, kTable>;

  /// Standard deviations of the table.
  static Vector priors() noexcept {
    Vector prior;
    for (int i = 0; i < kTable; ++i) prior[i] = kUnknowns[static_cast<std::size_t>(i)].prior;
    return prior;
  }
  /// prior: standard deviations, >= 0. zero_std: that of the encoder's zero until its error is identified [rad], >= 0.
  explicit ConstantErrors(const Vector& prior = priors(), double zero_std = kUnknownZero) noexcept;

  /// d(reading)/db.
  static Row ofAngle(const ReadingPlace& at) noexcept {
    return row([&](const Unknown& u) { return u.of_angle(at); }, kIndices);
  }
  /// d(measured speed)/db.
  static Row ofSpeed(const ReadingPlace& at) noexcept {
    return row([&](const Unknown& u) { return u.of_speed(at); }, kIndices);
  }
  /// Derivative by b of the change of the filter's torque in a step.
  static Row ofTorque(const SupplyLaw& supply, double lead) noexcept {
    return row([&](const Unknown& u) { return u.of_torque(supply, lead); }, kIndices);
  }

  /// Adds the innovation of an angle with its variance and its derivative by b.
  void learn(double innovation, double variance, const Row& by_error) noexcept;
  /// Updates the estimate once a revolution. growth: factor on variances; count: count of the encoder [rad].
  void endTurn(double growth, double count) noexcept;

  /// Sets the improved standard deviation of a considered constant.
  void setConsidered(int constant, double deviation) noexcept;
  /// Present standard deviation of a considered constant.
  double consideredDeviation(int constant) const noexcept { return prior_[constant]; }
  /// Notes that the encoder's zero was moved by an amount with this variance [rad2].
  void stepZero(double variance) noexcept;
  /// Notes a change of the supply's stiffness [SupplyLaw::unit].
  void shiftSupply(double change) noexcept;
  /// Estimate of b, 0 before some revolutions, and the standard deviation of its part for the sensor's mounting.
  const Vector& estimate() const noexcept { return estimate_; }
  const Vector& deviation() const noexcept { return deviation_; }
  /// Error of the sensor's zero by the revolutions so far, for a correct hammer [rad]; 0 if it does not exceed that of
  /// a correct machine. It is available from the first revolution on, before estimate().
  double zeroSeen() const noexcept { return zero_is_seen_ ? zero_looks_ : 0.0; }
  /// zeroSeen() without its threshold, since an elastic connecting rod causes an apparent error of this kind.
  double zeroLooks() const noexcept { return zero_looks_; }
  /// Returns true after enough revolutions for estimate() and deviation().
  bool isKnown() const noexcept;
  int turns() const noexcept { return turns_; }
  /// Returns true if the revolutions have shown the zero, or if its given deviation is small. Until then moment()
  /// contains the given deviation, since the estimate of a zero that is 8 deg off may pass through 0 at first.
  bool zeroIsShown() const noexcept { return zeroIsGiven() || (isKnown() && !zero_is_contradicted_); }
  bool zeroIsGiven() const noexcept { return zero_given_ < kCalibratedZero; }
  /// Sets whether the search over the whole revolution contradicts estimate().
  void setZeroContradicted(bool contradicted) noexcept { zero_is_contradicted_ = contradicted; }
  /// Standard deviation of the zero's estimate due to its linearity [rad], in addition to deviation(). The filter
  /// adapts to a wrong zero, so that 2 deg appear as 1.7 deg and 3.4 deg as 1.1 to 1.6 deg.
  double zeroNotLinear() const noexcept { return kNotLinear * estimate_[kZero] * estimate_[kZero]; }
  /// Standard deviation of the dead centre's place in the encoder's readings [rad]. It includes the apparent error of a
  /// correct zero.
  double zeroDeviation() const noexcept;
  /// Second moment of b by the innovations: contribution of an uncorrected b to the uncertainty.
  const Matrix& moment() const noexcept { return moment_; }
  /// L with L L^T = moment(): its columns are errors that are independent of each other. Beyond the rows of the
  /// sensor's mounting it is diagonal.
  const Matrix& root() const noexcept { return root_; }
  /// Converts derivatives by the constants to columns of independent errors of one standard deviation each.
  template <int numbers>
  static void toColumns(const Matrix& root, ByConstants<numbers, kSize>& by) noexcept {
    const ByConstants<numbers, kPlace> of_place =
        by.template leftCols<kPlace>().lazyProduct(root.topLeftCorner<kPlace, kPlace>().template cast<float>());
    by.template leftCols<kPlace>() = of_place;
    for (int i = kPlace; i < kTable; ++i) by.col(i) *= static_cast<float>(root(i, i));
  }

 private:
  static constexpr double kNotLinear = 17.0;  ///< [1/rad]: 0.3 deg at an error of 1 deg
  // Prior: kNotLinear
  static constexpr auto kIndices = std::make_integer_sequence<std::size_t, kUnknowns.size()>{};
  /// Evaluates the row unrolled, so that zero terms cost nothing.
  template <typename Function, std::size_t... i>
  static Row row(const Function& of, std::integer_sequence<std::size_t, i...>) noexcept {
    Row all = Row::Zero();
    ((all[i] = static_cast<float>(of(kUnknowns[i]))), ...);
    return all;
  }
  void addConsidered() noexcept;

  Vector prior_;
  double zero_given_{};  ///< [rad]
  ConstantFit<kTable> fit_;
  using ScoreByHammer = Eigen::Matrix<double, kPlace, kMachineColumns, Eigen::RowMajor>;
  ScoreByHammer score_by_hammer_{ScoreByHammer::Zero()};  ///< derivatives of fit_'s score by the hammer's errors
  Vector estimate_{Vector::Zero()}, deviation_{Vector::Zero()};
  Matrix moment_{Matrix::Zero()}, root_{Matrix::Zero()};
  double zero_looks_{};  ///< [rad]
  bool zero_is_seen_{}, zero_is_contradicted_{};
  double stepped_{};  ///< variance of the zero's steps [rad2]
  int turns_{};
};

}  // namespace hammer_loads
