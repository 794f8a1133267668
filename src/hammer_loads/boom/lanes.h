/// Four numbers, most of them vectors of space, in lanes: one register with AVX, two of any x86-64. Of a
/// vector the fourth lane does not matter.
#pragma once

#include <cstring>

#include "hammer_loads/boom/wrench.h"
#include "hammer_loads/util/inline.h"

// All of it is inlined: no call passes a register that some CPUs have not.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace hammer_loads {

typedef double Lanes __attribute__((vector_size(4 * sizeof(double))));

HAMMER_LOADS_INLINE Lanes lanesOf(const Eigen::Vector3d& v) noexcept { return Lanes{v[0], v[1], v[2], v[2]}; }
HAMMER_LOADS_INLINE Lanes lanesAt(const double* four) noexcept {
  Lanes v;
  std::memcpy(&v, four, sizeof v);
  return v;
}
HAMMER_LOADS_INLINE void store(const Lanes& v, double* four) noexcept { std::memcpy(four, &v, sizeof v); }
HAMMER_LOADS_INLINE void store(const Lanes& v, Eigen::Vector3d& to) noexcept {
  to[0] = v[0], to[1] = v[1], to[2] = v[2];
}

HAMMER_LOADS_INLINE Lanes cross(const Lanes& a, const Lanes& b) noexcept {
  const Lanes a_next{a[1], a[2], a[0], a[3]}, b_next{b[1], b[2], b[0], b[3]};
  const Lanes c = a * b_next - a_next * b;  // z, x, y
  return Lanes{c[1], c[2], c[0], c[3]};
}

/// Of a matrix in three columns of four, times v.
HAMMER_LOADS_INLINE Lanes product(const double* columns, const double* v) noexcept {
  return lanesAt(columns) * v[0] + lanesAt(columns + 4) * v[1] + lanesAt(columns + 8) * v[2];
}

HAMMER_LOADS_INLINE double dot(const Lanes& a, const Lanes& b) noexcept {
  const Lanes c = a * b;
  return c[0] + c[1] + c[2];
}

HAMMER_LOADS_INLINE Lanes originOf(const Pose& X) noexcept { return lanesAt(X.data() + 12); }
/// A point of a frame in the frame that X is seen from.
HAMMER_LOADS_INLINE Lanes pointAt(const Pose& X, const double* p) noexcept {
  return originOf(X) + product(X.data(), p);
}

struct LaneWrench {
  Lanes force, torque;
};
HAMMER_LOADS_INLINE LaneWrench lanesOf(const Wrench& w) noexcept { return {lanesOf(w.force), lanesOf(w.torque)}; }
HAMMER_LOADS_INLINE void store(const LaneWrench& w, Wrench& to) noexcept {
  store(w.force, to.force), store(w.torque, to.torque);
}
HAMMER_LOADS_INLINE void add(const LaneWrench& other, LaneWrench& to) noexcept {
  to.force += other.force, to.torque += other.torque;
}

/// Four rows become four columns.
HAMMER_LOADS_INLINE void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) noexcept {
  const Lanes low{a[0], b[0], a[2], b[2]}, high{a[1], b[1], a[3], b[3]};
  const Lanes low_2{c[0], d[0], c[2], d[2]}, high_2{c[1], d[1], c[3], d[3]};
  a = Lanes{low[0], low[1], low_2[0], low_2[1]}, b = Lanes{high[0], high[1], high_2[0], high_2[1]};
  c = Lanes{low[2], low[3], low_2[2], low_2[3]}, d = Lanes{high[2], high[3], high_2[2], high_2[3]};
}

HAMMER_LOADS_INLINE double sumOf(const Lanes& v) noexcept { return (v[0] + v[2]) + (v[1] + v[3]); }

/// Of the transpose of a matrix in three columns of four; by transpose() with a fourth it took 1 % of a sample more.
struct TransposedLanes {
  Lanes x, y, z;
};
HAMMER_LOADS_INLINE TransposedLanes transposed(const Lanes& a, const Lanes& b, const Lanes& c) noexcept {
  const Lanes low{a[0], b[0], a[2], b[2]}, high{a[1], b[1], a[3], b[3]};
  return {Lanes{low[0], low[1], c[0], c[1]}, Lanes{high[0], high[1], c[1], c[1]}, Lanes{low[2], low[3], c[2], c[3]}};
}
HAMMER_LOADS_INLINE Lanes operator*(const TransposedLanes& M, const Lanes& v) noexcept {
  return M.x * v[0] + M.y * v[1] + M.z * v[2];
}

}  // namespace hammer_loads
