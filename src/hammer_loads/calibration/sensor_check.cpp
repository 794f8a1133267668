#include "hammer_loads/calibration/sensor_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/median.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kQuietNoise = 8.0;  // ratio to the other recordings at the quietest instants
constexpr double kLoudNoise = 40.0;  // ratio to the other recordings, rms: intermittent errors
constexpr double kLeap = 0.005;      // [rad]; 0.3 deg, the standard deviation of a zero
constexpr double kLeapOverNoise = 10.0;
constexpr double kLeapStays = 0.6;   // least part of a leap that remains between the readings before and after
constexpr double kBesideLeap = 0.3;  // [s]
constexpr std::ptrdiff_t kLeastBeside = 5;
constexpr double kStays = 0.5;          // [s]
constexpr double kNoiseOverStep = 2.0;  // ratio of noise to the step of the readings above which they never repeat
// Warning: kQuietNoise, kLoudNoise, kLeap, kLeapOverNoise, kLeapStays, kBesideLeap, kStays, kNoiseOverStep

/// Returns the standard deviation of a joint's rate when quietest: sensor noise, to which motion adds elsewhere.
double quietNoise(const BoomPoints& recording, int joint) {
  std::vector<double> all;
  for (const BoomPoint& point : recording.points) all.push_back(point.rate_std[joint]);
  if (all.empty()) return 0.0;
  const auto tenth = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 10);
  std::nth_element(all.begin(), tenth, all.end());
  return *tenth;
}

double rmsNoise(const BoomPoints& recording, int joint) {
  double square = 0.0;
  for (const BoomPoint& point : recording.points) square += point.rate_std[joint] * point.rate_std[joint];
  return std::sqrt(square / std::max<double>(1.0, static_cast<double>(recording.points.size())));
}

/// Returns each value over the median of the others.
std::vector<double> overOthers(const std::vector<double>& values) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> others = values;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const double usual = medianOf(others);
    ratios.push_back(usual > 0.0 ? values[i] / usual : 0.0);
  }
  return ratios;
}

/// Returns the value at `time` of a line through the readings from first up to last.
double lineAt(const Trace& trace, std::size_t first, std::size_t last, double time) {
  double t = 0.0, x = 0.0, tt = 0.0, tx = 0.0;
  const auto count = static_cast<double>(last - first);
  for (std::size_t i = first; i < last; ++i) t += trace.time[i] - time, x += trace.value[i];
  t /= count, x /= count;
  for (std::size_t i = first; i < last; ++i) {
    const double from = trace.time[i] - time - t;
    tt += from * from, tx += from * (trace.value[i] - x);
  }
  return tt > 0.0 ? x - t * tx / tt : x;
}

/// Returns the size of a leap between reading i and the next [rad]; zero if there is none.
double leapAfter(const Trace& trace, std::size_t i) {
  const double middle = 0.5 * (trace.time[i] + trace.time[i + 1]);
  const auto at = [&](double time) {
    return static_cast<std::size_t>(std::lower_bound(trace.time.begin(), trace.time.end(), time) - trace.time.begin());
  };
  const std::size_t first = at(middle - kBesideLeap), last = at(middle + kBesideLeap);
  const std::size_t beside = static_cast<std::size_t>(kLeastBeside);
  if (i + 1 - first < beside || last - i - 1 < beside) return 0.0;
  std::vector<double> steps, off;
  for (std::size_t k = first; k + 1 < last; ++k) steps.push_back(trace.value[k + 1] - trace.value[k]);
  const double usual = medianOf(steps), leap = trace.value[i + 1] - trace.value[i] - usual;
  for (const double step : steps) off.push_back(std::abs(step - usual));
  if (std::abs(leap) < std::max(kLeap, kLeapOverNoise * medianOf(off))) return 0.0;
  const double stays = lineAt(trace, i + 1, last, middle) - lineAt(trace, first, i + 1, middle);
  return stays / leap > kLeapStays ? leap : 0.0;
}

struct Event {
  double time{}, size{};
};

