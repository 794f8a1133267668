#include "hammer_loads/pipeline/warnings.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/unknowns.h"
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
  if (turns > 0 || unit == CrankUnit::kAngleInTurns)
    warnings.push_back({"angle unit", std::string("crank: ") + textOf(CrankUnit::kAngleInTurns) + withheld(turns),
                        unit == CrankUnit::kAngleInTurns});
  const bool now = unit == CrankUnit::kSpeedInRpm || unit == CrankUnit::kSpeedInTurns;
  if (speed == 0 && !now) return;
  warnings.push_back({"speed unit",
                      std::string("crank: ") +
                          (now ? textOf(unit) : "speed was in rpm or turns per second, must be in rad/s") +
                          withheld(speed),
                      now});
}

/// Angle or speed are in another unit, so whatever else the readings look like says nothing.
bool isOtherUnit(const Pipeline& pipeline, const SampleCounts& counts) {
  return pipeline.crank().unit() != CrankUnit::kRadians || counts.inOtherUnit() > counts.accepted;
}

void warnOfCrank(const Pipeline& pipeline, const SampleCounts& counts, std::vector<Warning>& warnings) {
  const std::uint64_t samples = counts.accepted + counts.refusedTotal();
  if (counts.refusedFor(Refusal::kMissingJoint) == samples && samples > 0)
    warnings.push_back({"crank joint",
                        "crank joint " + pipeline.settings().crank_joint + ": in none of " + count(samples) +
                            " messages, must be the joint's name (crank_joint)",
                        true, true});
  if (pipeline.crank().angleIsFrozen())
    warnings.push_back({"frozen", "crank: the angle stands still while the speed goes on", true});
  const std::uint64_t backward = counts.refusedFor(Refusal::kBackward);
  if (isOtherUnit(pipeline, counts)) return;
  if (pipeline.crankTrust().turnsBackward() || backward > counts.accepted)
    warnings.push_back(
        {"backward",
         "crank: turns backward, " + count(backward) + " samples withheld; crank_direction must have the other sign",
         true});
}

/// Instants: jitter of header stamps as it is learned, or stamps refitted by sequence. At work half a count's deviation
/// hides a jitter.
void warnOfStamps(const CrankFollower& crank, const CrankFilter& filter, double speed_at_work,
                  std::vector<Warning>& warnings) {
  constexpr double kJitter = 1e-4;  // [s]: from there on the wrench is some 0.2 % worse
  // Guard: WarningNumbers.StampsThatJitterByATenthOfAMillisecond of kJitter
  if (crank.stamps().isSteady())
    warnings.push_back({"stamps",
                        format("crank stamps repeat or change places and jitter by %.2g ms: samples are taken at equal "
                               "intervals (crank_stamps); a constant delay is crank_latency_s",
                               1e-6 * crank.stamps().fit().scatter()),
                        true});
  const double count = filter.encoder().resolution() / std::sqrt(12.0);
  if (filter.timingNoise() > std::max(kJitter, 0.5 * count / speed_at_work))
    warnings.push_back({"jitter",
                        format("crank stamps jitter by %.2g ms; stamps of the measurement's instant would be better",
                               1e3 * filter.timingNoise()),
                        true});
}

/// What a rod that gives makes of the sensor's place, if the crank's filter takes it for rigid: the zero looks smaller
/// by 0.2 to 3 deg (rods of 2e8 to 1e10 N/m, play to 0.5 mm, 200 Hz to 1 kHz), more is withheld; the encoder eccentric
/// by 1 deg.
constexpr double kRodLooksEccentric = 1.5 * kDegree;
// Guard: RodWarnings.WhatNoRodMakesIsNamedBesideIt of kRodLooksEccentric

/// How far an amount is beyond what such a rod explains.
double beyondRod(const Unknown& unknown, double amount) {
  if (std::string_view(unknown.name) == "zero") return std::max(0.0, amount);
  return std::max(0.0, std::abs(amount) - kRodLooksEccentric);
}

