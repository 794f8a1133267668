/// Every way from crank states to loads, and its errors against the reference.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>

#include "hammer/hard_cases.h"
#include "hammer_loads/hammer/batch.h"
#include "support/mo100.h"
#include "support/newton_euler.h"
#include "support/printed_formulas.h"

namespace hammer_loads::test {

/// Worst over states and loads; infinite where a load is no number.
struct Error {
  double of_peak{};   ///< of the largest size that the load has in the whole turn and in the case's own states
  double relative{};  ///< of the load's own size, forces as vectors; moments, which pass through zero: of the peak
};

/// Which loads a way gives.
enum class Parts {
  kForceZ,   ///< of the hull wrench
  kWrench,   ///< hull wrench
  kPins,     ///< hull wrench, four pin forces, drive torque
  kPrinted,  ///< the same without drive torque
};

/// A case at a level, worked out by the reference.
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

/// One load: how to read it from the computed and from the exact loads.
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
  if (parts == Parts::kForceZ) {
    add([](const LinkLoads& l) { return l.wrench.force_z; }, [](const Reference& r) { return r.hull_force.y; }, false);
    return worst;
  }
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
  std::string group, name;
  Level level{};
  Parts parts{};
  std::function<std::vector<LinkLoads>(const HardCase&)> loads;  ///< of all states of a case
};

/// A way that takes one state after the other: make(hard case) gives what computes the loads of an angle of it.
template <typename Make>
LoadWay oneByOne(const char* group, const char* name, Level level, Parts parts, const Make& make) {
  return {group, name, level, parts, [make](const HardCase& hard_case) {
            const auto compute = make(hard_case);
            std::vector<LinkLoads> loads;
            for (std::size_t i = 0; i < hard_case.angles.size(); ++i) loads.push_back(compute(i));
            return loads;
          }};
}

inline LoadWay printed(const char* name, Positions positions) {
  return oneByOne("printed", name, Level::kRocker, Parts::kPrinted, [positions](const HardCase& c) {
    return [formulas = PrintedFormulas(c.hammer, positions), c](std::size_t i) {
      return formulas(c.angles[i], c.speed, c.acceleration, c.gravity);
    };
  });
}

/// Mechanism, model and states of a case as the calls want them.
struct Prepared {
  Prepared(const HardCase& c, Level level)
      : mechanism(mechanismOf(c.hammer)), model(mechanism, level), gravity(c.gravity) {
    for (const double angle : c.angles) cranks.push_back({CrankAngle::fromAngle(angle), c.speed, c.acceleration});
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
  Mechanism mechanism;
  HullModel model;
  Gravity gravity;
  std::vector<CrankMotion> cranks;
};

inline LoadWay scalarWrench(const char* name, Level level) {
  return oneByOne("scalar", name, level, level == Level::kPulse ? Parts::kForceZ : Parts::kWrench,
                  [level](const HardCase& c) {
                    return [p = std::make_shared<const Prepared>(c, level)](std::size_t i) {
                      return LinkLoads{hullWrench(p->model, p->cranks[i], p->gravity), {}};
                    };
                  });
}

inline LoadWay scalarPins(const char* name, Level level) {
  return oneByOne("scalar", name, level, Parts::kPins, [level](const HardCase& c) {
    return [p = std::make_shared<const Prepared>(c, level), level](std::size_t i) {
      return linkLoads(p->mechanism, level, p->cranks[i], p->gravity, kNearBlow);
    };
  });
}

/// Arrays of a case for the batch calls.
struct BatchCase {
  BatchCase(const HardCase& c, Level level)
      : prepared(c, level),
        angles(c.angles),
        speeds(c.angles.size(), c.speed),
        accelerations(c.angles.size(), c.acceleration) {
    for (std::vector<double>& column : out) column.resize(angles.size());
  }
  void compute(bool with_pins) {
    const CrankStates states{angles.data(), speeds.data(), accelerations.data(), angles.size()};
    const auto at = [this](std::size_t column) { return out[column].data(); };
    const WrenchArrays wrenches{at(0), at(1), at(2)};
    if (!with_pins) return hullWrenches(prepared.model, states, prepared.gravity, wrenches);
    const PinArrays pins{at(3), at(4), at(5), at(6), at(7), at(8), at(9), at(10), at(11)};
    linkLoads(prepared.model, states, prepared.gravity, wrenches, pins);
  }
  LinkLoads result(std::size_t i) const {
    const auto& o = out;
    return {{o[0][i], o[1][i], o[2][i]},
            {{o[3][i], o[4][i]}, {o[5][i], o[6][i]}, {o[7][i], o[8][i]}, {o[9][i], o[10][i]}, o[11][i], false}};
  }
  Prepared prepared;
  std::vector<double> angles, speeds, accelerations;
  std::array<std::vector<double>, 12> out;
};

inline LoadWay batch(const char* name, Level level, bool with_pins) {
  return {"batch", name, level, with_pins ? Parts::kPins : Parts::kWrench, [=](const HardCase& c) {
            BatchCase arrays(c, level);
            arrays.compute(with_pins);
            std::vector<LinkLoads> loads;
            for (std::size_t i = 0; i < c.angles.size(); ++i) loads.push_back(arrays.result(i));
            return loads;
          }};
}

inline std::vector<LoadWay> loadWays() {
  return {printed("P0 with inverse trigonometry", Positions::kInverseTrigonometry),
          printed("P0 with sines and cosines", Positions::kTrigonometry),
          scalarWrench("pulse", Level::kPulse),
          scalarWrench("rocker", Level::kRocker),
          scalarWrench("linkage", Level::kLinkage),
          scalarPins("rocker with pins", Level::kRocker),
          scalarPins("linkage with pins", Level::kLinkage),
          batch("rocker", Level::kRocker, false),
          batch("linkage", Level::kLinkage, false),
          batch("rocker with pins", Level::kRocker, true),
          batch("linkage with pins", Level::kLinkage, true)};
}

}  // namespace hammer_loads::test
