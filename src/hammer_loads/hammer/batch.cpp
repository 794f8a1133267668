#include "hammer_loads/hammer/batch.h"

#include <algorithm>

#include "hammer_loads/hammer/batch_block.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define HAMMER_LOADS_CPU_CLONES 1
#endif

namespace hammer_loads {
namespace {

using detail::Columns;
using detail::Results;

using Kernel = void (*)(const HullModel&, Gravity, const Columns&, std::size_t, const Results&) noexcept;

template <bool with_pins>
void computeBaseline(const HullModel& model, Gravity gravity, const Columns& in, std::size_t count,
                     const Results& out) noexcept {
  detail::compute<with_pins>(model, gravity, in, count, out);
}

#ifdef HAMMER_LOADS_CPU_CLONES
template <bool with_pins>
[[gnu::target("avx2,fma")]] void computeAvx2(const HullModel& model, Gravity gravity, const Columns& in,
                                             std::size_t count, const Results& out) noexcept {
  detail::compute<with_pins>(model, gravity, in, count, out);
}

// GCC 9 uses instructions of avx512bw unasked, and its assembler refuses them where that is not named.
template <bool with_pins>
[[gnu::target("avx512f,avx512dq,avx512bw,avx512vl,avx2,fma")]] void computeAvx512(const HullModel& model,
                                                                                  Gravity gravity, const Columns& in,
                                                                                  std::size_t count,
                                                                                  const Results& out) noexcept {
  detail::compute<with_pins>(model, gravity, in, count, out);
}
#endif

template <bool with_pins>
Kernel kernelFor(BatchWidth width) noexcept {
#ifdef HAMMER_LOADS_CPU_CLONES
  switch (std::min(width, batchWidth())) {
    case BatchWidth::kAvx512:
      return computeAvx512<with_pins>;
    case BatchWidth::kAvx2:
      return computeAvx2<with_pins>;
    case BatchWidth::kBaseline:
      break;
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
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
    return avx2 && avx512 ? BatchWidth::kAvx512 : avx2 ? BatchWidth::kAvx2 : BatchWidth::kBaseline;
  }();
  return width;
#else
  return BatchWidth::kBaseline;
#endif
}

void hullWrenches(const HullModel& model, const CrankStates& states, Gravity gravity, const WrenchArrays& wrenches,
                  BatchWidth width) noexcept {
  const Results out{wrenches.force_x, wrenches.force_z, wrenches.torque_y};
  kernelFor<false>(width)(model, gravity, columnsOf(states), states.count, out);
}

void linkLoads(const HullModel& model, const CrankStates& states, Gravity gravity, const WrenchArrays& wrenches,
               const PinArrays& pins, BatchWidth width) noexcept {
  const Results out{wrenches.force_x,     wrenches.force_z,      wrenches.torque_y,     pins.hull_on_crank_x,
                    pins.hull_on_crank_z, pins.crank_on_rod_x,   pins.crank_on_rod_z,   pins.rod_on_rocker_x,
                    pins.rod_on_rocker_z, pins.hull_on_rocker_x, pins.hull_on_rocker_z, pins.drive_torque};
  kernelFor<true>(width)(model, gravity, columnsOf(states), states.count, out);
}

}  // namespace hammer_loads
