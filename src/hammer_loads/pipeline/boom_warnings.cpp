#include "hammer_loads/pipeline/boom_warnings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/pipeline/boom_health.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Delay of stamps from which on a warning is given; it may be mistaken for softer oil [s].
constexpr double kLateStamp = 8e-4;
// Warning: kLateStamp

/// Returns the apparent delay of pressures due to damping that is not the oil's [s]. It follows from the damping beyond
/// the boom file's. If the damping is implausible, all of it counts, plus a multiple of the delay's standard deviation.
double lagOfDamping(const Boom& boom, int odd) {
  const double oil = odd < 0 ? boom.parameters().vibration.damping_ratio : 0.0;
  double lag = 0.0;
  for (int k = 0; k < boom.vibration().modes().count; ++k) {
    const Mode mode = boom.vibration().mode(k);
    lag = std::max(lag, 2.0 * (mode.zeta - oil) / mode.omega);
  }
  const ModeIdentifier& identifier = *boom.vibration().identifier();
  return odd < 0 ? lag : lag + gate::kUsual * identifier.delayDeviation(Clock::kPressures);
}

/// Returns true if the boom's modes show a delayed sensor clock. explained: apparent delay due to other causes [s].
bool isOff(const ModeIdentifier& identifier, Clock clock, double explained = 0.0) {
  constexpr double kKnown = 1e-4, kPart = 0.65;  // [s]; of the delay
  // Warning: kKnown, kPart
  const double delay = identifier.delay(clock);
  return std::abs(delay) > kLateStamp && !(delay > 0.0 && delay < explained) &&
         identifier.delayDeviation(clock) < kKnown + kPart * std::abs(delay);
}

std::string laterOrEarlier(double delay) {
  return format("%.2g ms %s", 1e3 * std::abs(delay), delay > 0.0 ? "later" : "earlier");
}

void warnOfDamping(const Boom& boom, int mode, std::vector<Warning>& warnings) {
  const Mode found = boom.vibration().mode(mode);
  warnings.push_back(
      {"boom damping",
       format("boom: vibration of %.2g Hz has a damping ratio of %.2g, the boom file %.2g. Check friction "
              "of its joints and damping_ratio.",
              found.omega / kTwoPi, found.zeta, boom.parameters().vibration.damping_ratio),
       true});
}

void warnOfImuClock(const ModeIdentifier& identifier, std::vector<Warning>& warnings) {
  if (!isOff(identifier, Clock::kImu)) return;
  warnings.push_back({"imu stamps",
                      "hull_imu: stamps are about " + laterOrEarlier(identifier.delay(Clock::kImu)) +
                          " than the crank's. The wrench does not correct that; stamp at the instant of measurement.",
                      true});
}

/// Warns of late pressures or of a poor fit. explained: apparent delay due to the boom's damping [s].
void warnOfPressures(const ModeIdentifier& identifier, double explained, std::vector<Warning>& warnings) {
  const double ratio = identifier.oilInnovationRatio();
  if (isOff(identifier, Clock::kPressures, explained)) {
    warnings.push_back({"pressure stamps",
                        "cylinder_pressures: stamps are about " + laterOrEarlier(identifier.delay(Clock::kPressures)) +
                            " than the crank's. The boom's loads correct up to 2 ms; correct the stamps.",
                        true});
  } else if (ratio > MeasuredTorques::kContradicted) {
    warnings.push_back({"pressure fit",
                        format("cylinder_pressures: errors are %.2g times the expected variance, deviations are "
                               "inflated. %s.",
                               ratio,
                               identifier.isLagKnown() ? "Check boom file and robot description"
                                                       : "Their delay is not known: add hull_imu"),
                        true});
  }
}

/// Warns of the cylinder whose oil differs most from the others', if by more than the boom file expects. odd: mode
/// whose damping is not that of oil, or -1.
void warnOfOil(const Boom& boom, int odd, std::vector<Warning>& warnings) {
  const CylinderParameters* unlike = nullptr;
  Vibration::OilAgainstOthers found;
  for (std::size_t i = 0; i < boom.cylinders().size(); ++i) {
    const auto one = boom.vibration().oilAgainstOthers(i);
    if (!one || !exceeds(one->stiffer, square(one->expected) + square(one->deviation), gate::kRare)) continue;
    if (unlike != nullptr && std::abs(one->stiffer) <= std::abs(found.stiffer)) continue;
    unlike = &boom.cylinders()[i].parameters(), found = *one;
  }
  if (unlike == nullptr || !boom.vibration().identifier()->explains()) return;
  for (const Clock clock : {Clock::kImu, Clock::kPressures})
    if (odd < 0 && std::abs(boom.vibration().identifier()->delay(clock)) > kLateStamp) return;
  const char* name = unlike->name.c_str();
  const double times = std::exp(std::abs(found.stiffer));
  const bool soft = found.stiffer < 0.0;
  const char* check = odd >= 0 ? "The damping is not that of oil: check friction of its joint"
                      : soft   ? "Check air in its oil, hoses and pins"
                               : "Check its bore and hose volumes";
  std::string text = format("%s: oil is %.2g +- %.1g times %s than in the other cylinders; the loads use that. %s.",
                            name, times, times * found.deviation, soft ? "softer" : "stiffer", check);
  warnings.push_back({"cylinder stiffness", std::move(text), true});
}

