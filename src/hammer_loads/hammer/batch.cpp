#include "hammer_loads/hammer/batch.h"

#include <array>
#include <cmath>
#include <cstring>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/pin_forces.h"

// Compiled once for each of these, and chosen by the loader (before ThreadSanitizer works).
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__)
#define HAMMER_LOADS_CLONES [[gnu::target_clones("avx512f", "fma", "default")]]
#else
#define HAMMER_LOADS_CLONES
#endif

/// Instructs the compiler that the arrays of the next loop do not overlap (batch.h).
#if defined(__clang__)
#define HAMMER_LOADS_NO_ALIAS _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define HAMMER_LOADS_NO_ALIAS _Pragma("GCC ivdep")
#else
#define HAMMER_LOADS_NO_ALIAS
#endif

namespace hammer_loads {
namespace {

/// States per pass; a multiple of every vector's length, so that all of them go through the same instructions.
constexpr std::size_t kBlock = 64;
using Block = std::array<double, kBlock>;

constexpr std::size_t kInputs = 3, kWrenchOutputs = 3, kAllOutputs = 12;
using Columns = std::array<const double*, kInputs>;
using Results = std::array<double*, kAllOutputs>;

/// Like CrankAngle::wrapToPi, in operations that every instruction set has: 2 pi in three parts, of which the first two
/// have 26 and 27 bits, so that their products with the number of turns are exact with and without fma.
HAMMER_LOADS_INLINE double offsetFromBlow(double phi) noexcept {
  constexpr double kInvTwoPi = 0.15915494309189533577;
  constexpr double kRound = 6755399441055744.0;  // 1.5 2^52: adding it rounds to a whole number
  constexpr double kHigh = 0x1.921fb5p+2, kMiddle = 0x1.110b46p-24, kLow = 0x1.1a62633145c07p-52;
  const double turns = (phi * kInvTwoPi + kRound) - kRound;
  return ((phi - turns * kHigh) - turns * kMiddle) - turns * kLow;
}

/// motion() without branches; the cosine is negative before the blow, where r + lambda2 c and lambda0 r + lambda3 c are
/// then differences. They cost relative accuracy in proportion to (rho + 1)/(rho - 1), rho^2 = lambda0 lambda2/lambda3:
/// 6 for MO-100, some 60 for a pivot distance of 1.05 crank lengths; motion() has no such loss.
HAMMER_LOADS_INLINE Motion motionAt(const CrankRocker::Ratios& k, double angle) noexcept {
  const double offset = offsetFromBlow(angle);
  const SineCosine half = sineCosinePolynomial(0.5 * std::abs(offset));
  const double s = half.sine, c = std::copysign(half.cosine, offset + 0.0);  // the blow itself, 0 or -0, is after it
  const double r = std::sqrt(k.g + c * c);
  const double d = k.lambda0 * r + k.lambda3 * c;
  const double a = r + k.lambda2 * c;
  const double difference = r - c;
  const double pp = k.sigma_squared * (s * s);
  const double n = d * d + pp;  // tan(psi/2) = sigma s/d
  const double inv_nr = 1.0 / (n * r);
  const double inv_n = inv_nr * r, inv_r = inv_nr * n;
  const double factor = k.lambda3_sigma * inv_nr;
  Motion m;
  m.sin_psi_over_s = (2.0 * k.sigma * d) * inv_n;
  m.cos_psi = 1.0 - 2.0 * pp * inv_n;
  m.u = factor * a;
  m.du_over_s = (factor * difference) *
                ((k.lambda03 * inv_nr) * (a * difference) - (0.5 * k.lambda2 * (r + c)) * (inv_r * inv_r));
  m.sin_half = s < detail::kLeastSine ? detail::kNoSine : s;
  m.cos_half = c;
  m.r = r;
  m.inv_r = inv_r;
  m.sin_psi = s * m.sin_psi_over_s;
  m.du = s * m.du_over_s;
  return m;
}

HAMMER_LOADS_INLINE HullWrench pulseWrench(const Mechanism& mechanism, const NominalPulse& pulse, double offset,
                                           double speed, Gravity gravity) noexcept {
  const double left = offset < 0.0 ? -offset : kTwoPi - offset;
  const bool within = left < pulse.length;
  const SineCosine half = sineCosinePolynomial(within ? 0.5 * pulse.frequency * left : 0.0);
  const double sine = 2.0 * half.sine * half.cosine;
  const double weight = mechanism.parameters().rocker_mass * gravity.z;
  return {0.0, pulse.amplitude * speed * speed * sine + weight, 0.0};
}

template <Level level, bool with_pins>
HAMMER_LOADS_INLINE void computeBlock(const HullModel& model, Gravity gravity, const Columns& in,
                                      const Results& out) noexcept {
  // Copies: results written in the loop cannot alias them.
  const Mechanism mechanism = model.mechanism();
  const NominalPulse pulse = model.nominalPulse();
  const CrankRocker::Ratios& ratios = mechanism.linkage().ratios();
  const NearBlow near_blow(0.0);
  const auto [angles, speeds, accelerations] = in;
  const auto [x, z, torque, r01x, r01z, r12x, r12z, r23x, r23z, r03x, r03z, drive] = out;
  HAMMER_LOADS_NO_ALIAS
  for (std::size_t i = 0; i < kBlock; ++i) {
    const CrankMotion crank{{}, speeds[i], accelerations[i]};
    HullWrench wrench;
    if constexpr (level == Level::kPulse) {
      wrench = pulseWrench(mechanism, pulse, offsetFromBlow(angles[i]), crank.speed, gravity);
    } else {
      const LinkMotion links = linkMotion(ratios, motionAt(ratios, angles[i]));
      wrench = level == Level::kLinkage ? hullWrenchLinkage(mechanism, links, crank, gravity)
                                        : hullWrenchRocker(mechanism, links.rocker, crank, gravity);
      if constexpr (with_pins) {
        const PinReactions pins = level == Level::kLinkage
                                      ? pinForcesLinkage(mechanism, links, crank, gravity, near_blow)
                                      : pinForcesRocker(mechanism, links, crank, gravity, near_blow);
        r01x[i] = pins.hull_on_crank.x, r01z[i] = pins.hull_on_crank.z;
        r12x[i] = pins.crank_on_rod.x, r12z[i] = pins.crank_on_rod.z;
        r23x[i] = pins.rod_on_rocker.x, r23z[i] = pins.rod_on_rocker.z;
        r03x[i] = pins.hull_on_rocker.x, r03z[i] = pins.hull_on_rocker.z;
        drive[i] = pins.drive_torque;
      }
    }
    x[i] = wrench.force_x, z[i] = wrench.force_z, torque[i] = wrench.torque_y;
  }
}

/// Whole blocks in place; the rest in a block filled up with zeros, so that it goes through the same instructions.
template <Level level, bool with_pins>
HAMMER_LOADS_INLINE void computeAll(const HullModel& model, Gravity gravity, Columns in, std::size_t count,
                                    Results out) noexcept {
  constexpr std::size_t kOutputs = with_pins ? kAllOutputs : kWrenchOutputs;
  for (; count >= kBlock; count -= kBlock) {
    computeBlock<level, with_pins>(model, gravity, in, out);
    for (std::size_t c = 0; c < kInputs; ++c) in[c] += kBlock;
    for (std::size_t c = 0; c < kOutputs; ++c) out[c] += kBlock;
  }
  if (count == 0) return;
  alignas(64) std::array<Block, kInputs> rest_in{};
  alignas(64) std::array<Block, kOutputs> rest_out;
  for (std::size_t c = 0; c < kInputs; ++c) std::memcpy(rest_in[c].data(), in[c], count * sizeof(double));
  const Results to = out;
  for (std::size_t c = 0; c < kInputs; ++c) in[c] = rest_in[c].data();
  for (std::size_t c = 0; c < kOutputs; ++c) out[c] = rest_out[c].data();
  computeBlock<level, with_pins>(model, gravity, in, out);
  for (std::size_t c = 0; c < kOutputs; ++c) std::memcpy(to[c], rest_out[c].data(), count * sizeof(double));
}

HAMMER_LOADS_CLONES void computeWrenches(const HullModel& model, Gravity gravity, const Columns& in, std::size_t count,
                                         const Results& out) noexcept {
  if (model.level() == Level::kLinkage)
    computeAll<Level::kLinkage, false>(model, gravity, in, count, out);
  else if (model.level() == Level::kRocker)
    computeAll<Level::kRocker, false>(model, gravity, in, count, out);
  else
    computeAll<Level::kPulse, false>(model, gravity, in, count, out);
}

HAMMER_LOADS_CLONES void computeLoads(const HullModel& model, Gravity gravity, const Columns& in, std::size_t count,
                                      const Results& out) noexcept {
  if (model.level() == Level::kLinkage)
    computeAll<Level::kLinkage, true>(model, gravity, in, count, out);
  else
    computeAll<Level::kRocker, true>(model, gravity, in, count, out);
}

}  // namespace

void hullWrenches(const HullModel& model, const CrankStates& states, Gravity gravity,
                  const WrenchArrays& wrenches) noexcept {
  const Results out{wrenches.force_x, wrenches.force_z, wrenches.torque_y};
  computeWrenches(model, gravity, {states.angle, states.speed, states.acceleration}, states.count, out);
}

void linkLoads(const HullModel& model, const CrankStates& states, Gravity gravity, const WrenchArrays& wrenches,
               const PinArrays& pins) noexcept {
  const Results out{wrenches.force_x,     wrenches.force_z,      wrenches.torque_y,     pins.hull_on_crank_x,
                    pins.hull_on_crank_z, pins.crank_on_rod_x,   pins.crank_on_rod_z,   pins.rod_on_rocker_x,
                    pins.rod_on_rocker_z, pins.hull_on_rocker_x, pins.hull_on_rocker_z, pins.drive_torque};
  computeLoads(model, gravity, {states.angle, states.speed, states.acceleration}, states.count, out);
}

}  // namespace hammer_loads
