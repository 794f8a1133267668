/// Ways to compute loads from crank states, the states of the comparison, and the errors against the reference.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "hammer_loads/hammer/batch.h"
#include "support/mo100.h"
#include "support/newton_euler.h"
#include "support/printed_formulas.h"

namespace hammer_loads::test {

/// Angles of one machine under one speed, acceleration and gravity.
struct HardCase {
  std::string name;
  HammerParameters hammer;     ///< as given, without correction of the rod
  double speed{};              ///< [rad/s]
  double acceleration{};       ///< [rad/s2]
  Gravity gravity;             ///< [m/s2]
  std::vector<double> angles;  ///< in (0, 2 pi) [rad]; the stored numbers are exact
};

inline const Gravity kCaseGravity{kStandardGravity * std::sin(0.3), kStandardGravity * -std::cos(0.3)};

/// Returns angles at offsets of each digit times 1e-first to 1e-last; side: +1 after, -1 before the blow.
inline std::vector<double> besideTheBlow(double side, int first, int last, std::initializer_list<double> digits) {
  std::vector<double> angles;
  for (int decade = first; decade <= last; ++decade) {
    for (const double digit : digits) {
      const double offset = digit * std::pow(10.0, -decade);
      angles.push_back(side > 0.0 ? offset : kTwoPi - offset);
    }
  }
  return angles;
}

inline HammerParameters scaled(HammerParameters p, double k) {
  for (double* length :
       {&p.lengths.crank, &p.lengths.rod, &p.lengths.rocker, &p.lengths.pivot_distance, &p.rocker_com_distance,
        &p.striking_distance, &p.crank_com_along, &p.crank_com_across, &p.rod_com_along, &p.rod_com_across}) {
    *length *= k;
  }
  for (double* inertia :
       {&p.rocker_inertia_about_pivot, &p.crank_inertia_about_com, &p.rod_inertia_about_com, &p.drive_inertia}) {
    *inertia *= k * k;
  }
  return p;
}

/// Rounds the lengths to single precision. They then miss the change-point condition by some 1e-8 of the crank.
inline HammerParameters rounded(HammerParameters p) {
  for (double* length : {&p.lengths.crank, &p.lengths.rod, &p.lengths.rocker, &p.lengths.pivot_distance})
    *length = static_cast<double>(static_cast<float>(*length));
  return p;
}

/// Returns evenly spaced angles of a whole revolution, none at the blow.
inline std::vector<double> turnAngles(std::size_t count) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i)
    angles.push_back(kTwoPi * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return angles;
}

/// Returns a regular revolution, four cases at 1, 2.7 and 6.1 times 1e-1 to 1e-12 rad before and after the blow, and
/// others with coarser angles of both kinds. The usual values are P0's 31.416 rad/s and a hull pitch of 0.3 rad.
inline std::vector<HardCase> hardCases(const HammerParameters& hammer) {
  const auto beside = [&](const char* name, double side, int first, int last) {
    return HardCase{name, hammer, kPaperSpeed, 0.0, kCaseGravity, besideTheBlow(side, first, last, {1.0, 2.7, 6.1})};
  };
  std::vector<double> everywhere = turnAngles(48);
  for (const double side : {-1.0, 1.0}) {
    const std::vector<double> near_blow = besideTheBlow(side, 1, 12, {2.7});
    everywhere.insert(everywhere.end(), near_blow.begin(), near_blow.end());
  }
  return {{"regular turn", hammer, kPaperSpeed, 0.0, kCaseGravity, turnAngles(96)},
          beside("before the blow, to 1e-6 rad", -1.0, 1, 6),
          beside("before, to 1e-12 rad", -1.0, 7, 12),
          beside("after the blow, to 1e-6 rad", 1.0, 1, 6),
          beside("after, to 1e-12 rad", 1.0, 7, 12),
          {"lengths rounded", rounded(hammer), kPaperSpeed, 0.0, kCaseGravity, everywhere},
          {"lengths x 1e-3", scaled(hammer, 1e-3), kPaperSpeed, 0.0, kCaseGravity, everywhere},
          {"lengths x 1e3", scaled(hammer, 1e3), kPaperSpeed, 0.0, kCaseGravity, everywhere},
          {"speed 0", hammer, 0.0, 0.0, kCaseGravity, everywhere},
          {"speed 1e-6 rad/s", hammer, 1e-6, 0.0, {}, everywhere},
          {"speed 1e3 rad/s", hammer, 1e3, 0.0, kCaseGravity, everywhere},
          {"acceleration 1e5 rad/s2", hammer, kPaperSpeed, 1e5, kCaseGravity, everywhere}};
}

