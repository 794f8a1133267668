#include "hammer_loads/pipeline/boom_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr double kLeastContact = 0.05;  // part of the boom's weight, which is not known better
constexpr std::size_t kEdges = 4;
using Vector6 = Eigen::Matrix<double, 6, 1>;

BoomDeviations unknownDeviations(int joints) {
  const Wrench unknown{Eigen::Vector3d::Constant(kNaN), Eigen::Vector3d::Constant(kNaN)};
  BoomDeviations deviations;
  deviations.torque = JointVector::Constant(joints, kNaN);
  deviations.cylinder.fill(kNaN);
  deviations.section.fill(unknown);
  deviations.joint.fill(unknown);
  return deviations;
}

}  // namespace

BoomFollower::BoomFollower(Boom boom, const PipelineSettings& settings, double striking_distance)
    : boom_(std::move(boom)),
      joints_(boom_.chain(), settings, boom_.jointZeros()),
      pressures_(settings.joint_max_age),
      observer_(settings.imu.position),
      model_(settings.boom),
      striking_distance_(striking_distance),
      g_B_(gravityInRoot(settings.gravity, settings.base)),
      follow_vibration_(model_ != BoomModel::kRigid && !boom_.cylinders().empty()),
      givers_{"front edge", "left edge", "rear edge", "right edge"} {
  const JointVector zero = JointVector::Zero(boom_.chain().joints());
  motion_ = {zero, zero, zero};
  torque_ = {zero, zero, zero};
  state_.frequency.resize(0), state_.frequency_std.resize(0), state_.damping.resize(0);
  state_.contact_torque = unmodelled_torque_ = zero;
  state_.deviations = unknownDeviations(boom_.chain().joints());
  state_.reduced = {kInfinity, kInfinity};
  state_.tip = {Vector6::Zero(), Vector6::Zero(), Vector6::Zero()};
  if (follow_vibration_ && settings.boom_stiffness == BoomStiffness::kIdentified) boom_.vibration().identify();
  least_contact_ = kLeastContact * settings.gravity * massFrom(boom_.chain(), boom_.pose(), 1).mass;
  state_.choice.rigid_tolerance = boom_.parameters().rigid_tolerance;
  for (const Cylinder& cylinder : boom_.cylinders()) givers_.push_back(cylinder.parameters().name);
}

Wrench BoomFollower::onTip(const HullWrench& w) noexcept {
  return {{w.force_x, 0.0, w.force_z}, {0.0, w.torque_y, 0.0}};
}

/// Returns the joint torques of a wrench w on the hull, as Boom::hammerTorque() of onTip(). w lies in the boom's plane.
JointVector BoomFollower::hammerTorque(const HullWrench& w) const noexcept {
  JointVector torque = JointVector::Zero(boom_.chain().joints());
  addHammerTorque(w, torque);
  return torque;
}

void BoomFollower::addHammerTorque(const HullWrench& w, JointVector& torque) const noexcept {
  const Jacobian& J = boom_.tipJacobian();
  for (Eigen::Index j = 0; j < J.cols(); ++j)
    torque[j] += J(0, j) * w.force_x + J(2, j) * w.force_z + J(4, j) * w.torque_y;
}

Wrench BoomFollower::wrenchAtLink(int link, const HullWrench& load) const noexcept {
  ChainPose pose;  // from the joints' sensors, as in other nodes
  forwardKinematics(boom_.chain(), motion_.position, pose);
  return hammer_loads::wrenchAtLink(pose, link, onTip(load));
}

bool BoomFollower::usesCompliant() const noexcept {
  if (!follow_vibration_ || !boom_.vibration().known()) return false;
  const BoomChoice& choice = state_.choice;
  return model_ == BoomModel::kCompliant || !choice.judged || choice.rigid_error > choice.rigid_tolerance;
}

/// Returns the joints' complaints. If there are none, the joint states arrived after the sample.
std::vector<std::string> BoomFollower::complaints() const {
  if (!state_.fault || state_.fault->kind == JointFault::Kind::kRunAway) return {};
  std::vector<std::string> lines = joints_.complaints(state_.stamp);
  if (lines.empty())
    lines.push_back(joints_.name(state_.fault->joint) + ": its states come later than the crank samples of their time");
  return lines;
}

