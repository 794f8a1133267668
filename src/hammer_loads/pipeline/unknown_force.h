/// Forces after a blow that every level lacks: friction and clearance of the pins, lasting vibration of the rod.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {

/// A generalised force d on the rocker and a force on the connecting rod, of zero mean and new at each blow. Every load
/// is linear in them: F = F0 + (dF/dpsi'') d/I. Usual encoders do not show them. Their standard deviations therefore
/// follow from the tolerances of the hammer file and from the size of the rod's vibration, and a model that fits the
/// readings does not reduce them. With N the rod's force, N_max and E its greatest value and its greatest moment on the
/// rocker over the last revolution, s the time since the blow and D = exp(-(s/100 ms)^2):
///
///     clearance   closing a clearance c under N_max turns N_max c into the spring energy F^2/(2 k), F = sqrt(2 k c
///                 N_max). Contacts last for a small share of the time: 0.012 F D on the rod in each direction, and
///                 l3/2 times that on the rocker; three times that where the load is an extreme of the revolution
///     friction    2 rho N by the pins at both ends of the rocker, with rho the radius of the friction circle; N is
///                 held for 20 ms
///     damping     0.4 zeta E D, with zeta the standard deviation of the damping ratio; a bending mode of the rod is as
///                 large
///
/// c and rho combine a value of the file and its standard deviation, since no level has clearance in two
/// dimensions, and only elastic has friction. Where level elastic identifies the pins, c consists of the clearance
/// along the rod and a twentieth of the file's, and rho is the remaining standard deviation. The factors are those
/// of simulated machines (doc/model.md 6).
class UnknownForce {
 public:
  enum Source : Eigen::Index { kClearance, kFriction, kDamping, kSources };
  /// Squares of standard deviations of a load: rows force_x [N2], force_z [N2], torque_y [N2 m2], columns sources.
  using Squares = Eigen::Matrix<double, 3, kSources>;

  /// Zero for a rod that is rigid and tight in the hammer file. Refers to the mechanism, which must outlive it.
  explicit UnknownForce(const Mechanism& mechanism) noexcept;

  /// Advances by a step [s]. passed: the crank passed the dead centre in it. waits: the elastic rod's filter has not
  /// met the tool yet, so that the blow begins later.
  void follow(double step, bool passed, bool waits = false) noexcept;
  /// Updates c and rho with the pins that the readings show; empty if they show none.
  void observe(const std::optional<IdentifiedPins>& pins) noexcept;
  /// Takes the rocker's acceleration relative to a rigid rod's at the step's end, or its crest [rad/s2].
  void vibrates(const LinkMotion& links, double vibration) noexcept;
  /// Errors of the load: squares by source, and the covariance of all sources, whose diagonal is their sum.
  struct Errors {
    Squares squares;
    Eigen::Matrix3d covariance;
  };
  Errors errors(const LinkMotion& links) const noexcept;
  /// Standard deviation of a force on the hull just after a blow [N], all sources together; name of the largest source
  /// and the key of the hammer file that describes it.
  struct Largest {
    double force{};
    const char *name{}, *key{};
  };
  Largest largest() const noexcept;
  /// Returns the squares of the errors of a load that is an extreme of the revolution.
  static Squares ofExtreme(Squares squares) noexcept {
    squares.col(kClearance) *= kCrest * kCrest;
    return squares;
  }
  static constexpr const char* kKeys[kSources] = {"pin_play_m", "pin_friction_radius_m", "rod_damping_ratio"};
  /// Time for which such a force keeps its sign, 1/(2 pi 200 Hz) [s]: its impulse is at most that times the force.
  static constexpr double kKeepsSign = 8e-4;
  // Numerical: kKeepsSign

 private:
  static constexpr double kCrest = 3.0;  // of the contacts, over their root mean square
  // Prior: kCrest

  struct Greatest {
    double moment{}, force{};  ///< moment of the rod on the rocker [N m]; force in the rod [N]
  };
  Greatest greatest() const noexcept {
    return {std::max(now_.moment, last_.moment), std::max(now_.force, last_.force)};
  }
  /// Returns the force of the contacts for D = 1 [N].
  double contacts() const noexcept;

  const Mechanism* mechanism_;
  double given_clearance_{}, given_friction_radius_{};  ///< values of the hammer file [m]
  double clearance_{}, friction_radius_{}, damping_{};  ///< c [m], rho [m], zeta [-]
  double stiffness_{};                                  ///< k [N/m]
  Greatest now_, last_;                                 ///< since the last blow; in the revolution before it
  double held_{}, since_{1.0};                          ///< N, held [N]; s [s]
  bool passed_{};                                       ///< a passed blow that has not begun
};

}  // namespace hammer_loads