/// Largest error over states and loads; infinite where a load is no number.
struct Error {
  double of_peak{};   ///< over the load's largest size in the whole revolution and in the case's own states
  double relative{};  ///< over the load's own size (forces as vectors); over the peak for moments, which cross zero
};

/// Loads that a way computes.
enum class Parts {
  kWrench,   ///< hull wrench
  kPins,     ///< hull wrench, four pin forces, drive torque
  kPrinted,  ///< hull wrench, four pin forces
};

/// Loads of a case at a level by the reference.
struct ExactCase {
  ExactCase(const HardCase& hard_case, Level level) {
    const NewtonEuler exact(hard_case.hammer, level);
    const auto at = [&](double angle) {
      return exact.at(Real(angle), Real(hard_case.speed), Real(hard_case.acceleration), hard_case.gravity);
    };
    for (const double angle : hard_case.angles) states.push_back(at(angle));
    for (const double angle : turnAngles(48)) turn.push_back(at(angle));
  }
  std::vector<Reference> states;  ///< one per angle
  std::vector<Reference> turn;    ///< evenly spaced, for the peaks
};

inline constexpr double kNoNumber = std::numeric_limits<double>::infinity();

inline double sizeOf(const Vector& v) { return static_cast<double>(sqrt(dot(v, v))); }
inline double sizeOf(const Real& v) { return static_cast<double>(abs(v)); }

inline double missOf(const PinForce& f, const Vector& exact) { return sizeOf(Vector{Real(f.x), Real(f.z)} - exact); }
inline double missOf(double value, const Real& exact) { return sizeOf(Real(value) - exact); }

/// Returns the error of one load, which `value` reads from the computed loads and `exact` from the exact ones.
template <typename Computed, typename Exact>
inline Error errorOfOne(const std::vector<LinkLoads>& computed, const ExactCase& exact_case, const Computed& value,
                        const Exact& exact, bool own_size) {
  double peak = 0.0, miss = 0.0;
  Error worst;
  for (const auto* states : {&exact_case.states, &exact_case.turn}) {
    for (const Reference& state : *states) peak = std::max(peak, sizeOf(exact(state)));
  }
  for (std::size_t i = 0; i < computed.size(); ++i) {
    const double error = missOf(value(computed[i]), exact(exact_case.states[i]));
    if (!(error < std::numeric_limits<double>::max())) return {kNoNumber, kNoNumber};
    miss = std::max(miss, error);
    if (own_size && error > 0.0) worst.relative = std::max(worst.relative, error / sizeOf(exact(exact_case.states[i])));
  }
  worst.of_peak = miss > 0.0 ? miss / peak : 0.0;
  if (!own_size) worst.relative = worst.of_peak;
  return worst;
}

inline Error errorOf(const std::vector<LinkLoads>& computed, const ExactCase& exact, Parts parts) {
  Error worst;
  const auto add = [&](const auto& value, const auto& right, bool own_size) {
    const Error e = errorOfOne(computed, exact, value, right, own_size);
    worst.of_peak = std::max(worst.of_peak, e.of_peak);
    worst.relative = std::max(worst.relative, e.relative);
  };
  add(
      [](const LinkLoads& l) {
        return PinForce{l.wrench.force_x, l.wrench.force_z};
      },
      [](const Reference& r) { return r.hull_force; }, true);
  add([](const LinkLoads& l) { return l.wrench.torque_y; }, [](const Reference& r) { return r.hull_torque; }, false);
  if (parts == Parts::kWrench) return worst;
  const auto add_pin = [&](PinForce PinReactions::*pin, Vector Reference::*right) {
    add([pin](const LinkLoads& l) { return l.pins.*pin; }, [right](const Reference& r) { return r.*right; }, true);
  };
  add_pin(&PinReactions::hull_on_crank, &Reference::r01);
  add_pin(&PinReactions::crank_on_rod, &Reference::r12);
  add_pin(&PinReactions::rod_on_rocker, &Reference::r23);
  add_pin(&PinReactions::hull_on_rocker, &Reference::r03);
  if (parts == Parts::kPins)
    add([](const LinkLoads& l) { return l.pins.drive_torque; }, [](const Reference& r) { return r.drive_torque; },
        false);
  return worst;
}

