#include "hammer_loads/pipeline/reading_warnings.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// A speed cannot be ahead of its crank: then the angle is behind it.
void warnOfSpeeds(const SpeedTrust& speeds, const AngleLag& taken_off, std::vector<Warning>& warnings) {
  const auto warnOfAngles = [&](double lag, double deviation, const char* what_is_done) {
    warnings.push_back({"angle lag",
                        format("crank angles are %.3g ms (deviation %.1g ms) behind the measured speeds: they are "
                               "filtered, or crank_latency_s is that much too small; at an even speed crank_zero_rad "
                               "looks alike; %s",
                               1e3 * lag, 1e3 * deviation, what_is_done),
                        true});
  };
  const double lag = speeds.lag(), deviation = speeds.lagDeviation();
  if (speeds.lags() && lag > 0.0)
    warnings.push_back({"speed lag",
                        format("crank speeds (velocity) lag behind the angles by %.3g ms (deviation %.1g ms), as a "
                               "drive's filter makes it: they serve the start alone",
                               1e3 * lag, 1e3 * deviation),
                        true});
  if (taken_off.isThere())
    warnOfAngles(taken_off.lag(), taken_off.deviation(), "it is taken off the readings");
  else if (speeds.lags() && lag < 0.0)
    warnOfAngles(-lag, deviation, "not corrected, the deviations hold it");
  if (speeds.isOutOfScale())
    warnings.push_back({"speed scale",
                        format("crank speeds (velocity) are %.4g times those of the angles (deviation %.1g): they "
                               "serve the start alone",
                               1.0 + speeds.scale(), speeds.scaleDeviation()),
                        true});
}

/// Of a unit that is not where or what it is said to be. weight: of the hull by the joint angles.
std::string faultOf(const ImuTrust& trust, const Gravity& weight) {
  constexpr double kAlike = 1.2;  // factor between weights: what blows add to a mean of 2 s is less
  if (trust.turnsTooFast())
    return format(
        "it turns by %.3g rad/s, root mean square, as no hull does (in degrees per second that is %.2g rad/s)",
        trust.rate(), trust.rate() * kDegree);
  const double size = trust.mean().norm(), expected = std::hypot(weight.x, weight.z);
  const auto isAlike = [&](double other) { return size < kAlike * other && other < kAlike * size; };
  const std::string mean = format("on the mean it shows (%.3g, %.3g, %.3g) m/s2 along x, y, z of the hull",
                                  trust.mean().x(), trust.mean().y(), trust.mean().z());
  if (isAlike(1.0)) return mean + ": its weight is in g, must be in m/s2";
  if (!isAlike(expected)) return mean + format(", by the joint angles (%.3g, 0, %.3g)", -weight.x, -weight.z);
  const double along = -(trust.mean().x() * weight.x + trust.mean().z() * weight.z) / (size * expected);
  return mean + format(": turned by %.0f degrees from where imu_roll_rad, imu_pitch_rad and imu_yaw_rad put it",
                       std::acos(std::clamp(along, -1.0, 1.0)) / kDegree);
}

}  // namespace

void warnOfReadings(const CrankFollower& crank, const CrankFilter& filter, std::vector<Warning>& warnings) {
  warnOfSpeeds(filter.speedTrust(), filter.angleLag(), warnings);
  if (crank.stamps().rounding() > 0.0)
    warnings.push_back({"whole stamps",
                        format("crank stamps are whole multiples of %.3g ms: all samples may be off by half of that "
                               "alike (crank_latency_s); the deviations hold it",
                               1e3 * crank.stamps().rounding()),
                        true});
  const EncoderSlip& slip = filter.encoderSlip();
  if (crank.slipped() && slip.last() != 0.0)
    warnings.push_back(
        {"slip",
         format("crank_zero_rad: the encoder slipped by %.2g deg (%.3g rad, deviation %.1g rad) at stamp %.1f s; since "
                "then the zero is taken for %.4g rad%s",
                slip.last() / kDegree, slip.last(), slip.deviation(), seconds(*crank.slipped()),
                filter.encoder().place().place().zero,
                slip.count() > 1 ? format(", slips so far: %d", slip.count()).c_str() : ""),
         true});
}

void warnOfHull(const Pipeline& pipeline, const SampleCounts& counts, std::vector<Warning>& warnings) {
  if (counts.accepted == 0) return;
  const HullState& hull = pipeline.hull();
  const std::vector<std::string> unheard = hull.pitch().unheard();
  if (!unheard.empty())
    warnings.push_back(
        {"pitch joints", "no angle of " + joined(unheard) + " (pitch_joints): weight by hull_pitch_rad", true, true});
  constexpr double kMostPitch = 1.2;  // [rad]: a hammer that works strikes downward
  const double pitch = hull.pitch().pitch();
  if (hull.pitch().known() && std::abs(pitch) > kMostPitch && counts.blows > 0 && !hull.anglesLookLikeDegrees())
    warnings.push_back({"pitch",
                        format("hull pitch is %.0f deg at work: its weight is wrong if the tool points down. "
                               "Check pitch_signs and pitch_offset_rad.",
                               pitch / kDegree),
                        true});
  const bool imu = pipeline.settings().hull_motion == HullMotionSource::kImu;
  if (imu && hull.imuCounts().accepted == 0)
    warnings.push_back(
        {"imu", "hull_motion: imu, but no reading of hull_imu came; weight by pitch instead", true, true});
  const ImuTrust& trust = hull.imuTrust();
  const auto& weight = hull.gravity();
  if (trust.isFrozen()) {
    warnings.push_back({"imu", "hull_imu: not used, its readings stand still", true});
  } else if (trust.isLost()) {
    warnings.push_back({"imu", "hull_imu: not used, " + faultOf(trust, weight), true});
  }
}

}  // namespace hammer_loads
