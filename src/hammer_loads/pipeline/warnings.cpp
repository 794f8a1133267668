#include "hammer_loads/pipeline/warnings.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/pipeline/boom_warnings.h"
#include "hammer_loads/pipeline/reading_warnings.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

std::string count(std::uint64_t n) { return std::to_string(n); }

void warnOfUnits(const Pipeline& pipeline, const SampleCounts& counts, std::vector<Warning>& warnings) {
  const CrankUnit unit = pipeline.crank().unit();
  const bool boom = pipeline.hull().anglesLookLikeDegrees();
  const std::uint64_t degrees = counts.refusedFor(Refusal::kDegrees), speed = counts.refusedFor(Refusal::kSpeedUnit),
                      turns = counts.refusedFor(Refusal::kAngleUnit);
  const auto withheld = [](std::uint64_t samples) { return "; " + count(samples) + " samples withheld"; };
  if (degrees > 0 || unit == CrankUnit::kDegrees || boom)
    warnings.push_back({"degrees",
                        std::string(boom ? "boom joints" : "crank") +
                            ": angle or speed is in degrees, must be in radians" + withheld(degrees),
                        boom || unit == CrankUnit::kDegrees});
  if (turns > 0 || isOfAngle(unit))
    warnings.push_back({"angle unit",
                        std::string("crank: ") +
                            (isOfAngle(unit) ? textOf(unit) : "angle was in turns or counts, must be in radians") +
                            withheld(turns),
                        isOfAngle(unit)});
  const bool now = isOfSpeed(unit);
  if (speed == 0 && !now) return;
  warnings.push_back({"speed unit",
                      std::string("crank: ") +
                          (now ? textOf(unit) : "speed was of another unit or sign, must be in rad/s") +
                          withheld(speed),
                      now});
}

/// Returns true if angle or speed are in another unit. Other properties of the readings then give no information.
bool isOtherUnit(const Pipeline& pipeline, const SampleCounts& counts) {
  return pipeline.crank().unit() != CrankUnit::kRadians || counts.inOtherUnit() > counts.accepted;
}

void warnOfCrank(const Pipeline& pipeline, const SampleCounts& counts, std::vector<Warning>& warnings) {
  const std::uint64_t samples = counts.accepted + counts.refusedTotal();
  if (counts.refusedFor(Refusal::kMissingJoint) == samples && samples > 0)
    warnings.push_back({"crank joint",
                        "crank joint " + pipeline.settings().crank_joint + ": in none of " + count(samples) +
                            " messages. Set crank_joint to the joint's name.",
                        true, true});
  if (pipeline.crank().angleIsFrozen())
    warnings.push_back(
        {"frozen", "crank: the angle stands still while the speed goes on; nothing is published. Check the encoder.",
         true});
  const std::uint64_t backward = counts.refusedFor(Refusal::kBackward);
  if (isOtherUnit(pipeline, counts)) return;
  if (pipeline.crankTrust().turnsBackward() || backward > counts.accepted)
    warnings.push_back(
        {"backward",
         "crank: turns backward, " + count(backward) + " samples withheld. Give crank_direction the other sign.",
         true});
}

/// Warns of jitter of header stamps, as estimated, or of stamps refitted by sequence. At work, half the standard
/// deviation of an encoder count hides jitter.
void warnOfStamps(const CrankFollower& crank, const CrankFilter& filter, double speed_at_work,
                  std::vector<Warning>& warnings) {
  constexpr double kJitter = 1e-4;  // [s]: from there on the wrench is some 0.2 % worse
  // Warning: kJitter
  if (crank.stamps().isSteady())
    warnings.push_back({"stamps",
                        format("crank stamps repeat or change places (jitter %.2g ms): equal intervals are assumed "
                               "(crank_stamps). State a delay as crank_latency_s.",
                               1e-6 * crank.stamps().fit().scatter()),
                        true});
  const double count = filter.encoder().resolution() / std::sqrt(12.0), period = crank.task().period();
  if (period > 0.0)
    return warnings.push_back({"task",
                               format("crank angles come from a controller's task of %.3g ms: old, averaged or "
                                      "repeated. The deviations contain it. Stamp in the task.",
                                      1e3 * period),
                               true});
  if (filter.timingNoise() > std::max(kJitter, 0.5 * count / speed_at_work))
    warnings.push_back({"jitter",
                        format("crank stamps jitter by %.2g ms, which widens the deviations. Stamp at the instant of "
                               "measurement.",
                               1e3 * filter.timingNoise()),
                        true});
}

/// Apparent errors of the sensor's mounting if the crank's filter takes an elastic rod for rigid. The zero looks
/// smaller by 0.2 to 3 deg (rods of 2e8 to 1e10 N/m, joint clearance to 0.5 mm, 200 Hz to 1 kHz); larger errors are
/// withheld. The encoder looks eccentric by 1 deg.
constexpr double kRodLooksEccentric = 1.5 * kDegree;
// Warning: kRodLooksEccentric

