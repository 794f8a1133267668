/// Vectors of the mechanism's plane as complex numbers.
#pragma once

namespace hammer_loads {

/// re + i im. std::complex checks each product for NaN; here non-finite input simply stays non-finite.
struct Planar {
  double re{};
  double im{};
};

constexpr Planar operator+(Planar a, Planar b) noexcept { return {a.re + b.re, a.im + b.im}; }
constexpr Planar operator-(Planar a, Planar b) noexcept { return {a.re - b.re, a.im - b.im}; }
constexpr Planar operator*(double k, Planar a) noexcept { return {k * a.re, k * a.im}; }
constexpr Planar operator*(Planar a, Planar b) noexcept {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
constexpr Planar conj(Planar a) noexcept { return {a.re, -a.im}; }
/// i a: a turned by +90 deg.
constexpr Planar turned(Planar a) noexcept { return {-a.im, a.re}; }

}  // namespace hammer_loads
