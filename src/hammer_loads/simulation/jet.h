/// A value with its first two derivatives by one variable: kinematics without derived formulas.
#pragma once

#include <cmath>

namespace hammer_loads::simulation {

/// f, df/dx, d2f/dx2.
struct Jet {
  double value{};
  double first{};
  double second{};
};

/// f(a) from f and its derivatives at a.value.
inline Jet chain(const Jet& a, double f, double df, double ddf) noexcept {
  return {f, df * a.first, ddf * a.first * a.first + df * a.second};
}

inline Jet operator+(const Jet& a, const Jet& b) noexcept {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
inline Jet operator-(const Jet& a, const Jet& b) noexcept {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}
inline Jet operator*(const Jet& a, const Jet& b) noexcept {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}
inline Jet operator+(const Jet& a, double b) noexcept { return {a.value + b, a.first, a.second}; }
inline Jet operator-(double a, const Jet& b) noexcept { return {a - b.value, -b.first, -b.second}; }
inline Jet operator*(double a, const Jet& b) noexcept { return {a * b.value, a * b.first, a * b.second}; }
inline Jet operator/(const Jet& a, const Jet& b) noexcept {
  const double inv = 1.0 / b.value;
  return a * chain(b, inv, -inv * inv, 2.0 * inv * inv * inv);
}
inline Jet sqrt(const Jet& a) noexcept {
  const double root = std::sqrt(a.value);
  return chain(a, root, 0.5 / root, -0.25 / (root * a.value));
}
inline Jet sin(const Jet& a) noexcept {
  const double s = std::sin(a.value);
  return chain(a, s, std::cos(a.value), -s);
}
inline Jet cos(const Jet& a) noexcept {
  const double c = std::cos(a.value);
  return chain(a, c, -std::sin(a.value), -c);
}
inline Jet asin(const Jet& a) noexcept {
  const double w = 1.0 / ((1.0 - a.value) * (1.0 + a.value));
  const double root = std::sqrt(w);
  return chain(a, std::asin(a.value), root, a.value * w * root);
}
inline Jet atan(const Jet& a) noexcept {
  const double w = 1.0 / (1.0 + a.value * a.value);
  return chain(a, std::atan(a.value), w, -2.0 * a.value * w * w);
}

}  // namespace hammer_loads::simulation