/// Returns the part of an amount that such a rod does not explain.
double beyondRod(const Unknown& unknown, double amount) {
  if (std::string_view(unknown.name) == "zero") return std::max(0.0, amount);
  return std::max(0.0, std::abs(amount) - kRodLooksEccentric);
}

/// Warns of constants whose error the innovations show, using the table of constants.
void warnOfConstants(const ConstantErrors& errors, const ZeroWatch::Stated& zero, const CrankSensor& sensor,
                     bool rod_is_elastic, std::vector<Warning>& warnings) {
  for (std::size_t i = 0; i < kUnknowns.size();) {
    const Unknown& first = kUnknowns[i];
    double amount = 0.0, deviation = 0.0;
    const auto begin = i;
    for (; i < kUnknowns.size() && std::string_view(kUnknowns[i].name) == first.name; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      amount = i == begin ? errors.estimate()[at] : std::hypot(amount, errors.estimate()[at]);
      deviation = std::max(deviation, errors.deviation()[at]);
      if (at == ConstantErrors::kZero) amount = zero.error, deviation = zero.deviation;
    }
    const double certain = rod_is_elastic ? beyondRod(first, amount) : std::abs(amount);
    const bool named = first.warning != nullptr && certain > std::max(first.notable, gate::kUsual * deviation);
    if (first.of_reading) amount /= sensor.gain(), deviation /= std::abs(sensor.gain());
    if (named) warnings.push_back({first.name, first.warning(amount, deviation), true});
  }
}

/// Returns the text on the zero that the readings show, in the sensor's own angle, and the remedy.
std::string zeroFarOff(const Pipeline& pipeline, const CrankFilter& filter) {
  const CrankSensor& sensor = pipeline.settings().crank_sensor;
  const ZeroWatch::Stated stated = pipeline.zeroWatch().stated(filter);
  const double off = stated.error / sensor.gain(), deviation = stated.deviation / std::abs(sensor.gain());
  const double zero = sensor.place().zero, found = std::remainder(zero + off, kTwoPi);
  std::string action = "set it, or run calibrate";
  if (!pipeline.zeroWatch().isSettled())
    return format(
        "crank_zero_rad is off by about %.1f +- %.1f deg: loads are withheld while it is refined. Run calibrate.",
        off / kDegree, deviation / kDegree);
  if (std::abs(zero) >= 1.0 && std::abs(std::remainder(zero * kDegree - found, kTwoPi)) < 0.1)
    action = format("%.4g degrees would fit", zero);
  return format("crank_zero_rad is off by %.2f +- %.2f deg (%.4f rad would fit): %s: %s.", off / kDegree,
                deviation / kDegree, found, pipeline.zeroWatch().withholds() ? "loads are withheld" : "it is corrected",
                action.c_str());
}

/// Returns the text on an elastic rod. Its apparent errors of sensor or hammer file in a rigid model are not reported.
std::string rodOf(const Pipeline& pipeline, const CrankFilter& filter) {
  const ElasticFollower& elastic = pipeline.elastic();
  if (elastic.isUsed()) {
    const UnknownForce::Largest largest = pipeline.unknownForce().largest();
    return format(
        "crank: an unknown force of %.1f kN after the blow is in the deviations, most of it by %s. Measure %s.",
        1e-3 * largest.force, largest.name, largest.key);
  }
  if (elastic.isWanted())
    return format("crank: level elastic is not used: %s. The deviations contain the rod's vibration.",
                  elastic.whyNotUsed());
  return format(
      "crank: connecting rod or pins are elastic (%.2g times the expected variance after the blow). Use level: "
      "elastic.",
      filter.rodEvidence().pickedUp());
}

/// Returns the cause of the contradiction to the model, from its place in the revolution. strike: also before the blow.
std::string contradictionOf(const Pipeline& pipeline, bool strike) {
  const CrankFilter& filter = pipeline.crank().tracker();
  const double all = filter.consistency(), before = filter.strikeConsistency();
  if (pipeline.crankTrust().isLost() || !std::isfinite(all))
    return "crank: the estimate is lost before each blow. Check crank_zero_rad, the hammer file and the coupling of "
           "the encoder.";
  if (!strike)
    return format(
        "crank: readings differ from the model after the blow (%.2g times the variance); deviations are too small. "
        "Check the coupling.",
        all);
  if (filter.rodEvidence().showsElasticRod())
    return format(
        "crank: readings differ from the model (%.2g times the variance): rod or pins may be elastic. Check hammer "
        "file, coupling.",
        all);
  if (std::max(all, before) > mismatch::kSeen)
    return format(
        "crank: readings differ from the model (%.2g times the variance, before the blow %.2g). Check crank_zero_rad, "
        "hammer file, coupling.",
        all, before);
  return format(
      "crank: readings differed from the model again and again (now %.2g times the variance). Check crank_zero_rad, "
      "hammer file.",
      all);
}

