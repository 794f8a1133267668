#include "hammer_loads/pipeline/measured_torques.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/pipeline/reading_checks.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kLaw = 0.3;  // relative error of the friction law: seals yield before they slide
// Prior: kLaw
constexpr double kSlowJoint = 0.005;  // rate near standstill [rad/s]
// Numerical: kSlowJoint
constexpr double kLag = 0.4;  // part of the oscillation per root of the surprise: delays of 5 to 20 ms cost 0.3 to 1.4

/// Friction of seals between oil and joint, as part of the load's torque on the joint [N m].
struct Rubbing {
  double torque{};
  double deviation{}, lasting{};  ///< standard deviation; its part while the operator's motion sets the rod's direction
};

/// Returns the friction. vibrating: vibration rate of the joint [rad/s]; way: see Seals.
Rubbing rubbing(const Seals& seals, double vibrating, double way) noexcept {
  const double one_way = square(seals.driven) / (square(seals.driven) + square(vibrating) + square(kSlowJoint));
  return {seals.known * way,
          std::sqrt(square(seals.deviation) + square(kLaw * seals.known) + (1.0 - square(way)) * square(seals.known)),
          std::sqrt(one_way) * seals.deviation};
}

/// Returns the squared error of a line through two readings that are late by `delay`, relative to that without delay.
/// The line is extrapolated further, and an oscillation is curved.
double longerLine(double delay, double interval) noexcept {
  const double late = interval > 0.0 ? std::max(delay, 0.0) / interval : 0.0;
  return square((1.0 + late) * (1.0 + 0.5 * late));
}

}  // namespace

/// Estimates the residual as a random walk with measurement noise (Kalman filter): the variance of its change over two
/// readings contains the walk twice and the noise once. A jump is a force of the rock.
void MeasuredTorques::followRest(Track& track, double rest) noexcept {
  track.one_square.add(square(rest - track.last));
  track.two_square.add(square(rest - track.before));
  track.before = track.last, track.last = rest;
  const double one = track.one_square.mean(), two = track.two_square.mean();
  const double walk = std::max(0.0, two - one), noise = std::max(0.0, one - 0.5 * two);
  const double known = 0.5 * walk + std::sqrt(0.25 * square(walk) + walk * noise);
  const double error = rest - track.rest;
  const bool jumps = exceeds(error, known + noise, gate::kRare);
  track.gain =
      jumps || !(known + noise > 0.0) ? 1.0 : std::max(known / (known + noise), 1.0 / track.one_square.count());
  track.rest += track.gain * error;
}

/// Adds the torque of a reading. model, model_before: torque at the reading, after and before the update with it.
void MeasuredTorques::addTorque(Track& track, StampNs stamp, double torque, double model,
                                double model_before) noexcept {
  const double step = seconds(stamp - track.stamp);
  if (track.readings > 0 && step > 0.0 && cameTogether(track.stamp, stamp)) return;
  if (track.readings > 0 && step > 0.0) {
    const double change = torque - track.torque;
    track.oil_square.add(square(change - (model_before - track.model)));
    track.line_square.add(square(change - step * track.slope));
    followRest(track, torque - model);
    track.slope = change / step;
    track.interval = step;
    track.swing.add(torque, step);
    track.unexplained.add(torque - model, step);
  }
  if (track.readings == 0) track.swing.begin(torque), track.unexplained.begin(torque - model);
  if (track.readings == 0 || !(step > 0.0)) track.rest = track.last = track.before = torque - model, track.gain = 1.0;
  track.stamp = stamp, track.torque = torque, track.model = model;
}

MeasuredTorques::StampUncertainty MeasuredTorques::stampUncertainty(const Vibration& vibration,
                                                                    double stamp_noise) noexcept {
  const auto& identifier = vibration.identifier();
  StampUncertainty stamps;
  stamps.stamp_noise = stamp_noise;
  if (!identifier) return stamps;
  stamps.delay = identifier->delay(Clock::kPressures);
  stamps.delay_std = identifier->delayDeviation(Clock::kPressures);
  const double ratio = identifier->oilInnovationRatio();
  // If the delay of the stamps is identified, a residual that does not fit is not due to a delay.
  stamps.misfit = ratio > kContradicted && identifier->isLagKnown();
  if (ratio > kContradicted && !stamps.misfit) stamps.lag = square(kLag) * ratio;
  return stamps;
}

