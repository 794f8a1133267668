#include "hammer_loads/hammer/batch.h"

#include <array>
#include <cstring>
#include <type_traits>

#include "hammer_loads/hammer/link_loads.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define HAMMER_LOADS_CPU_CLONES 1
#endif

namespace hammer_loads {
namespace {

/// States per pass; a multiple of every vector's length, so that all of them go through the same instructions.
constexpr std::size_t kBlock = 16;

enum Input { kAngle, kSpeed, kAcceleration, kInputs };
enum Output {
  kForceX, kForceZ, kTorqueY, kWrenchOutputs,
  kR01X = kWrenchOutputs, kR01Z, kR12X, kR12Z, kR23X, kR23Z, kR03X, kR03Z, kDriveTorque, kAllOutputs
};

struct HalfOffset {
  double half;  ///< half the offset's size [rad], in [0, pi/2]
  bool before;
};

/// Like CrankAngle::wrapToPi, in operations that every instruction set has: 2 pi in three parts, of which the first two
/// have 26 and 27 bits, so that their products with the number of turns are exact with and without fma.
HAMMER_LOADS_INLINE HalfOffset halfOffset(double phi) noexcept {
  constexpr double kInvTwoPi = 0.15915494309189533577;
  constexpr double kRound = 6755399441055744.0;  // 1.5 2^52: adding it rounds to a whole number
  constexpr double kHigh = 0x1.921fb5p+2, kMiddle = 0x1.110b46p-24, kLow = 0x1.1a62633145c07p-52;
  const double turns = (phi * kInvTwoPi + kRound) - kRound;
  const double offset = ((phi - turns * kHigh) - turns * kMiddle) - turns * kLow;
  return {0.5 * std::abs(offset), offset < 0.0};
}

/// motion() without branches. With c signed by the side, tan(psi/2) = sigma s/(lambda0 r + lambda3 c) and so on hold on
/// both sides; before the blow, where c < 0, such sums are formed as quotients that do not cancel.
HAMMER_LOADS_INLINE Motion motionOfEitherSide(const CrankRocker::Ratios& k, HalfOffset angle) noexcept {
  const detail::HalfAngleTerms t = detail::halfAngleTerms(k, sineCosinePolynomial(angle.half));
  const bool before = angle.before;
  const double a_sum = t.r + k.lambda2 * t.c;
  const double d = before ? k.sigma * (k.k_cos * t.cc + k.k_sin * t.ss) / t.d : t.d;
  const double a = before ? k.sigma * ((k.lambda2 - 1.0) * t.ss - k.w0) / a_sum : a_sum;
  const double sum = before ? t.g_over_z : t.z;         // r + c with c signed
  const double difference = before ? t.z : t.g_over_z;  // r - c
  const double pp = k.sigma_squared * t.ss, dd = d * d;
  const double inv_n = 1.0 / (pp + dd);
  const double inv_nr = inv_n * t.inv_r;
  Motion m;
  m.sin_psi_over_s = (2.0 * k.sigma * d) * inv_n;
  m.cos_psi = (dd - pp) * inv_n;
  m.u = (k.lambda3_sigma * a) * inv_nr;
  m.du_over_s = (k.lambda3_sigma * difference) * inv_nr *
                ((k.lambda03 * a * difference) * inv_nr - (0.5 * k.lambda2 * sum) * (t.inv_r * t.inv_r));
  m.sin_half = t.s;
  m.cos_half = before ? -t.c : t.c;
  m.r = t.r;
  m.inv_r = t.inv_r;
  m.sin_psi = t.s * m.sin_psi_over_s;
  m.du = t.s * m.du_over_s;
  return m;
}

HAMMER_LOADS_INLINE HullWrench pulseWrench(const Mechanism& mechanism, const NominalPulse& pulse, HalfOffset angle,
                                           const CrankMotion& crank, Gravity gravity) noexcept {
  constexpr double kTwoPi = 6.283185307179586232;
  const double size = 2.0 * angle.half;
  const double left = angle.before ? size : kTwoPi - size;
  const bool within = left < pulse.length;
  const SineCosine half = sineCosinePolynomial(within ? 0.5 * pulse.frequency * left : 0.0);
  const double sine = 2.0 * half.sine * half.cosine;
  const double weight = mechanism.parameters().rocker_mass * gravity.z;
  return {0.0, pulse.amplitude * crank.speed * crank.speed * sine + weight, 0.0};
}

/// Copies, so that results written in the loop cannot alias them and reading them cannot fail.
struct Job {
  explicit Job(const HullModel& model, Gravity g)
      : mechanism(model.mechanism()), pulse(model.nominalPulse()), gravity(g) {}
  Mechanism mechanism;
  NominalPulse pulse;
  Gravity gravity;
};

using Columns = std::array<const double*, kInputs>;
using Results = std::array<double*, kAllOutputs>;

using Block = std::array<double, kBlock>;

/// One block of states, from and to arrays that nothing else can alias.
template <Level level, bool with_pins>
HAMMER_LOADS_INLINE void computeBlock(const Job& job, const std::array<Block, kInputs>& in,
                                      std::array<Block, kAllOutputs>& out) noexcept {
  const CrankRocker::Ratios& ratios = job.mechanism.linkage().ratios();
  const NearBlow near_blow(0.0);
  for (std::size_t i = 0; i < kBlock; ++i) {
    const HalfOffset angle = halfOffset(in[kAngle][i]);
    const CrankMotion crank{{}, in[kSpeed][i], in[kAcceleration][i]};
    HullWrench wrench;
    if constexpr (level == Level::kPulse) {
      wrench = pulseWrench(job.mechanism, job.pulse, angle, crank, job.gravity);
    } else {
      const Motion m = motionOfEitherSide(ratios, angle);
      const LinkMotion l = linkMotion(ratios, m);
      wrench = level == Level::kLinkage ? hullWrenchLinkage(job.mechanism, l, crank, job.gravity)
                                        : hullWrenchRocker(job.mechanism, m, crank, job.gravity);
      if constexpr (with_pins) {
        const PinReactions pins = level == Level::kLinkage
                                      ? pinForcesLinkage(job.mechanism, l, crank, job.gravity, near_blow)
                                      : pinForcesRocker(job.mechanism, l, crank, job.gravity, near_blow);
        out[kR01X][i] = pins.hull_on_crank.x, out[kR01Z][i] = pins.hull_on_crank.z;
        out[kR12X][i] = pins.crank_on_rod.x, out[kR12Z][i] = pins.crank_on_rod.z;
        out[kR23X][i] = pins.rod_on_rocker.x, out[kR23Z][i] = pins.rod_on_rocker.z;
        out[kR03X][i] = pins.hull_on_rocker.x, out[kR03Z][i] = pins.hull_on_rocker.z;
        out[kDriveTorque][i] = pins.drive_torque;
      }
    }
    out[kForceX][i] = wrench.force_x, out[kForceZ][i] = wrench.force_z, out[kTorqueY][i] = wrench.torque_y;
  }
}

/// Whole blocks; the last one is filled up, so that its states go through the same instructions.
template <Level level, bool with_pins>
HAMMER_LOADS_INLINE void computeAll(const HullModel& model, Gravity gravity, const Columns& in, std::size_t count,
                                    const Results& out) noexcept {
  constexpr std::size_t kOutputs = with_pins ? kAllOutputs : kWrenchOutputs;
  const Job job(model, gravity);
  alignas(64) std::array<Block, kInputs> block_in{};
  alignas(64) std::array<Block, kAllOutputs> block_out;
  const auto computePart = [&](std::size_t done, auto size) {
    for (std::size_t c = 0; c < kInputs; ++c) std::memcpy(block_in[c].data(), in[c] + done, size * sizeof(double));
    computeBlock<level, with_pins>(job, block_in, block_out);
    for (std::size_t c = 0; c < kOutputs; ++c) std::memcpy(out[c] + done, block_out[c].data(), size * sizeof(double));
  };
  std::size_t done = 0;
  for (; done + kBlock <= count; done += kBlock) computePart(done, std::integral_constant<std::size_t, kBlock>());
  if (done < count) computePart(done, count - done);
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

using Kernel = void (*)(const HullModel&, Gravity, const Columns&, std::size_t, const Results&) noexcept;

template <bool with_pins>
void computeBaseline(const HullModel& model, Gravity gravity, const Columns& in, std::size_t count,
                     const Results& out) noexcept {
  compute<with_pins>(model, gravity, in, count, out);
}

#ifdef HAMMER_LOADS_CPU_CLONES
template <bool with_pins>
[[gnu::target("avx2,fma")]] void computeAvx2(const HullModel& model, Gravity gravity, const Columns& in,
                                             std::size_t count, const Results& out) noexcept {
  compute<with_pins>(model, gravity, in, count, out);
}

template <bool with_pins>
[[gnu::target("avx512f,avx512dq,avx512vl,avx2,fma")]] void computeAvx512(const HullModel& model, Gravity gravity,
                                                                         const Columns& in, std::size_t count,
                                                                         const Results& out) noexcept {
  compute<with_pins>(model, gravity, in, count, out);
}
#endif

template <bool with_pins>
Kernel kernelOfCpu() noexcept {
#ifdef HAMMER_LOADS_CPU_CLONES
  switch (batchWidth()) {
    case BatchWidth::kAvx512: return computeAvx512<with_pins>;
    case BatchWidth::kAvx2: return computeAvx2<with_pins>;
    case BatchWidth::kBaseline: break;
  }
#endif
  return computeBaseline<with_pins>;
}

Columns columnsOf(const CrankStates& states) noexcept { return {states.angle, states.speed, states.acceleration}; }

}  // namespace

BatchWidth batchWidth() noexcept {
#ifdef HAMMER_LOADS_CPU_CLONES
  static const BatchWidth width = [] {
    __builtin_cpu_init();
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    return avx2 && avx512 ? BatchWidth::kAvx512 : avx2 ? BatchWidth::kAvx2 : BatchWidth::kBaseline;
  }();
  return width;
#else
  return BatchWidth::kBaseline;
#endif
}

void hullWrenches(const HullModel& model, const CrankStates& states, Gravity gravity,
                  const WrenchArrays& wrenches) noexcept {
  static const Kernel kernel = kernelOfCpu<false>();
  const Results out{wrenches.force_x, wrenches.force_z, wrenches.torque_y};
  kernel(model, gravity, columnsOf(states), states.count, out);
}

void linkLoads(const HullModel& model, const CrankStates& states, Gravity gravity, const WrenchArrays& wrenches,
               const PinArrays& pins) noexcept {
  static const Kernel kernel = kernelOfCpu<true>();
  const Results out{wrenches.force_x,      wrenches.force_z,     wrenches.torque_y,    pins.hull_on_crank_x,
                    pins.hull_on_crank_z,  pins.crank_on_rod_x,  pins.crank_on_rod_z,  pins.rod_on_rocker_x,
                    pins.rod_on_rocker_z,  pins.hull_on_rocker_x, pins.hull_on_rocker_z, pins.drive_torque};
  kernel(model, gravity, columnsOf(states), states.count, out);
}

}  // namespace hammer_loads
