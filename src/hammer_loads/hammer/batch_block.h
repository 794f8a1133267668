/// Many states, block by block, in operations that a compiler turns into those of whatever vectors the CPU has: what
/// batch.cpp compiles once for each.
#pragma once

#include <array>
#include <cmath>
#include <cstring>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/hammer/linkage_batch.h"

/// The next loop's arrays do not overlap (batch.h).
#if defined(__clang__)
#define HAMMER_LOADS_NO_ALIAS _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define HAMMER_LOADS_NO_ALIAS _Pragma("GCC ivdep")
#else
#define HAMMER_LOADS_NO_ALIAS
#endif

namespace hammer_loads::detail {

/// States per pass; a multiple of every vector's length, so that all of them go through the same instructions.
inline constexpr std::size_t kBlock = 64;

enum Input { kAngle, kSpeed, kAcceleration, kInputs };
enum Output {
  kForceX,
  kForceZ,
  kTorqueY,
  kWrenchOutputs,
  kR01X = kWrenchOutputs,
  kR01Z,
  kR12X,
  kR12Z,
  kR23X,
  kR23Z,
  kR03X,
  kR03Z,
  kDriveTorque,
  kAllOutputs
};

/// Like CrankAngle::wrapToPi, in operations that every instruction set has: 2 pi in three parts, of which the first two
/// have 26 and 27 bits, so that their products with the number of turns are exact with and without fma.
HAMMER_LOADS_INLINE double offsetFromBlow(double phi) noexcept {
  constexpr double kInvTwoPi = 0.15915494309189533577;
  constexpr double kRound = 6755399441055744.0;  // 1.5 2^52: adding it rounds to a whole number
  constexpr double kHigh = 0x1.921fb5p+2, kMiddle = 0x1.110b46p-24, kLow = 0x1.1a62633145c07p-52;
  const double turns = (phi * kInvTwoPi + kRound) - kRound;
  return ((phi - turns * kHigh) - turns * kMiddle) - turns * kLow;
}

/// motion() without branches; c is negative before the blow, where r + lambda2 c and lambda0 r + lambda3 c are then
/// differences. They cost relative accuracy in proportion to (rho + 1)/(rho - 1), rho^2 = lambda0 lambda2/lambda3:
/// 6 for MO-100, some 60 for a pivot distance of 1.05 crank lengths; motion() has no such loss.
HAMMER_LOADS_INLINE Motion motionOfEitherSide(const CrankRocker::Ratios& k, double s, double c, double r) noexcept {
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
  m.sin_half = s;
  m.cos_half = c;
  m.r = r;
  m.inv_r = inv_r;
  m.sin_psi = s * m.sin_psi_over_s;
  m.du = s * m.du_over_s;
  return m;
}

HAMMER_LOADS_INLINE HullWrench pulseWrench(const Mechanism& mechanism, const NominalPulse& pulse, double offset,
                                           const CrankMotion& crank, Gravity gravity) noexcept {
  const double left = offset < 0.0 ? -offset : kTwoPi - offset;
  const bool within = left < pulse.length;
  const SineCosine half = sineCosinePolynomial(within ? 0.5 * pulse.frequency * left : 0.0);
  const double sine = 2.0 * half.sine * half.cosine;
  const double weight = mechanism.parameters().rocker_mass * gravity.z;
  return {0.0, pulse.amplitude * crank.speed * crank.speed * sine + weight, 0.0};
}

/// Copies, so that results written in the loop cannot alias them and reading them cannot fail.
struct Job {
  explicit Job(const HullModel& model, Gravity g)
      : mechanism(model.mechanism()), linkage(mechanism, g), pulse(model.nominalPulse()), gravity(g) {}
  Mechanism mechanism;
  LinkageConstants linkage;
  NominalPulse pulse;
  Gravity gravity;
};

using Columns = std::array<const double*, kInputs>;
using Results = std::array<double*, kAllOutputs>;

using Block = std::array<double, kBlock>;

/// Input, intermediate and output of one block, where nothing else can alias them.
struct Workspace {
  alignas(64) std::array<Block, kInputs> in{};     ///< of a block that is filled up
  alignas(64) std::array<Block, kAllOutputs> out;  ///< as above
  alignas(64) Block sine, cosine;                  ///< of half the crank angle; the cosine is negative before the blow
  alignas(64) Block r, cos_psi, sin_psi_over_s, u, du_over_s, inv_r;
};

HAMMER_LOADS_INLINE Motion motionOf(const Workspace& work, std::size_t i) noexcept {
  Motion m;
  m.sin_half = work.sine[i] < kLeastSine ? kNoSine : work.sine[i];
  m.cos_half = work.cosine[i];
  m.inv_r = work.inv_r[i];
  m.r = work.r[i];
  m.sin_psi_over_s = work.sin_psi_over_s[i];
  m.sin_psi = m.sin_half * m.sin_psi_over_s;
  m.cos_psi = work.cos_psi[i];
  m.u = work.u[i];
  m.du_over_s = work.du_over_s[i];
  m.du = m.sin_half * m.du_over_s;
  return m;
}

HAMMER_LOADS_INLINE void computeMotions(const CrankRocker::Ratios& k, const double* angles, Workspace& work) noexcept {
  HAMMER_LOADS_NO_ALIAS
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double offset = offsetFromBlow(angles[i]);
    const SineCosine half = sineCosinePolynomial(0.5 * std::abs(offset));
    work.sine[i] = half.sine;
    work.cosine[i] = std::copysign(half.cosine, offset + 0.0);  // the blow itself, 0 or -0, counts as after it
    work.r[i] = std::sqrt(k.g + half.cosine * half.cosine);
  }
  for (std::size_t i = 0; i < kBlock; ++i) {
    const Motion m = motionOfEitherSide(k, work.sine[i], work.cosine[i], work.r[i]);
    work.inv_r[i] = m.inv_r;
    work.sin_psi_over_s[i] = m.sin_psi_over_s;
    work.cos_psi[i] = m.cos_psi;
    work.u[i] = m.u;
    work.du_over_s[i] = m.du_over_s;
  }
}