std::optional<Event> firstLeap(const Trace& trace) {
  for (std::size_t i = 0; i + 1 < trace.value.size(); ++i) {
    if (std::abs(trace.value[i + 1] - trace.value[i]) < kLeap) continue;
    if (const double leap = leapAfter(trace, i); leap != 0.0) return Event{trace.time[i], leap};
  }
  return {};
}

/// Returns the longest time without any change.
Event longestStay(const Trace& trace) {
  Event longest;
  std::size_t since = 0;
  for (std::size_t i = 1; i < trace.value.size(); ++i) {
    if (trace.value[i] != trace.value[i - 1]) since = i;
    const double lasts = trace.time[i] - trace.time[since];
    if (lasts > longest.size) longest = {trace.time[since], lasts};
  }
  return longest;
}

/// Returns the noise of the changing readings over their step [-]; zero if none change.
double noiseOverStep(const Trace& trace) {
  std::vector<double> bends;
  double step = kInfinity;
  for (std::size_t i = 2; i < trace.value.size(); ++i) {
    const double change = std::abs(trace.value[i] - trace.value[i - 1]);
    if (!(change > 0.0)) continue;
    step = std::min(step, change);
    bends.push_back(trace.value[i] - 2.0 * trace.value[i - 1] + trace.value[i - 2]);  // variance: six times a reading's
  }
  return bends.empty() ? 0.0 : stdByMedian(bends, 0.0) / std::sqrt(6.0) / step;
}

constexpr double kFits = 0.5;    // part of the force, rms: errors of nominal masses, friction and zeros are smaller
constexpr double kBetter = 0.5;  // another interpretation must reduce the error to less than this part
constexpr double kBeyondLimit = 0.3;  // [rad]
// Warning: kFits, kBetter, kBeyondLimit

constexpr std::pair<const char*, double> kUnits[]{
    {"Pa", 1.0}, {"bar", 1e5}, {"psi", 6894.757}, {"kPa", 1e3}, {"MPa", 1e6}};

/// Returns the rms of measured minus expected force over that of the expected. The pressures are those of cylinder
/// `of`, in units of so many Pa.
double misfit(const BoomModel& model, const std::vector<double>& expected, const BoomPoints& recording,
              std::size_t cylinder, std::size_t of, bool exchanged, double unit) {
  const Cylinder& c = model.given().cylinders()[cylinder];
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!std::isfinite(expected[i])) continue;
    auto p = recording.points[i].pressure[of];
    if (exchanged) std::swap(p[0], p[1]);
    const double difference = unit * forceOf(c, {p[0], p[1]}) - expected[i];
    off += difference * difference, all += expected[i] * expected[i];
  }
  return all > 0.0 ? std::sqrt(off / all) : 0.0;
}

void checkCylinder(const BoomModel& model, const BoomPoints& recording, std::size_t cylinder,
                   std::vector<std::string>& lines) {
  Boom boom = model.given();
  std::vector<double> expected;
  for (const BoomPoint& point : recording.points) {
    model.move(boom, model.zero(), point);
    const int joint = boom.cylinders()[cylinder].joint();
    expected.push_back(
        boom.cylinders()[cylinder].load(boom.cylinderPosition(cylinder), boom.steadyTorque(joint)).force);
  }
  const double as_given = misfit(model, expected, recording, cylinder, cylinder, false, 1.0);
  if (as_given <= kFits) return;
  std::string best;
  double least = as_given;
  for (std::size_t of = 0; of < boom.cylinders().size(); ++of) {
    for (const bool exchanged : {false, true}) {
      for (const auto& [unit, pascal] : kUnits) {
        const double off = misfit(model, expected, recording, cylinder, of, exchanged, pascal);
        if (off >= least) continue;
        std::vector<std::string> differences;
        if (of != cylinder) differences.push_back("those of " + boom.cylinders()[of].parameters().name);
        if (exchanged) differences.emplace_back("bore and rod exchanged");
        if (pascal != 1.0) differences.push_back(std::string("in ") + unit);
        least = off, best = joined(differences);
      }
    }
  }
  const std::string& name = boom.cylinders()[cylinder].parameters().name;
  if (least < kBetter * as_given && least < kFits) {
    lines.push_back(format("%s: its pressures are off the boom's weight by %.0f %%, read as %s by %.0f %%",
                           name.c_str(), 100.0 * as_given, best.c_str(), 100.0 * least));
  } else {
    lines.push_back(
        format("%s: its pressures are off the boom's weight by %.0f %%, must be within %.0f %%: topics, "
               "units, bore, anchors or masses are otherwise than given",
               name.c_str(), 100.0 * as_given, 100.0 * kFits));
  }
}

}  // namespace

