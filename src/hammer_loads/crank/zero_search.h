/// Search for the encoder's zero over the whole turn, by the times at which the crank passes places of a turn.
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
/// phi = angle since a quarter of a turn after the blow, W = mean speed, K = stiffness of the supply. The time from one
/// place to the next follows from it. The search fits the mean times of some turns by E0, tau, K, the logarithm of Jc
/// and the error of the zero (Gauss-Newton), starting from each of 48 places of the turn. The quarter of a turn after
/// the blow is left out: an elastic connecting rod vibrates there, and restitution and blank firing act there.
///
/// The result is independent of the filter and of measured speeds. It is accurate to some 2 deg, since the supply is
/// not linear and errors of the lengths of 0.3 mm shift it by up to 1.6 deg. The filter refines it.
class ZeroSearch {
 public:
  /// drive_inertia: first guess [kg m2], > 0.
  ZeroSearch(const ShaftModel& model, double drive_inertia) noexcept : model_(model), drive_inertia_(drive_inertia) {}

  /// The crank's angle by the zero in force [rad], and the time since the sample before [s]; 0: that is not known.
  /// hull: its motion, for the weight. Allocates nothing; 0.2 ms in a turn that is evaluated.
  void add(double angle, double step, const HullMotion& hull) noexcept;
  /// Sets whether the fit is computed where it is due; the times are gathered all the same.
  void setWanted(bool wanted) noexcept { wanted_ = wanted; }
  /// Discards the present turn, whose times are not those of a blow.
  void skipTurn() noexcept { skips_ = true; }
  /// Restarts the collection of turns after the encoder has moved.
  void restart() noexcept;
  struct Found {
    double error{};      ///< error of the zero in force: the crank's angle by it at the blow [rad], in (-pi, pi]
    double deviation{};  ///< standard deviation by the scatter of the times alone [rad]
  };
  /// Empty before three turns, and if no place of the blow explains the times, as at constant speed.
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
  /// Reflected inertia and weight's torque from place to place of a turn that begins at the blow.
  struct Table {
    std::array<double, 2 * kPlaces + 1> inertia;  ///< at places and halfway between them [kg m2]
    std::array<double, kPlaces> weight;           ///< halfway [N m]
  };

  /// Between two places of a turn; angle, work of the weight and the lead's integral since the first place.
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
  std::int64_t place_{};       ///< the last one that was passed
  std::optional<double> place_time_;
  std::array<double, kPlaces> turn_{}, times_{};  ///< from place to place [s]: of this turn, mean of the last ones
  bool skips_{}, wanted_{true};
  int passed_{};                     ///< places of this turn
  double turn_time_{};               ///< mean of the turns [s]
  double step_{};                    ///< mean of the samples [s]
  int to_{kPlaces - 1};              ///< end of the places that are compared
  int turns_{}, due_{kTurnsToKnow};  ///< collected; evaluated next
  std::optional<Found> found_;
  int evaluations_{};
  static constexpr int kTurnsToKnow = 3;
};

}  // namespace hammer_loads
