/// Motion of the crank between measurements: the equation of motion of the mechanism, the law of its drive, and the
/// effect of the hammer's constants on both.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/machine_columns.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// A pump of constant flow feeds the motor through compliant oil and hoses: if the crank leads a uniform rotation, it
/// has consumed more oil than was supplied, and the torque decreases in proportion to the lead. The rest of the torque
/// is a random walk.
struct SupplyLaw {
  double stiffness{};   ///< [N m/rad]
  double mean_speed{};  ///< mean speed of the uniform rotation [rad/s]; 0: not known, no lead
  double unit{};        ///< unit of the stiffness' error among ConstantErrors [N m/rad]

  /// Lead of a crank that turned by an angle [rad] in dt [s] over the uniform rotation [rad].
  double lead(double turned, double dt) const noexcept { return mean_speed > 0.0 ? turned - mean_speed * dt : 0.0; }
};

/// Identification of the law: mean speed of the last revolution, stiffness, and mean square of the torque.
class LearnedSupply {
 public:
  /// unit: largest stiffness [N m/rad], > 0.
  explicit LearnedSupply(double unit) noexcept : usual_(look_back::kTurnsToKnow, square(unit), 1.0) {
    law_.unit = unit;
  }
  const SupplyLaw& law() const noexcept { return law_; }
  /// Notes that the preceding motion is not known.
  void restart() noexcept {
    law_.mean_speed = 0.0;
    turn_time_ = std::numeric_limits<double>::quiet_NaN();
  }
  void pass(double dt) noexcept { turn_time_ += dt; }  ///< [s]
  /// Adds a torque [N m] between a blow and the end of its half revolution.
  void addTorque(double torque) noexcept { half_turn_.add(square(torque)); }
  /// Ends a revolution, half a revolution after the blow. known: true if the torques since were those of the supply.
  void endTurn(const CrankPosition& at, bool known = true) noexcept {
    if (known && half_turn_.count() > 0.0) usual_.add(half_turn_.mean());
    half_turn_ = {};
    const double speed = difference(at, from_) / turn_time_;
    law_.mean_speed = speed > 0.0 ? speed : 0.0;
    from_ = at;
    turn_time_ = 0.0;
  }
  /// Mean square of these torques over the last revolutions [N2 m2]; at first the square of the unit.
  double usual() const noexcept { return usual_.mean(); }
  /// Corrects the stiffness by its identified error [unit]; returns the change [unit].
  double learn(double error) noexcept {
    const double change = std::clamp(law_.stiffness / law_.unit - error, 0.0, 1.0) - law_.stiffness / law_.unit;
    law_.stiffness += law_.unit * change;
    return change;
  }

 private:
  RunningMean<> usual_, half_turn_;
  SupplyLaw law_;
  CrankPosition from_;
  double turn_time_{std::numeric_limits<double>::quiet_NaN()};  ///< time since from_ [s]; NaN: not observed from there
};

/// Adaptation of the torque's random walk, which is given for rough supplies and has little influence with exact
/// samples. Jittering stamps must be averaged over many samples; if the walk is too large, their noise is taken for
/// torque, and successive innovations change their sign too often. If it is too small, they keep their sign. Each
/// product of an innovation and the fading sum of those before it therefore adjusts the walk slightly. The given walk
/// is used while stamps are exact.
class SupplyRoughness {
 public:
  /// Adapts the walk by an innovation of variance `total`, of which the stamps' jitter is the part `jitter`.
  void learn(double innovation, double total, double jitter) noexcept {
    const double now = std::clamp(innovation / std::sqrt(total), -gate::kRare, gate::kRare);
    factor_ = jitter > 0.0 ? std::clamp(factor_ * (1.0 + kGain * jitter * now * sum_), kLeast, kMost) : 1.0;
    sum_ = now + kFading * sum_;
  }
  /// Factor on the given walk [-].
  double factor() const noexcept { return factor_; }
  /// Factor on the real part of the torque's standard deviation. A smaller walk reduces that, while the supply is
  /// unchanged. With this factor the measured coverage is that of exact stamps.
  double deviationFactor() const noexcept { return 1.0 / std::sqrt(std::sqrt(std::min(1.0, factor_))); }

 private:
  static constexpr double kGain = 1.0 / look_back::kReadings;
  static constexpr double kFading = 0.85;              // memory of some 7 samples
  static constexpr double kLeast = 0.25, kMost = 3.0;  // a sudden supply is still followed within some samples
  // Prior: kLeast, kMost
  double factor_{1.0}, sum_{};
};