/// Constants whose error the innovations show, by their table. gives: the rod does.
void warnOfConstants(const ConstantErrors& errors, const CrankSensor& sensor, bool gives,
                     std::vector<Warning>& warnings) {
  for (std::size_t i = 0; i < kUnknowns.size();) {
    const Unknown& first = kUnknowns[i];
    double amount = 0.0, deviation = 0.0;
    const auto begin = i;
    for (; i < kUnknowns.size() && std::string_view(kUnknowns[i].name) == first.name; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      amount = i == begin ? errors.estimate()[at] : std::hypot(amount, errors.estimate()[at]);
      deviation = std::max(deviation, errors.deviation()[at]);
    }
    const double certain = gives ? beyondRod(first, amount) : std::abs(amount);
    const bool named = first.warning != nullptr && certain > std::max(first.notable, gate::kUsual * deviation);
    if (first.of_reading) amount /= sensor.gain(), deviation /= std::abs(sensor.gain());
    if (named) warnings.push_back({first.name, first.warning(amount, deviation), true});
  }
}

/// A zero that is off by more than such a crank's slowest place is known; in which unit it was given.
std::string zeroFarOff(const CrankSensor& sensor, double behind) {
  constexpr double kDegree = kTwoPi / 360.0;
  const double zero = sensor.place().zero, found = zero + behind / sensor.gain();
  const auto misses = [&](double other) { return std::abs(CrankAngle::wrapToPi((found - other) * sensor.gain())); };
  std::string text = format(
      "the crank is slowest %.2g rad behind where it must be: crank_zero_rad, %.4g rad, is off by "
      "some %.2g rad",
      behind, zero, behind / sensor.gain());
  if (std::abs(zero) >= 1.0 && misses(zero * kDegree) < CrankTrust::kSlowestKnown)
    text += format("; %.4g degrees, %.4g rad, would fit", zero, zero * kDegree);
  return text;
}

/// The rod gives: what a rigid model takes that for is not said of the sensor, nor of the hammer file.
std::string rodOf(const CrankFilter& filter) {
  const RodEvidence& rod = filter.rodEvidence();
  return format(
      "crank: just after the blow readings differ from a rigid rod's by %.2g times the expected variance, a quarter of "
      "a turn later by %.2g: rod, pins and bearings give (level: elastic; rod_stiffness_N_m, pin_play_m); "
      "crank_zero_rad "
      "looks %.2g deg off; such a rod makes it look 0.2 to 3 deg less than it is: neither is corrected",
      rod.pickedUp(), rod.later(), filter.constantErrors().estimate()[0] / kDegree);
}

/// As it is now; where it comes and goes, that it did.
std::string howMuchTheyDiffer(const CrankFilter& filter, bool is_lost) {
  const double all = filter.consistency(), strike = filter.strikeConsistency();
  if (is_lost || !std::isfinite(all)) return "crank: the estimate is lost before the blow, turn after turn: ";
  const char* how = std::max(all, strike) > mismatch::kSeen
                        ? "crank: readings differ from the model by %.2g times the expected variance, before the blow "
                          "by %.2g: "
                        : "crank: again and again readings differed from the model by more than the expected variance "
                          "explains (now by %.2g times, before the blow by %.2g): ";
  return format(how, all, strike);
}

/// What contradicts the model, by where in the turn it does. strike: before the blow as well.
std::string contradictionOf(const Pipeline& pipeline, bool strike) {
  const CrankFilter& filter = *pipeline.crank().tracker().filter();
  const std::string how_much = howMuchTheyDiffer(filter, pipeline.crankTrust().isLost());
  if (!strike)
    return how_much +
           "before the blow they agree, what follows it is not in the model, as where a shaft gives (shaft: flexible) "
           "or the hull's retainer is struck; the deviations there are too small";
  if (const std::optional<double> behind = pipeline.crankTrust().zeroFarOff())
    return how_much + zeroFarOff(pipeline.settings().crank_sensor, *behind);
  const std::string rod =
      filter.rodEvidence().gives()
          ? format("just after it they differ by %.2g times, as where rod, pins and bearings give: ",
                   filter.rodEvidence().pickedUp())
          : "";
  return how_much + rod +
         format(
             "the crank is slowest where it must be, so crank_zero_rad is right to some %.1g rad; within that it, "
             "masses and lengths of the hammer file, or a coupling between crank and encoder (%s), do not fit",
             CrankTrust::kSlowestKnown, pipeline.settings().coupling ? "coupling_motor_share" : "shaft: flexible");
}

/// For readings that contradict the model before the blow.
bool mostIsWithheld(const SampleCounts& counts) { return counts.refusedFor(Refusal::kInconsistent) > counts.accepted; }