inline const NearBlow kNearBlow(0.01);

struct LoadWay {
  std::string name;
  Level level{};
  Parts parts{};
  std::function<std::vector<LinkLoads>(const HardCase&)> loads;  ///< returns the loads of all states of a case
};

inline LoadWay printed(const char* name, Positions positions) {
  return {name, Level::kRocker, Parts::kPrinted, [positions](const HardCase& c) {
            const PrintedFormulas formulas(c.hammer, positions);
            std::vector<LinkLoads> loads;
            for (const double angle : c.angles) loads.push_back(formulas(angle, c.speed, c.acceleration, c.gravity));
            return loads;
          }};
}

inline LoadWay scalar(const char* name, Level level, Parts parts) {
  return {name, level, parts, [=](const HardCase& c) {
            const Mechanism mechanism = mechanismOf(c.hammer);
            const HullModel model(mechanism, level);
            std::vector<LinkLoads> loads;
            for (const double angle : c.angles) {
              const CrankMotion crank{CrankAngle::fromAngle(angle), c.speed, c.acceleration};
              loads.push_back({hullWrench(model, crank, c.gravity), {}});
              if (parts == Parts::kPins) loads.back().pins = pinForces(mechanism, level, crank, c.gravity, kNearBlow);
            }
            return loads;
          }};
}

inline LoadWay batch(const char* name, Level level, Parts parts) {
  return {name, level, parts, [=](const HardCase& c) {
            const std::size_t count = c.angles.size();
            const std::vector<double> speeds(count, c.speed), accelerations(count, c.acceleration);
            std::array<std::vector<double>, 12> o;
            for (std::vector<double>& column : o) column.resize(count);
            const auto at = [&o](std::size_t column) { return o[column].data(); };
            const CrankStates states{c.angles.data(), speeds.data(), accelerations.data(), count};
            const WrenchArrays wrenches{at(0), at(1), at(2)};
            const Mechanism mechanism = mechanismOf(c.hammer);
            const HullModel model(mechanism, level);
            if (parts == Parts::kPins)
              linkLoads(model, states, c.gravity, wrenches,
                        {at(3), at(4), at(5), at(6), at(7), at(8), at(9), at(10), at(11)});
            else
              hullWrenches(model, states, c.gravity, wrenches);
            std::vector<LinkLoads> loads;
            for (std::size_t i = 0; i < count; ++i)
              loads.push_back(
                  {{o[0][i], o[1][i], o[2][i]},
                   {{o[3][i], o[4][i]}, {o[5][i], o[6][i]}, {o[7][i], o[8][i]}, {o[9][i], o[10][i]}, o[11][i], false}});
            return loads;
          }};
}

inline std::vector<LoadWay> loadWays() {
  std::vector<LoadWay> ways{printed("P0 with inverse trigonometry", Positions::kInverseTrigonometry),
                            printed("P0 with sines and cosines", Positions::kTrigonometry)};
  for (const Level level : {Level::kRocker, Level::kLinkage}) {
    ways.push_back(scalar("scalar wrench", level, Parts::kWrench));
    ways.push_back(scalar("scalar pins", level, Parts::kPins));
    ways.push_back(batch("batch of wrenches", level, Parts::kWrench));
    ways.push_back(batch("batch of pins", level, Parts::kPins));
  }
  return ways;
}

}  // namespace hammer_loads::test