void MeasuredTorques::follow(const Boom& boom, const JointVector& position, const JointVector& steady,
                             const JointVector& motion, const Instant& instant,
                             const CylinderPressures& pressures) noexcept {
  const StampNs sample = instant.stamp;
  Vibration::OilTorque model = boom.vibration().oilTorque();
  model.now += steady;
  if (model_.now.size() != model.now.size()) model_ = model, read_ = model.now, sample_ = sample;
  const StampUncertainty stamps = stampUncertainty(boom.vibration(), instant.noise);
  const bool gap = seconds(sample - sample_) > look_back::kHalfTurn;  // no prediction that could be judged
  StampNs oil_at{};
  JointVector oil_then;  // at that stamp, which is the same for most cylinders
  for (std::size_t i = 0; i < boom.cylinders().size(); ++i) {
    const Cylinder& cylinder = boom.cylinders()[i];
    const int j = cylinder.joint();
    Track& track = tracks_[i];
    if (position[j] != track.position) track.at = cylinder.at(position[j]), track.position = position[j];
    const CylinderPosition& at = track.at;  // the measured lever belongs to a measured force
    torque_[i].reset();
    const StampNs stamp = pressures.newest(i);
    const std::optional<ChamberPressures> read = pressures.at(i, stamp);
    if (!read || !pressures.known(i, sample) || at.zero_moment_arm) {
      track.goes_on = false;
      continue;
    }
    if (pressures.count(i) != track.readings) {
      const double before = read_[j] + seconds(stamp - sample_) * model_.rate[j];
      if (oil_then.size() == 0 || stamp != oil_at)
        oil_then = boom.vibration().oilTorqueRead(seconds(stamp - sample)), oil_at = stamp;
      const double torque = -forceOf(cylinder, *read) * at.arm;
      if (gap || !track.goes_on) track.stamp = stamp, track.slope = 0.0;
      addTorque(track, stamp, torque, oil_then[j] + steady[j], before);
      track.readings = pressures.count(i);
      track.goes_on = true;
    }
    torque_[i] = torqueNow(track, seconds(sample - stamp), {model.now[j], model.rate[j]}, stamps);
    addConstants(boom, i, motion[j], seconds(sample - sample_), *torque_[i]);
  }
  read_ = stamps.delay != 0.0 ? JointVector(boom.vibration().oilTorqueRead(0.0) + steady) : model.now;
  model_ = model, sample_ = sample;
}

/// Returns the torque at the sample. age: of the last reading [s].
MeasuredTorques::Torque MeasuredTorques::torqueNow(const Track& track, double age, const Model& model,
                                                   const StampUncertainty& stamps) noexcept {
  const double ahead = std::min(age + stamps.delay, look_back::kLine);
  const double line_square = longerLine(stamps.delay, track.interval) * track.line_square.mean();
  const bool by_oil = track.oil_square.mean() <= line_square;
  // A residual that does not fit is then an oscillation of a hose and not of the load.
  const double rest = stamps.misfit ? track.unexplained.mean.mean() : track.rest;
  const double value = by_oil ? rest + model.now : track.torque + ahead * track.slope;
  const double lost = forgottenPart(overdue(age, track.interval));
  // A change has the noise of two readings, a smoothed residual that of one or less.
  const double of_change = by_oil ? 0.5 * (1.0 + track.gain) : 1.0;
  const double off = std::sqrt(of_change * std::min(track.oil_square.mean(), line_square) +
                               (stamps.lag + 2.0 * lost) * track.swing.square.mean() +
                               (stamps.misfit ? track.unexplained.square.mean() : 0.0) +
                               (square(stamps.delay_std) + square(stamps.stamp_noise)) * square(model.rate));
  return {value, off, 0.0, 0.0, track.at};
}

/// Adds the friction of seals, its uncertainty and that of the sensors' offsets. motion: of the joint [rad/s].
void MeasuredTorques::addConstants(const Boom& boom, std::size_t i, double motion, double step,
                                   Torque& torque) noexcept {
  const Cylinder& cylinder = boom.cylinders()[i];
  const double arm = torque.at.arm;
  const auto& identifier = boom.vibration().identifier();
  Seals seals = sealsOf(cylinder, arm, torque.value, motion);
  if (identifier) seals = identifier->withIdentified(i, seals);
  const double vibrating = boom.vibration().velocity()[cylinder.joint()];
  Track& track = tracks_[i];
  track.way = seals.wayAfter(track.way, vibrating, std::max(0.0, step));
  if (!std::isfinite(track.way)) track.way = 0.0;
  const Rubbing rubbed = rubbing(seals, vibrating, track.way);
  // With a wrong joint zero the lever is that of another angle.
  const CylinderParameters& p = cylinder.parameters();
  const double offset = square(arm * cylinder.boreArea() * p.pressure_offset_std) +
                        square(torque.value * torque.at.arm_rate / arm * p.joint_zero_std);
  torque.value += rubbed.torque;
  torque.constant =
      std::sqrt(square(rubbed.deviation) + offset + (identifier ? square(identifier->dampingWithoutOil(i)) : 0.0));
  torque.lasting = std::sqrt(square(rubbed.lasting) + offset);
}

}  // namespace hammer_loads