/// Warns of pressures that are not used.
void warnOfTrust(const PressureTrust& trust, double greatest, std::vector<Warning>& warnings) {
  constexpr double kOfNoCylinder = 1e4;  // [Pa]: a tenth of the atmospheric pressure
  // Warning: kOfNoCylinder
  if (trust.isLate()) {
    warnings.push_back({"pressure stamps",
                        "cylinder_pressures: not used, stamps are about " + laterOrEarlier(trust.lateBy()) +
                            " than the crank's. Correct the stamps.",
                        true});
  } else if (trust.isLost() && greatest < kOfNoCylinder) {
    warnings.push_back(
        {"pressures",
         format(
             "cylinder_pressures: not used, the greatest is %.3g, which holds no boom. Publish gauge pressure in Pa.",
             greatest),
         true});
  } else if (trust.isLost()) {
    warnings.push_back({"pressures",
                        format("cylinder_pressures: not used, beside the weight they show %.0f N across and %.0f N "
                               "along the tool. Check units and chambers.",
                               trust.across(), trust.along()),
                        true});
  }
}

/// Returns why loads are useless, and what to do.
const char* causeOf(const BoomFollower& follower, const BoomState& boom) {
  if (boom.contact_unknown) return "rock contact that is not measured. Add cylinder_pressures";
  const std::optional<ModeIdentifier>& identifier = follower.boom().vibration().identifier();
  return identifier && identifier->isLagKnown() ? "pressures that do not fit. Check boom file, stamps and hoses"
                                                : "pressures whose delay is not known. Add hull_imu";
}

void warnOfVibration(const BoomFollower& follower, const BoomState* boom, bool imu_lost,
                     std::vector<Warning>& warnings) {
  const Vibration& vibration = follower.boom().vibration();
  if (vibration.identifies() && vibration.identifier()->channels() == 0 && !imu_lost)
    warnings.push_back(
        {"boom stiffness",
         "boom_stiffness: identified, but no hull_imu, fast joint_states or cylinder_pressures came. The "
         "boom file is used; connect one.",
         true});
  const int odd = modeOfOddDamping(follower.boom());
  warnOfOil(follower.boom(), odd, warnings);
  if (!vibration.identifier()) return;
  const ModeIdentifier& identifier = *vibration.identifier();
  if (odd < 0) warnOfImuClock(identifier, warnings);
  if (boom != nullptr && boom->measured) warnOfPressures(identifier, lagOfDamping(follower.boom(), odd), warnings);
  if (odd >= 0) warnOfDamping(follower.boom(), odd, warnings);
}

}  // namespace

void warnOfBoom(const BoomFollower& follower, const BoomState* boom, bool imu_lost, std::vector<Warning>& warnings) {
  warnOfVibration(follower, boom, imu_lost, warnings);
  warnOfTrust(follower.pressureTrust(), follower.pressures().greatest(), warnings);
  if (boom != nullptr && boom->contact_unknown)
    warnings.push_back(
        {"rock",
         format(
             "hull_imu: unexplained force of %.2g N on the hull, probably rock contact. Deviations are inflated; add "
             "cylinder_pressures.",
             follower.unexplainedForce()),
         true});
  if (boom != nullptr && boom->useless && follower.isUnproven() && !boom->contact_unknown)
    warnings.push_back({"boom loads",
                        "joint_loads: withheld for the first second of work, as hull_imu has yet to show that no rock "
                        "bears the hull.",
                        true});
  else if (boom != nullptr && boom->useless)
    warnings.push_back({"boom loads",
                        format("joint_loads: withheld, deviations are %.2g times the loads by %s.",
                               follower.torqueUncertainty(), causeOf(follower, *boom)),
                        true});
  const bool fault = boom != nullptr && boom->fault,
             runs_away = fault && boom->fault->kind == JointFault::Kind::kRunAway;
  if (follower.divergences() > 0)
    warnings.push_back({"boom vibration",
                        "boom: the vibration estimate diverged " + std::to_string(follower.divergences()) +
                            " times; its loads are withheld after that. Check boom file and hull_imu.",
                        runs_away});
  if (!fault || runs_away) return;
  warnings.push_back(
      {"boom joints",
       "boom joints: no loads for " + std::to_string(follower.faults()) + " samples: " + joined(follower.complaints()),
       true});
}

}  // namespace hammer_loads
