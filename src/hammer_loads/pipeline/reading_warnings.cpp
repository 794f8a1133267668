#include "hammer_loads/pipeline/reading_warnings.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// A measured speed that leads the angle means that the angle lags.
void warnOfSpeeds(const SpeedTrust& speeds, const AngleLag& taken_off, std::vector<Warning>& warnings) {
  const auto warnOfAngles = [&](double lag, double deviation, const char* what_is_done) {
    warnings.push_back({"angle lag",
                        format("crank angles lag the speeds by %.3g +- %.1g ms; %s. Set crank_latency_s, or check the "
                               "encoder's filter.",
                               1e3 * lag, 1e3 * deviation, what_is_done),
                        true});
  };
  const double lag = speeds.lag(), deviation = speeds.lagDeviation();
  if (speeds.lags() && lag > 0.0)
    warnings.push_back({"speed lag",
                        format("crank speeds lag the angles by %.3g +- %.1g ms and serve the start alone. Remove the "
                               "filter of the drive.",
                               1e3 * lag, 1e3 * deviation),
                        true});
  if (taken_off.isThere())
    warnOfAngles(taken_off.lag(), taken_off.deviation(), "this is corrected");
  else if (speeds.lags() && lag < 0.0)
    warnOfAngles(-lag, deviation, "the deviations contain it");
  if (speeds.isOutOfScale())
    warnings.push_back(
        {"speed scale",
         format("crank speeds are %.4g +- %.1g times those of the angles and serve the start alone. Check "
                "their unit.",
                1.0 + speeds.scale(), speeds.scaleDeviation()),
         true});
}

/// Returns the text for an IMU whose mounting or unit is wrong. weight: of the hull, from the joint angles.
std::string faultOf(const ImuTrust& trust, const Gravity& weight) {
  constexpr double kAlike = 1.2;  // factor between weights: blows add less to a mean of 2 s
  // Warning: kAlike
  if (trust.turnsTooFast())
    return format(
        "it turns by %.3g rad/s rms, more than a hull does (in degrees per second %.2g rad/s). Publish rad/s.",
        trust.rate(), trust.rate() * kDegree);
  const double size = trust.mean().norm(), expected = std::hypot(weight.x, weight.z);
  const auto isAlike = [&](double other) { return size < kAlike * other && other < kAlike * size; };
  const std::string mean =
      format("its mean is (%.3g, %.3g, %.3g) m/s2", trust.mean().x(), trust.mean().y(), trust.mean().z());
  if (isAlike(1.0)) return mean + ". The weight is in g; publish m/s2.";
  if (!isAlike(expected))
    return mean + format(", by the joint angles (%.3g, 0, %.3g). Check unit and axes.", -weight.x, -weight.z);
  const double along = -(trust.mean().x() * weight.x + trust.mean().z() * weight.z) / (size * expected);
  return mean + format(", turned by %.0f degrees. Check imu_roll_rad, imu_pitch_rad and imu_yaw_rad.",
                       std::acos(std::clamp(along, -1.0, 1.0)) / kDegree);
}

/// Warns of the IMU. samples: number of accepted crank samples.
void warnOfImu(const HullState& hull, std::uint64_t samples, std::vector<Warning>& warnings) {
  constexpr double kOftenMissed = 0.1;
  // Warning: kOftenMissed
  const ImuTrust& trust = hull.imuTrust();
  const double missed = static_cast<double>(hull.imuCounts().missed) / static_cast<double>(samples);
  if (hull.imuCounts().accepted == 0) {
    warnings.push_back({"imu",
                        "hull_motion: imu, but no reading of hull_imu came; weight by pitch instead. Check the topic.",
                        true, true});
  } else if (trust.isFrozen()) {
    warnings.push_back({"imu", "hull_imu: not used, its readings stand still. Check the driver.", true});
  } else if (trust.isLost()) {
    warnings.push_back({"imu", "hull_imu: not used, " + faultOf(trust, hull.gravity()), true});
  } else if (missed > kOftenMissed) {
    warnings.push_back({"imu late",
                        format("hull_imu: no reading in time for %.0f %% of the crank samples; weight by pitch there. "
                               "Check its rate and delay.",
                               100.0 * std::min(missed, 1.0)),
                        false});
  }
}

}  // namespace

void warnOfReadings(const CrankFollower& crank, const CrankFilter& filter, std::vector<Warning>& warnings) {
  warnOfSpeeds(filter.speedTrust(), filter.angleLag(), warnings);
  if (crank.stamps().rounding() > 0.0)
    warnings.push_back({"whole stamps",
                        format("crank stamps are whole multiples of %.3g ms: all may be off by half of that; the "
                               "deviations contain it. Use finer stamps.",
                               1e3 * crank.stamps().rounding()),
                        true});
  const EncoderSlip& slip = filter.encoderSlip();
  if (crank.slipped() && slip.last() != 0.0)
    warnings.push_back(
        {"slip",
         format(
             "crank_zero_rad: the encoder slipped by %.2g +- %.1g deg at stamp %.1f s (slip %d); the zero is now %.4g "
             "rad. Tighten the coupling.",
             slip.last() / kDegree, slip.deviation() / kDegree, seconds(*crank.slipped()), slip.count(),
             filter.encoder().place().place().zero),
         true});
}

void warnOfHull(const Pipeline& pipeline, const SampleCounts& counts, std::vector<Warning>& warnings) {
  if (counts.accepted == 0) return;
  const HullState& hull = pipeline.hull();
  const std::vector<std::string> unheard = hull.pitch().unheard();
  if (!unheard.empty())
    warnings.push_back(
        {"pitch joints",
         "no angle of " + joined(unheard) + " (pitch_joints): weight by hull_pitch_rad. Check joint_states.", true,
         true});
  constexpr double kMostPitch = 1.2;  // [rad]: a hammer that works strikes downward
  // Warning: kMostPitch
  const double pitch = hull.pitch().pitch();
  if (hull.pitch().known() && std::abs(pitch) > kMostPitch && counts.blows > 0 && !hull.anglesLookLikeDegrees())
    warnings.push_back({"pitch",
                        format("hull pitch is %.0f deg at work: its weight is wrong if the tool points down. "
                               "Check pitch_signs and pitch_offset_rad.",
                               pitch / kDegree),
                        true});
  if (pipeline.settings().hull_motion == HullMotionSource::kImu || hull.imuCounts().accepted > 0)
    warnOfImu(hull, counts.accepted, warnings);
}

}  // namespace hammer_loads