// A path is cut into smooth pieces that end at the blow.
constexpr double kMaxStepAngle = 0.04;  ///< largest crank angle in one piece [rad]
constexpr int kMaxSteps = 4096;         ///< bounds the work for absurd speeds; steps get longer beyond it
// Numerical: kMaxStepAngle, kMaxSteps, kMostCreepingPasses
/// Speed below which friction moves the crank and the tool stops it, without a jump [rad/s].
constexpr double kSlowCrank = 5.0;
/// Speed below which the crank creeps over the blow, without a defined instant of passage [rad/s].
constexpr double kCreeping = 1.0;
/// Largest number of passages of the blow in one direction. Beyond it each side pushes the crank to the other, and it
/// stays at the blow.
constexpr int kMostCreepingPasses = 8;

/// Piece of the path.
struct WayPiece {
  double used;   ///< time used [s]
  bool at_blow;  ///< true if it ends at the blow
};

/// Returns the time within dt at which the crank reaches the blow: safeguarded secant on the smooth continuation.
/// offset_after(t): offset from the blow [rad] after t of dt; start, end: offsets at both ends, of different signs.
template <typename Function>
double timeToBlow(const Function& offset_after, double start, double end, double dt) noexcept {
  double low = 0.0, high = dt, f_low = start, f_high = end;
  double t = 0.0;
  for (int i = 0; i < 8; ++i) {
    t = low - f_low * (high - low) / (f_high - f_low);
    const double f = offset_after(t);
    if (std::abs(f) < 1e-13) break;
    const bool before = std::signbit(f) == std::signbit(f_low);
    (before ? low : high) = t;
    (before ? f_low : f_high) = f;
  }
  return t;
}

/// Reflected inertia of the links, and torques of weight and hull motion, on the shaft; refers to the mechanism, which
/// must outlive it.
class ShaftModel {
 public:
  ShaftModel(const Mechanism& mechanism, Level level)
      : mechanism_(&mechanism),
        level_(rigid(level)),
        own_(crankWithinDrive(mechanism, rigid(level))),
        columns_(machineColumns(mechanism, rigid(level))) {}
  void setHullMotion(const HullMotion& hull) noexcept { hull_ = hull; }
  const HullMotion& hullMotion() const noexcept { return hull_; }
  ShaftLoad operator()(CrankAngle angle) const noexcept {
    ShaftLoad load = shaftLoad(*mechanism_, level_, angle, hull_);
    const double r = mechanism_->parameters().drive_reaction_ratio;
    load.weight_torque -= (1.0 - r) * own_ * load.hull_acceleration;
    load.hull_acceleration *= r;
    return load;
  }
  /// Returns true for an exact hammer, which has no columns.
  bool isExact() const noexcept { return columns_ == nullptr; }
  /// Returns a copy that is prepared for many calls of columns().
  ShaftModel tabulated() const {
    ShaftModel copy = *this;
    if (!isExact()) copy.table_ = std::make_shared<const ShaftTable>(columns_->shaftTable());
    return copy;
  }
  MachineColumns::OnShaft columns(CrankAngle angle) const noexcept {
    if (isExact()) return MachineColumns::OnShaft::Zero();
    return table_ && ShaftTable::covers(angle) ? onShaft(*table_, angle, hull_.gravity)
                                               : columns_->onShaft(angle, hull_.gravity);
  }

 private:
  const Mechanism* mechanism_;
  Level level_;
  double own_;  ///< crankWithinDrive()
  std::shared_ptr<const MachineColumns> columns_;
  std::shared_ptr<const ShaftTable> table_;
  HullMotion hull_;
};

struct ShaftState {
  CrankPosition position;
  double speed{};          ///< w [rad/s]
  double torque{};         ///< net drive torque tau on the crank [N m]
  double drive_inertia{};  ///< Jc: inertia of motor, flywheel and all that rotates with the crank [kg m2]
};

constexpr double kNearTool = 0.06, kHighestTool = 0.5;  ///< [rad] from the dead centre: no tool is that high
constexpr double kStepsToTool = 1.5;

/// Returns true if the tool may be met within a step of length dt [s].
inline bool isNearTool(const ShaftState& state, double dt) noexcept {
  return std::abs(state.position.angle.offset) <
         std::clamp(kStepsToTool * std::abs(state.speed) * dt, kNearTool, kHighestTool);
}

/// w' = (tau + weight - Jc r alpha - J'/2 w^2)/(Jc + J) [rad/s2], weight and hull's motion in one (model.md 3, 6).
double acceleration(const ShaftLoad& load, const ShaftState& state) noexcept;

/// Order of the shaft's variables in matrices: angle, speed, torque, logarithm of the drive inertia (which keeps it
/// positive and makes its uncertainty relative), factor of the last blow.
using ShaftMatrix = Eigen::Matrix<double, 5, 5>;

