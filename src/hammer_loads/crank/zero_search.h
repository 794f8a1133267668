/// Search for the encoder's zero over the whole revolution, by the times at which the crank passes places of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {

/// Between two blows the drive's torque exchanges energy with the variable inertia J of the links:
///
///     (Jc + J(phi)) w^2/2 = E0 + tau phi + K integral(W t - phi) dphi + work of the weight,
///
/// phi = angle since a quarter of a revolution after the blow, W = mean speed, K = stiffness of the supply. The time
/// from one place to the next follows from it. The search fits the mean times of some revolutions by E0, tau, K, the
/// logarithm of Jc and the error of the zero (Gauss-Newton), starting from each of 48 places. It leaves out the quarter
/// after the blow, where an elastic connecting rod vibrates and where restitution and blank firing act.
///
/// The result is independent of the filter and of measured speeds. It is accurate to some 2 deg, since the supply is
/// not linear and errors of the lengths of 0.3 mm shift it by up to 1.6 deg. The filter refines it.
class ZeroSearch {
 public:
  /// drive_inertia: first guess [kg m2], > 0.
  ZeroSearch(const ShaftModel& model, double drive_inertia) noexcept : model_(model), drive_inertia_(drive_inertia) {}

  /// Adds a sample. angle: crank angle by the present zero [rad]; step: time since the sample before [s], 0 if not
  /// known; hull: its motion, for the weight. Allocates nothing; takes 0.2 ms in a revolution that is evaluated.
  void add(double angle, double step, const HullMotion& hull) noexcept;
  /// Sets whether a due fit is computed; the times are collected in any case.
  void setWanted(bool wanted) noexcept { wanted_ = wanted; }
  /// Discards the present revolution, whose times are not those of a blow.
  void skipTurn() noexcept { skips_ = true; }
  /// Restarts the collection of revolutions after the encoder has moved.
  void restart() noexcept;
  struct Found {
    double error{};      ///< error of the present zero: crank angle by it at the blow [rad], in (-pi, pi]
    double deviation{};  ///< standard deviation by the scatter of the times alone [rad]
  };
  /// Result; empty before three revolutions, and if no place of the blow explains the times, as at constant speed.
  const std::optional<Found>& found() const noexcept { return found_; }
  /// Mean rotation of the crank between samples [rad].
  double stepAngle() const noexcept { return turn_time_ > 0.0 ? kTwoPi * step_ / turn_time_ : kTwoPi; }
  int evaluations() const noexcept { return evaluations_; }  ///< number of fits so far

 private:
  static constexpr int kPlaces = 48;  ///< number of places of a revolution
  static constexpr double kWidth = kTwoPi / kPlaces;
  static constexpr int kFrom = kPlaces / 4;  ///< first place after the blow that is compared
  static constexpr int kUnknowns = 6;        ///< logarithm of Jc, E0, tau, K, zero, time of the first place
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  struct Point {
    double angle{}, time{};
  };
  /// Squares of the times' residuals [s2], and the unknowns with their information.
  struct Fit {
    double squares{};
    Vector unknowns{Vector::Zero()};
    Matrix information{Matrix::Zero()};
  };
  /// Reflected inertia and weight's torque from place to place of a revolution that begins at the blow.
  struct Table {
    std::array<double, 2 * kPlaces + 1> inertia;  ///< at places and halfway between them [kg m2]
    std::array<double, kPlaces> weight;           ///< halfway [N m]
  };

  /// Part between two places; angle, work of the weight and the lead's integral count from the first place.
  struct Stretch {
    std::size_t place{};
    double took{};       ///< [s]
    double angle{};      ///< [rad]
    double work{};       ///< [J]
    double by_supply{};  ///< integral of W t - phi over the angle [rad2]
  };

  void pass(double place_time, std::int64_t place) noexcept;
  double timeAt(double angle) const noexcept;
  void endTurn() noexcept;
  void evaluate() noexcept;
  Table tableAt(double zero) const noexcept;
  double time(int blow, int place) const noexcept { return times_[static_cast<std::size_t>((blow + place) % kPlaces)]; }
  template <typename Use>
  void forEachStretch(int blow, const Table& table, const Use& use) const noexcept;
  Vector guess(int blow, const Table& table) const noexcept;
  Fit step(int blow, const Table& table, const Vector& unknowns, bool with_zero) const noexcept;
  double deviationOfZero(const Fit& fit) const noexcept;

  ShaftModel model_;
  double drive_inertia_;
  std::array<Point, 4> last_;  ///< the latest samples, the oldest first
  int samples_{};              ///< number of these, up to 4
  std::int64_t place_{};       ///< last place that was passed
  std::optional<double> place_time_;
  std::array<double, kPlaces> turn_{}, times_{};  ///< from place to place [s]: this revolution, mean of the last
  bool skips_{}, wanted_{true};
  int passed_{};                     ///< places of this revolution
  double turn_time_{};               ///< mean time of a revolution [s]
  double step_{};                    ///< mean time between samples [s]
  int to_{kPlaces - 1};              ///< end of the places that are compared
  int turns_{}, due_{kTurnsToKnow};  ///< revolutions collected; and at next fit
  std::optional<Found> found_;
  int evaluations_{};
  static constexpr int kTurnsToKnow = 3;
};

}  // namespace hammer_loads
