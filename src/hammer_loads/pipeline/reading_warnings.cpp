#include "hammer_loads/pipeline/reading_warnings.h"

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

}  // namespace hammer_loads
