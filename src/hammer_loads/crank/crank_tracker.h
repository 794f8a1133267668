/// The estimate of the crank at an instant, and the interface of all trackers.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/crank/crank_state.h"
#include "hammer_loads/linkage/hull_motion.h"

namespace hammer_loads {

class CrankFilter;

/// One crank sample as measured.
struct CrankSample {
  double angle{};               ///< any winding [rad]
  std::optional<double> speed;  ///< [rad/s]
};

/// Best estimate at an instant.
struct CrankEstimate {
  CrankPosition position;
  double speed{};         ///< [rad/s]
  double acceleration{};  ///< [rad/s2]
  /// The drive behind a flexible coupling: mean speed [rad/s] and acceleration [rad/s2] of motor and flywheel,
  /// by inertia, less the crank's.
  double drive_lead_speed{}, drive_lead_acceleration{};
};

/// How far an estimate may be off: by what is drawn anew at each sample, and by constants, which are off alike at all.
struct CrankUncertainty {
  enum Row : Eigen::Index { kAngle, kSpeed, kAcceleration, kInertia };

  Eigen::Matrix3d own{Eigen::Matrix3d::Zero()};  ///< covariance of angle [rad], speed [rad/s], acceleration [rad/s2]
  /// One standard deviation each of errors that are independent of each other; by rows as above, the last relative to
  /// the drive's inertia.
  ByConstants<4, ConstantErrors::kSize> by_constant{ByConstants<4, ConstantErrors::kSize>::Zero()};
  double inertia{};  ///< of the drive's inertia, relative, beside the constants

  /// Of the speed where the crank passes an angle, which an error of its angle delays. rate: acceleration over speed
  /// [1/s].
  Eigen::Matrix<double, 1, ConstantErrors::kSize> speedAtAngle(double rate) const noexcept {
    return by_constant.row(kSpeed) - rate * by_constant.row(kAngle);
  }
  Eigen::Matrix3d covariance() const noexcept;
};

/// The crank at one place between two samples: by the way forward from the earlier one, by the way back from the later.
struct CrankWays {
  CrankEstimate forward, back;
};

/// A blow's factor on the crank: its speed after over its speed before. Deviations are beside the constants.
struct BlowFactor {
  double mean{1.0};                                            ///< [-]
  double deviation{std::numeric_limits<double>::quiet_NaN()};  ///< [-]
  double drive_inertia{};      ///< of Jc what the blow acts on; gives the restitution [kg m2]; 0: not known
  double inertia_deviation{};  ///< relative [-]
  bool early{};                ///< it acted before the dead centre, where the crank passed with its speed after
  /// What independent errors of constants make of the factor [-] and, relatively, of the inertia, a standard deviation
  /// each.
  ByConstants<2, ConstantErrors::kSize> by_constant{ByConstants<2, ConstantErrors::kSize>::Zero()};
};

/// How a sample was taken.
enum class Tracking {
  kContinued,  ///< agrees with what came before
  kRestarted,  ///< restarted at this sample: what lies between is not known
  kRevised,    ///< goes on, but what came before was otherwise than thought: a turn without contact, or with it
  kOutlier,    ///< contradicts what came before and was ignored; a second one like it restarts
};

/// From samples to estimates. Time is given as the step since the last accepted sample.
class CrankTracker {
 public:
  virtual ~CrankTracker() = default;

