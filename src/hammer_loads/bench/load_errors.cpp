#include "hammer_loads/bench/load_errors.h"

#include <algorithm>
#include <limits>

namespace hammer_loads::accuracy {
namespace {

constexpr std::size_t kPeakAngles = 48;
constexpr double kNoNumber = std::numeric_limits<double>::infinity();

double sizeOf(const Vector& v) { return static_cast<double>(sqrt(dot(v, v))); }
double sizeOf(const Real& v) { return static_cast<double>(abs(v)); }

double missOf(const PinForce& f, const Vector& exact) { return sizeOf(Vector{Real(f.x), Real(f.z)} - exact); }
double missOf(double value, const Real& exact) { return sizeOf(Real(value) - exact); }

/// One load: how to read it from the computed and from the exact loads.
template <typename Computed, typename Exact>
Error errorOfOne(const std::vector<LinkLoads>& computed, const ExactCase& exact_case, const Computed& value,
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

}  // namespace

ExactCase::ExactCase(const HardCase& hard_case, Level level) {
  const NewtonEuler exact(hard_case.hammer, level);
  const auto at = [&](double angle) {
    return exact.at(Real(angle), Real(hard_case.speed), Real(hard_case.acceleration), hard_case.gravity);
  };
  for (const double angle : hard_case.angles) states.push_back(at(angle));
  for (const double angle : turnAngles(kPeakAngles)) turn.push_back(at(angle));
}

Error errorOf(const std::vector<LinkLoads>& computed, const ExactCase& exact, Parts parts) {
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

}  // namespace hammer_loads::accuracy