/// It was withheld, and is no longer.
std::string agreesAgain(const CrankFilter& filter, std::uint64_t withheld) {
  return format(
      "crank: %s samples withheld while readings contradicted the model before the blow; now they differ from it by "
      "%.2g times the expected variance, before the blow by %.2g",
      count(withheld).c_str(), filter.consistency(), filter.strikeConsistency());
}

/// Of readings and model. gives: the rod does, and that explains them.
void warnOfMismatch(const Pipeline& pipeline, const CrankFilter& filter, bool gives, std::vector<Warning>& warnings) {
  const std::uint64_t withheld = pipeline.counts().refusedFor(Refusal::kInconsistent);
  const bool strike = filter.strikeConsistency() > CrankTrust::kInconsistent;
  const bool now = filter.consistency() > CrankTrust::kInconsistent || strike || filter.isUnexplained() ||
                   pipeline.crankTrust().isInconsistent() || mostIsWithheld(pipeline.counts());
  const bool far_off = withheld > 0 && pipeline.crankTrust().zeroFarOff();  // no rod makes that
  if (far_off || (now && !gives))
    return warnings.push_back({"inconsistent", contradictionOf(pipeline, strike || withheld > 0), true});
  if (gives) {
    warnings.push_back({withheld > 0 ? "inconsistent" : "rod", rodOf(filter), true});
  } else if (withheld > 0) {
    warnings.push_back({"inconsistent", agreesAgain(filter, withheld), false});
  }
  warnOfConstants(filter.constantErrors(), pipeline.settings().crank_sensor, gives, warnings);
}

/// What the filter's innovations look like.
void warnOfSensor(const Pipeline& pipeline, std::vector<Warning>& warnings) {
  constexpr std::uint64_t kLearned = 10;  // blows: before them the filter is still learning
  // Guard: WarningNumbers.NothingIsSaidOfASensorBeforeTenBlows of kLearned
  const CrankFilter* filter = pipeline.crank().tracker().filter();
  const std::uint64_t withheld = pipeline.counts().refusedFor(Refusal::kInconsistent);
  if (filter == nullptr || pipeline.crankTrust().turnsBackward() || isOtherUnit(pipeline, pipeline.counts())) return;
  if (pipeline.counts().blows < kLearned && withheld == 0) return;
  // A rod alone hardly makes most of a recording contradict the model before the blow.
  const bool gives = filter->rodEvidence().gives() && !mostIsWithheld(pipeline.counts());
  if (filter->isLost())
    warnings.push_back({"lost",
                        std::string("crank: the estimate restarts again and again; readings and ") +
                            (gives ? "a rigid rod" : "hammer file") + " contradict each other",
                        true});
  if (filter->encoder().contradictsGiven())
    warnings.push_back(
        {"count",
         format("crank_angle_resolution_rad: %.9g rad is given, the readings have %.9g rad; 0 reads it off",
                pipeline.settings().crank_angle_resolution, filter->encoder().resolution()),
         true});
  warnOfStamps(pipeline.crank(), *filter, kTwoPi * pipeline.settings().turn_rate, warnings);
  warnOfReadings(pipeline.crank(), *filter, warnings);
  warnOfMismatch(pipeline, *filter, gives, warnings);
}

/// Of a unit that is not where or what it is said to be. weight: of the hull by the joint angles.
std::string faultOf(const ImuTrust& trust, const Gravity& weight) {
  constexpr double kAlike = 1.2;  // factor between weights: what blows add to a mean of 2 s is less
  // Guard: WarningNumbers.AWeightWithinAFifthOfOneIsInG of kAlike
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

void warnOfHull(const Pipeline& pipeline, const SampleCounts& counts, std::vector<Warning>& warnings) {
  if (counts.accepted == 0) return;
  const HullState& hull = pipeline.hull();
  const std::vector<std::string> unheard = hull.pitch().unheard();
  if (!unheard.empty())
    warnings.push_back(
        {"pitch joints", "no angle of " + joined(unheard) + " (pitch_joints): weight by hull_pitch_rad", true, true});
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

}  // namespace

bool isContradiction(std::string_view key) noexcept {
  constexpr std::string_view kKeys[] = {"degrees", "speed unit", "backward", "inconsistent", "lost"};
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