  /// Begins at a sample; what was learned about the machine is kept.
  virtual void start(const CrankSample& sample) noexcept = 0;
  /// Takes the next sample, dt > 0 [s] after the last accepted one. No allocation.
  virtual Tracking update(double dt, const CrankSample& sample) noexcept = 0;
  /// Estimate at the last accepted sample.
  virtual CrankEstimate estimate() const noexcept = 0;
  /// Estimate dt [s] after the last but one accepted sample, 0 <= dt <= step between the last two. Continuous in dt
  /// but for the acceleration at a blow; equals estimate() at the end. Only after kContinued.
  virtual CrankEstimate between(double dt) const noexcept = 0;
  /// What the two samples each say of between(dt), where both say something: the estimate is that of neither where they
  /// contradict each other. Nothing where one of the ways runs away.
  virtual std::optional<CrankWays> waysBetween(double dt) const noexcept { return CrankWays{between(dt), between(dt)}; }
  /// False while the speed is still unknown (first sample without one).
  virtual bool hasSpeed() const noexcept = 0;
  /// False where no drive gives what the estimate needs: degrees instead of radians, for instance.
  virtual bool isPlausible() const noexcept { return true; }
  /// At the same instant as between(dt); zero where none is estimated. torque_part: how much of the torque's deviation
  /// counts, see PipelineSettings::torque_deviation_part.
  virtual CrankUncertainty uncertaintyBetween(double /*dt*/, double /*torque_part*/) const noexcept { return {}; }
  /// The same at the last accepted sample.
  virtual CrankUncertainty uncertainty(double /*torque_part*/) const noexcept { return {}; }
  /// Factor that the last blow put on the crank's speed, by all samples since; of no model: 1, not known.
  virtual BlowFactor blowFactor() const noexcept { return {}; }
  /// Jc: what turns with the crank beside the links, as far as known [kg m2].
  virtual double driveInertia() const noexcept = 0;
  /// Of that what a blow acts on: without a motor beyond a flexible coupling [kg m2].
  virtual double struckInertia() const noexcept { return driveInertia(); }
  /// Whether the last blow was one at all is not clear yet: what is estimated may be of the wrong branch.
  virtual bool isDoubtful() const noexcept { return false; }
  /// Probability that it was the other way: no blow where the estimate has one, or a blow where it has none.
  virtual double otherBranch() const noexcept { return 0.0; }
  /// The last sample's reading itself shows on which side of the blow it was taken: an encoder's edge, an exact stamp.
  virtual bool readingShowsSide() const noexcept { return false; }
  /// Enough samples have come, and they fit the model: until then a wrong unit may not show.
  virtual bool isProven() const noexcept { return true; }
  /// Mean of innovation^2 over its variance: near 1 where readings and model agree; NaN before enough samples and of no
  /// model.
  virtual double consistency() const noexcept { return std::numeric_limits<double>::quiet_NaN(); }
  /// The same of the half turns before the blow alone, the lesser of the last two: there a rod that gives or a blow
  /// that lasts changes little, so that what contradicts the model is another machine or another sensor.
  virtual double strikeConsistency() const noexcept { return std::numeric_limits<double>::quiet_NaN(); }
  /// The filter that learns of sensor and machine behind the estimates; null: none.
  virtual const CrankFilter* filter() const noexcept { return nullptr; }
  /// The filter as it is at the last sample, whatever is known by later ones.
  virtual const CrankFilter* filterNow() const noexcept { return filter(); }
  /// One count of the angle sensor [rad], as far as known.
  virtual double angleResolution() const noexcept = 0;
  /// Samples are taken at equal intervals [s], so that a reading that is whole intervals ahead has lost samples before
  /// it; 0: not known.
  virtual void setInterval(double /*interval*/) noexcept {}
  /// What the last step took longer than was given, by such samples [s]; < 0: one that was counted there was lost
  /// later.
  virtual double lostTime() const noexcept { return 0.0; }
  /// Steps of the encoder on its shaft that were found since the beginning.
  virtual int slips() const noexcept { return 0; }
  /// Standard deviation of what all stamps are off alike [s]: no reading shows it.
  virtual void considerLatency(double /*deviation*/) noexcept {}
  /// A rod that gives has the crank beside the estimate by that [rad], [rad/s]: as much of it is not known.
  virtual void considerRod(double /*angle*/, double /*speed*/) noexcept {}
  /// Weight and motion of the hull at the coming sample; only who predicts the crank's motion needs them.
  virtual void setHullMotion(const HullMotion& /*hull*/) noexcept {}
};

}  // namespace hammer_loads