/// Returns true if most samples are withheld, as their readings contradict the model before the blow.
bool mostIsWithheld(const SampleCounts& counts) { return counts.refusedFor(Refusal::kInconsistent) > counts.accepted; }

/// Returns the text for a crank that was withheld and is no longer.
std::string agreesAgain(const CrankFilter& filter, std::uint64_t withheld) {
  return format(
      "crank: %s samples withheld while readings contradicted the model; now they agree (%.2g times the variance). "
      "Check the start.",
      count(withheld).c_str(), filter.consistency());
}

/// Warns of readings that contradict the model. rod_is_elastic: an elastic connecting rod explains them.
void warnOfMismatch(const Pipeline& pipeline, const CrankFilter& filter, bool rod_is_elastic,
                    std::vector<Warning>& warnings) {
  const std::uint64_t withheld = pipeline.counts().refusedFor(Refusal::kInconsistent);
  const bool strike = filter.strikeConsistency() > CrankTrust::kInconsistent;
  const bool now = filter.consistency() > CrankTrust::kInconsistent || strike || filter.isUnexplained() ||
                   pipeline.crankTrust().isInconsistent() || mostIsWithheld(pipeline.counts());
  if (now && !rod_is_elastic)
    return warnings.push_back({"inconsistent", contradictionOf(pipeline, strike || withheld > 0), true});
  if (rod_is_elastic) {
    warnings.push_back({withheld > 0 ? "inconsistent" : "rod", rodOf(pipeline, filter), true});
  } else if (withheld > 0) {
    warnings.push_back({"inconsistent before", agreesAgain(filter, withheld), false});
  }
  warnOfConstants(filter.constantErrors(), pipeline.zeroWatch().stated(filter), pipeline.settings().crank_sensor,
                  rod_is_elastic, warnings);
}

/// Warns of a sensor error to which the filter's innovations point.
void warnOfSensor(const Pipeline& pipeline, std::vector<Warning>& warnings) {
  constexpr std::uint64_t kLearned = 10;  // blows: before them the filter is still learning
  // Warning: kLearned
  const CrankFilter& filter = pipeline.crank().tracker();
  const std::uint64_t withheld = pipeline.counts().refusedFor(Refusal::kInconsistent);
  if (pipeline.crankTrust().turnsBackward() || isOtherUnit(pipeline, pipeline.counts())) return;
  if (pipeline.counts().blows < kLearned && withheld == 0) return;
  if (pipeline.zeroWatch().isOff())  // anything else that is seen may follow from it
    return warnings.push_back(
        {pipeline.zeroWatch().withholds() ? "zero off" : "zero", zeroFarOff(pipeline, filter), true});
  // A rod alone rarely causes most of a recording to contradict the model before the blow.
  const bool rod_is_elastic = filter.rodEvidence().showsElasticRod() && !mostIsWithheld(pipeline.counts());
  if (filter.isLost())
    warnings.push_back({"lost",
                        std::string("crank: the estimate restarts again and again; readings and ") +
                            (rod_is_elastic ? "a rigid rod" : "hammer file") + " contradict each other. Check both.",
                        true});
  if (filter.encoder().contradictsGiven())
    warnings.push_back(
        {"count",
         format("crank_angle_resolution_rad: %.9g rad is given, the readings have %.9g rad. Set 0 to read it off.",
                pipeline.settings().crank_angle_resolution, filter.encoder().resolution()),
         true});
  warnOfStamps(pipeline.crank(), filter, kTwoPi * pipeline.settings().turn_rate, warnings);
  warnOfReadings(pipeline.crank(), filter, warnings);
  warnOfMismatch(pipeline, filter, rod_is_elastic, warnings);
}

}  // namespace

bool isContradiction(std::string_view key) noexcept {
  constexpr std::string_view kKeys[] = {"degrees",      "angle unit",          "speed unit", "backward",
                                        "inconsistent", "inconsistent before", "zero off",   "lost"};
  return std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys);
}

std::vector<Warning> warningsOf(const Pipeline& pipeline) {
  std::vector<Warning> warnings;
  const SampleCounts counts = pipeline.counts();
  warnOfUnits(pipeline, counts, warnings);
  warnOfCrank(pipeline, counts, warnings);
  warnOfSensor(pipeline, warnings);
  warnOfHull(pipeline, counts, warnings);
  if (pipeline.boom() && counts.accepted > 0)
    warnOfBoom(*pipeline.boom(), pipeline.result().boom, pipeline.hull().imuTrust().isLost(), warnings);
  return warnings;
}

}  // namespace hammer_loads