/// One block of states, in several short loops: a CPU then has many states in flight instead of one long chain.
template <Level level, bool with_pins>
HAMMER_LOADS_INLINE void computeBlock(const Job& job, const Columns& in, const Results& out, Workspace& work) noexcept {
  const CrankRocker::Ratios& ratios = job.mechanism.linkage().ratios();
  const NearBlow near_blow(0.0);
  const double* angles = in[kAngle];
  const double* speeds = in[kSpeed];
  const double* accelerations = in[kAcceleration];
  double* x = out[kForceX];
  double* z = out[kForceZ];
  double* torque = out[kTorqueY];
  double* r01x = out[kR01X];
  double* r01z = out[kR01Z];
  double* r12x = out[kR12X];
  double* r12z = out[kR12Z];
  double* r23x = out[kR23X];
  double* r23z = out[kR23Z];
  double* r03x = out[kR03X];
  double* r03z = out[kR03Z];
  double* drive = out[kDriveTorque];
  if constexpr (level != Level::kPulse) computeMotions(ratios, angles, work);
  HAMMER_LOADS_NO_ALIAS
  for (std::size_t i = 0; i < kBlock; ++i) {
    const CrankMotion crank{{}, speeds[i], accelerations[i]};
    LinkLoads loads;
    if constexpr (level == Level::kPulse) {
      loads.wrench = pulseWrench(job.mechanism, job.pulse, offsetFromBlow(angles[i]), crank, job.gravity);
    } else {
      const Motion m = motionOf(work, i);
      [[maybe_unused]] const LinkMotion l = linkMotion(ratios, m);
      if constexpr (level == Level::kLinkage && with_pins) {
        loads = linkageLoads(job.linkage, l, crank.speed, crank.acceleration);
      } else if constexpr (level == Level::kLinkage) {
        loads.wrench = hullWrenchLinkage(job.mechanism, l, crank, job.gravity);
      } else {
        loads.wrench = hullWrenchRocker(job.mechanism, m, crank, job.gravity);
        if constexpr (with_pins) loads.pins = pinForcesRocker(job.mechanism, l, crank, job.gravity, near_blow);
      }
      if constexpr (with_pins) {
        r01x[i] = loads.pins.hull_on_crank.x, r01z[i] = loads.pins.hull_on_crank.z;
        r12x[i] = loads.pins.crank_on_rod.x, r12z[i] = loads.pins.crank_on_rod.z;
        r23x[i] = loads.pins.rod_on_rocker.x, r23z[i] = loads.pins.rod_on_rocker.z;
        r03x[i] = loads.pins.hull_on_rocker.x, r03z[i] = loads.pins.hull_on_rocker.z;
        drive[i] = loads.pins.drive_torque;
      }
    }
    x[i] = loads.wrench.force_x, z[i] = loads.wrench.force_z;
    torque[i] = loads.wrench.torque_y;
  }
}

/// Whole blocks in place; the rest in a block filled up with zeros, so that it goes through the same instructions.
template <Level level, bool with_pins>
HAMMER_LOADS_INLINE void computeAll(const HullModel& model, Gravity gravity, const Columns& in, std::size_t count,
                                    const Results& out) noexcept {
  constexpr std::size_t kOutputs = with_pins ? kAllOutputs : kWrenchOutputs;
  const Job job(model, gravity);
  Workspace work;
  Columns block_in = in;
  Results block_out = out;
  std::size_t done = 0;
  for (; done + kBlock <= count; done += kBlock) {
    computeBlock<level, with_pins>(job, block_in, block_out, work);
    for (std::size_t c = 0; c < kInputs; ++c) block_in[c] += kBlock;
    for (std::size_t c = 0; c < kOutputs; ++c) block_out[c] += kBlock;
  }
  const std::size_t rest = count - done;
  if (rest == 0) return;
  for (std::size_t c = 0; c < kInputs; ++c) {
    std::memcpy(work.in[c].data(), block_in[c], rest * sizeof(double));
    block_in[c] = work.in[c].data();
  }
  for (std::size_t c = 0; c < kOutputs; ++c) block_out[c] = work.out[c].data();
  computeBlock<level, with_pins>(job, block_in, block_out, work);
  for (std::size_t c = 0; c < kOutputs; ++c) std::memcpy(out[c] + done, work.out[c].data(), rest * sizeof(double));
}

/// By level; level pulse has no pins of its own.
template <bool with_pins>
HAMMER_LOADS_INLINE void compute(const HullModel& model, Gravity gravity, const Columns& in, std::size_t count,
                                 const Results& out) noexcept {
  if (model.level() == Level::kLinkage) {
    computeAll<Level::kLinkage, with_pins>(model, gravity, in, count, out);
  } else if (with_pins || model.level() == Level::kRocker) {
    computeAll<Level::kRocker, with_pins>(model, gravity, in, count, out);
  } else {
    computeAll<Level::kPulse, false>(model, gravity, in, count, out);
  }
}

}  // namespace hammer_loads::detail