/// d(angle, speed after)/d(angle, speed, torque, logarithm of drive inertia, blow factor before); the other variables
/// are unchanged. The blow factor counts only if a blow is passed in between.
using ShaftTransition = Eigen::Matrix<double, 2, 5>;

/// Treatment of a forward passage of the dead centre.
struct Passing {
  double factor{1.0};  ///< crank speed after over before the blow [-], > 0
  bool contact{true};  ///< false: no tool, the rocker passes smoothly onto the mirrored branch
};

/// Transition of a step, and the blows in it.
struct Advance {
  ShaftTransition transition;
  int blows{};  ///< blows passed with contact and positive speed, also in a step back in time
};

/// Passes the blow for a state on the branch before it, at offset 0 or slightly beyond: to first order the result is
/// that of a passage at offset 0. The position is continuous, the speed changes by the factor, and the acceleration
/// jumps; a path that reaches the blow later by d(angle)/w keeps the old acceleration for this time (saltation). The
/// factor is 1 for a backward rotation, and is undone for a step back in time.
void passBlow(const ShaftModel& model, double factor, ShaftState& state, ShaftLoad& load,
              ShaftTransition& total) noexcept;

/// Advances the state by dt [s] (negative: back in time) with constant torque and inertia, through the blow if it lies
/// in between. `load` is the model's at the state's angle, before and after the call. A state on the mirrored branch
/// continues and leaves it smoothly.
///
/// Integrates h = sqrt(Jc + J) w; h^2/2 is the kinetic energy. Its rate, the torques over sqrt(Jc + J), contains no
/// derivative of the transfer function, so that its linearisation contains none of third order. Runge-Kutta of order 4
/// by two derivatives, steps of at most 0.04 rad: error of a free revolution below 1e-7 of the energy; linearisation of
/// order 2 per step, within 1 % of finite differences at 1 kHz (test).
Advance advance(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state,
                ShaftLoad& load) noexcept;
/// Advances the state without the linearisation, which costs as much as the state.
void advanceState(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state) noexcept;

/// Effect of the hammer's constants on a step. Without torque a step keeps h = sqrt(M) w, M = Jc + J. A column dJ of
/// the links' inertia changes h at the start, and the speed that belongs to h at the end. The speed changes by w/2
/// (dJ/M at the start less dJ/M at the end), plus the effect on the torque's part. Two such steps meet at a blow, where
/// M jumps. The columns are of first order in the step.
class ColumnStep {
 public:
  using Columns = ByConstants<1, kMachineColumns>;

  /// Evaluates the columns at the start of the step. inertia: Jc [kg m2].
  ColumnStep(const ShaftModel& model, const ShaftState& from, double inertia, const ShaftLoad& load) noexcept
      : start_(model.columns(from.position.angle)),
        offset_(from.position.angle.offset),
        m_(inertia + load.inertia),
        weight_(load.weight_torque) {}
  /// Changes of the speed [rad/s] at the end of the step by the columns. torque: on the crank beside its links [N m];
  /// struck: true if it passed a blow.
  Columns ofSpeed(const ShaftModel& model, const ShaftState& to, double inertia, const ShaftLoad& load, double torque,
                  double dt, bool struck) const noexcept {
    const MachineColumns::OnShaft end = model.columns(to.position.angle);
    const double m = inertia + load.inertia;
    Columns relative = f(1.0 / m_) * start_.row(0) - f(1.0 / m) * end.row(0);  // part at constant h
    double begin = 0.5;                                                        // weight of the start
    if (struck) {
      const CrankAngle before{0.0, Side::kBeforeBlow}, after{0.0, Side::kAfterBlow};
      relative += f(1.0 / (inertia + model(after).inertia)) * model.columns(after).row(0) -
                  f(1.0 / (inertia + model(before).inertia)) * model.columns(before).row(0);
      begin = std::clamp(-offset_ / (to.speed * dt), 0.0, 1.0);
    }
    return f(0.5 * to.speed) * relative + driven(start_, torque + weight_, m_, begin * dt) +
           driven(end, torque + load.weight_torque, m, (1.0 - begin) * dt);
  }

 private:
  static float f(double x) noexcept { return static_cast<float>(x); }
  static Columns driven(const MachineColumns::OnShaft& at, double torque, double m, double dt) noexcept {
    return f(dt / m) * at.row(2) - f(dt * torque / (m * m)) * at.row(0);
  }

  MachineColumns::OnShaft start_;
  double offset_, m_, weight_;  ///< at the step's start: angle [rad], M [kg m2], the links' weight on the crank [N m]
};

}  // namespace hammer_loads