std::vector<double> noiseRatios(const std::vector<BoomPoints>& recordings, int joint) {
  std::vector<double> noise;
  for (const BoomPoints& recording : recordings) noise.push_back(rmsNoise(recording, joint));
  return overOthers(noise);
}

std::vector<std::string> noisySensors(const Chain& chain, const std::vector<BoomPoints>& recordings,
                                      const std::vector<std::string>& names) {
  std::vector<std::string> lines;
  for (int j = 0; j < chain.joints() && recordings.size() > 1; ++j) {
    std::vector<double> quiet;
    for (const BoomPoints& recording : recordings) quiet.push_back(quietNoise(recording, j));
    const std::vector<double> quiet_ratios = overOthers(quiet), loud_ratios = noiseRatios(recordings, j);
    for (std::size_t r = 0; r < recordings.size(); ++r) {
      const bool always = quiet_ratios[r] > kQuietNoise;
      if (!always && loud_ratios[r] <= kLoudNoise) continue;
      lines.push_back(
          format("%s: its sensor's noise is %.0f times that of the other recordings in %s, must be within "
                 "%.0f times: faulty there, leave that recording out",
                 chain.jointNames()[static_cast<std::size_t>(j)].c_str(), always ? quiet_ratios[r] : loud_ratios[r],
                 names[r].c_str(), always ? kQuietNoise : kLoudNoise));
    }
  }
  return lines;
}

std::vector<std::string> brokenSensors(const Chain& chain, const std::vector<const BoomRecording*>& recordings,
                                       const std::vector<std::string>& names) {
  std::vector<std::string> lines;
  for (std::size_t j = 0; j < static_cast<std::size_t>(chain.joints()); ++j) {
    const char* joint = chain.jointNames()[j].c_str();
    double noise = 0.0;
    for (const BoomRecording* recording : recordings) noise = std::max(noise, noiseOverStep(recording->joint[j]));
    for (std::size_t r = 0; r < recordings.size(); ++r) {
      const Trace& trace = recordings[r]->joint[j];
      if (const auto leap = firstLeap(trace))
        lines.push_back(
            format("%s: its sensor leaps by %.2g deg after %.1f s of %s: faulty there, leave that recording out", joint,
                   leap->size / kDegree, leap->time, names[r].c_str()));
      const Event stay = longestStay(trace);
      if (stay.size > kStays && noise > kNoiseOverStep)
        lines.push_back(
            format("%s: its sensor reads the same for %.1f s after %.1f s of %s and is noisy elsewhere: faulty "
                   "there, leave that recording out",
                   joint, stay.size, stay.time, names[r].c_str()));
    }
  }
  return lines;
}

std::vector<std::string> misreadings(const BoomModel& model, const BoomPoints& recording) {
  std::vector<std::string> lines;
  const Chain& chain = model.given().chain();
  for (int j = 0; j < chain.joints(); ++j) {
    for (const BoomPoint& point : recording.points) {
      const double q = point.motion.position[j];
      if (q > chain.lower()[j] - kBeyondLimit && q < chain.upper()[j] + kBeyondLimit) continue;
      lines.push_back(
          format("%s: %.4g rad, must be within the description's limits from %.4g to %.4g: in degrees, or of "
                 "another zero",
                 chain.jointNames()[static_cast<std::size_t>(j)].c_str(), q, chain.lower()[j], chain.upper()[j]));
      break;
    }
  }
  if (!lines.empty()) return lines;
  for (std::size_t k = 0; k < model.given().cylinders().size(); ++k) checkCylinder(model, recording, k, lines);
  return lines;
}

}  // namespace hammer_loads::calibration