const BoomState& BoomFollower::sample(const BoomSample& sample, const WrenchHistory& step) noexcept {
  state_.stamp = sample.stamp;
  state_.at_blow.reset();
  state_.fault = joints_.at(sample.stamp, motion_);
  if (state_.fault) {
    known_ = false;
    ++faults_;
    return state_;
  }
  forgetWrongReadings(sample.imu_lost);
  const double since = seconds(sample.stamp - last_stamp_);
  if (follow_vibration_) {
    const bool swung = known_ && last_stamp_ == sample.stamp;  // the vibration is at this stamp already
    const bool continued = swung || (known_ && step.count > 0);
    if (!continued) boom_.vibration().reset(), spread_.reset(), bound_.reset(), unmodelled_torque_.setZero();
    pose(since);
    spread_.follow(boom_.vibration());
    if (!continued) beginUnseen(sample.unseen_peak);
    followContact(sample.stamp);
    if (continued && !swung) vibrate(step, sample.displaced_links, spreadWithRock(sample.spread));
    observe(sample, since);
    if (diverges(since)) {
      state_.fault = JointFault{JointFault::Kind::kRunAway, 0, withheld_for_};
      last_stamp_ = sample.stamp;
      return state_;
    }
  } else {
    boom_.move(motion_, g_B_);
    held_.follow(motion_, since);
    for (std::size_t i = 0; i < step.count; ++i)
      if (step.pieces[i].ends_in_blow) held_.struck(), state_.at_blow = TipVelocity{};
  }
  known_ = true;
  last_stamp_ = sample.stamp;
  state_.choice.compliant = usesCompliant();
  findLoads(sample, since);
  if (follow_vibration_) fillVibration();
  return state_;
}

/// Separates the operator's motion from the vibration, which joint sensors measure as well.
void BoomFollower::pose(double since) noexcept {
  const JointVector displacement = boom_.vibration().displacementAfter(since);
  JointMotion operated = motion_;
  operated.position -= displacement;
  held_.follow(operated, since);
  if (usesCompliant()) {
    boom_.moveVibrating(held_.motion(), displacement, g_B_);
  } else {
    boom_.moveCompliant(motion_, g_B_);
  }
}

void BoomFollower::findLoads(const BoomSample& sample, double step) noexcept {
  const bool rigid = !state_.choice.compliant;
  const Wrench w_tip = onTip(rigid ? sample.motion_wrench : sample.motion_wrench + sample.displaced_links);
  const ChainLoads links = boom_.chainLoads(rigid);
  boom_.loads(w_tip, rigid, links, state_.loads);
  unmodelled_torque_.setZero();
  if (!rigid) unmodelled_torque_ = state_.loads.vibration - boom_.vibration().torque();
  updateMeasured(sample, step);
  boom_.steelLoads(w_tip + state_.contact, links, state_.steel);
  findDeviations(spreadWithRock(sample.spread), rigid);
  addConstants(sample);
  const std::optional<ModeIdentifier>& identifier = boom_.vibration().identifier();
  const bool alone = identifier && identifier->learns() && identifier->imuSpeaks() && !state_.measured;
  worth_.add(state_.loads.total, state_.loads.weight, state_.deviations.torque,
             state_.measured || state_.contact_unknown, alone, alone && identifier->isProven());
  state_.useless = worth_.isUseless(sample.stamp);
  useless_ += state_.useless;
  for (std::size_t i = 0; i < boom_.cylinders().size(); ++i) state_.cylinder_flags[i] = boom_.flags(i, state_.loads);
}

/// Advances the vibration over the step. displaced_links: at the step's end; interpolated linearly over the step.
void BoomFollower::vibrate(const WrenchHistory& step, const HullWrench& displaced_links,
                           const WrenchSpread& spread) noexcept {
  const LoadSpread errors = spread_.waits() ? LoadSpread() : boom_.spreadTorque(spread);
  const auto take = [this](const HullWrench& motion, const HullWrench& displaced, JointVector& torque) {
    torque = unmodelled_torque_;
    addHammerTorque(motion + displaced, torque);
  };
  const double length = step.length();
  double end = 0.0;
  HullWrench from = displaced_links_;
  for (std::size_t i = 0; i < step.count; ++i) {
    const SmoothPiece& piece = step.pieces[i];
    end += piece.duration;
    const double part = length > 0.0 ? end / length : 1.0;
    const HullWrench to = (1.0 - part) * displaced_links_ + part * displaced_links;
    take(piece.from, from, torque_.from);
    take(piece.to, to, torque_.to);
    take(piece.mean, 0.5 * (from + to), torque_.mean);
    from = to;
    boom_.vibration().advance(piece.duration, torque_);
    bound_.advance(boom_.vibration(), piece.duration, torque_);
    spread_.advance(piece.duration, torque_, errors);
    if (piece.ends_in_blow) strike(piece.blow);
  }
  displaced_links_ = displaced_links;
}

/// Returns true if the vibration is not plausible at this sample. An implausible vibration is reset from the next
/// sample on, together with the identified values.
bool BoomFollower::diverges(double step) noexcept {
  if (!bound_.holds(boom_.vibration())) {
    withheld_for_ = VibrationBound::decayTime(boom_.vibration());
    boom_.vibration().startAnew();
    ++divergences_;
    known_ = false;
    return true;
  }
  withheld_for_ = std::max(0.0, withheld_for_ - std::max(0.0, step));
  known_ = true;
  return withheld_for_ > 0.0;
}

/// Begins with the possible vibration after a gap: the amplitude before it or else that due to the hammer's peak alone.
void BoomFollower::beginUnseen(double peak) noexcept {
  const Vibration& vibration = boom_.vibration();
  JointVector swing = vibration.usualSwing();
  if (!vibration.known() || (swing.isZero(0.0) && peak == 0.0)) return;
  if (swing.isZero(0.0))
    swing = modalForce(vibration.modes(), hammerTorque({0.0, peak, 0.0}))
                .cwiseQuotient(vibration.modes().omega.cwiseAbs2())
                .cwiseAbs();
  if (swing.allFinite()) spread_.begin(swing);
}

void BoomFollower::strike(const HullWrench& impulse) noexcept {
  held_.struck();
  last_blow_ = last_stamp_;
  const JointVector before = boom_.vibration().velocity(), torque = hammerTorque(impulse);
  boom_.vibration().strike(torque);
  bound_.strike(boom_.vibration(), torque);
  spread_.strike(torque);
  const Vector6 velocity = boom_.tipJacobian() * (0.5 * (before + boom_.vibration().velocity()));
  state_.at_blow = TipVelocity{velocity[2], velocity[4]};
}

TipVelocity BoomFollower::drivenTip() const noexcept {
  if (!known_) return {};
  const Vector6 velocity = boom_.tipJacobian() * held_.rateAtBlow();
  return {velocity[2], velocity[4]};
}

void BoomFollower::advanceWithoutLoads(StampNs stamp, const WrenchHistory& step) noexcept {
  if (!known_ || !follow_vibration_ || !(stamp > last_stamp_)) return;
  WrenchHistory freely;
  freely.count = 1;
  state_.at_blow.reset();
  freely.pieces[0].duration = seconds(stamp - last_stamp_);
  unmodelled_torque_.setZero();  // no loads are computed for this sample
  vibrate(step.count > 0 ? step : freely, displaced_links_, {});
  last_stamp_ = stamp;
  state_.stamp = stamp;
  fillVibration();
}

void BoomFollower::fillVibration() noexcept {
  const BoomModes& modes = boom_.vibration().modes();
  state_.zero_moment_arm = modes.zero_moment_arm;
  state_.frequency = modes.omega / kTwoPi;
  fillModes();
  state_.reduced = boom_.reducedHull(Eigen::Vector3d::UnitZ());
  if (state_.choice.compliant) {
    state_.tip = boom_.tipVibration();
  } else {
    state_.tip = {Vector6::Zero(), Vector6::Zero(), Vector6::Zero()};
  }
}

void BoomFollower::fillModes() noexcept {
  const Vibration& vibration = boom_.vibration();
  const auto count = state_.frequency.size();
  state_.damping.resize(count), state_.frequency_std.resize(count);
  for (int k = 0; k < count; ++k) {
    state_.damping[k] = vibration.mode(k).zeta;
    state_.frequency_std[k] = spread_.deviation(k).frequency * state_.frequency[k];
  }
  state_.identified = vibration.identifies() && vibration.identifier()->identified();
}

void BoomFollower::turnEnded(const std::optional<HalfSinePulse>& pulse, double mean_hold_down_force) noexcept {
  worth_.endTurn(last_stamp_);
  if (!known_) return;
  if (pulse && pulse->frequency > 0.0 && follow_vibration_) {
    BoomChoice& choice = state_.choice;
    choice.pulse_length = kPi / pulse->frequency;
    choice.rigid_error = boom_.rigidError(onTip({0.0, pulse->amplitude, 0.0}), choice.pulse_length);
    choice.lowest_frequency = state_.frequency.size() > 0 ? state_.frequency[0] : 0.0;
    choice.judged = true;
  }
  if (std::isfinite(mean_hold_down_force) && (boom_.parameters().supports || !boom_.cylinders().empty())) {
    state_.hold_down = boom_.holdDown(onTip({0.0, mean_hold_down_force, striking_distance_ * mean_hold_down_force}));
  }
}

const std::string& BoomFollower::firstToGive() const noexcept {
  if (!state_.hold_down || std::isinf(state_.hold_down->least)) return no_giver_;
  const HoldDown& hold = *state_.hold_down;
  if (hold.machine <= hold.least) return givers_[static_cast<std::size_t>(hold.edge)];
  std::size_t weakest = 0;
  while (hold.cylinder[weakest] > hold.least) ++weakest;
  return givers_[kEdges + weakest];
}

}  // namespace hammer_loads
