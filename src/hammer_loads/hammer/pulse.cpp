#include "hammer_loads/hammer/pulse.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

/// mu and t1 from H, S and T; P0 (16).
void shapeFromImpulse(HalfSinePulse& pulse) noexcept {
  const bool positive = pulse.amplitude > 0.0 && pulse.impulse > 0.0;
  pulse.frequency = positive ? 2.0 * pulse.amplitude / pulse.impulse : 0.0;
  pulse.start = positive ? pulse.period - kPi / pulse.frequency : pulse.period;
}

/// P0 (15) with the shift [N].
double halfSine(const HalfSinePulse& pulse, double time) noexcept {
  return time > pulse.start ? pulse.amplitude * std::sin(pulse.frequency * (time - pulse.start)) : 0.0;
}

/// Index of the point before the last rise through zero of a lobe that counts, or -1.
template <typename Force>
std::ptrdiff_t lastRise(const Force& force, std::size_t count, double amplitude) noexcept {
  double lobe = 0.0;
  for (std::size_t i = count; i-- > 0;) {
    const double f = force(i);
    if (f > 0.0) {
      lobe = std::max(lobe, f);
      continue;
    }
    if (lobe >= kLeastLobe * amplitude && lobe > 0.0) return static_cast<std::ptrdiff_t>(i);
    lobe = 0.0;
  }
  return -1;
}

/// Vertex of the parabola through three points whose middle one is highest.
void parabolaPeak(const TurnPoint& a, const TurnPoint& b, const TurnPoint& c, HalfSinePulse& pulse) noexcept {
  const double left = (b.force_z - a.force_z) / (b.time - a.time);
  const double right = (c.force_z - b.force_z) / (c.time - b.time);
  const double curvature = (right - left) / (c.time - a.time);
  if (!(curvature < 0.0)) return;                             // three equal values
  const double slope = left + curvature * (b.time - a.time);  // at b
  const double shift = -0.5 * slope / curvature;
  pulse.peak_time = b.time + shift;
  pulse.amplitude = b.force_z + 0.5 * slope * shift;
}

/// Peak by the points around the highest one. Points much closer to it on one side than on the other are passed over:
/// of two samples 2 ns apart the force differs by more than the parabola's curvature allows.
void peakBetweenPoints(const TurnPoint* first, const TurnPoint* top, const TurnPoint* last,
                       HalfSinePulse& pulse) noexcept {
  constexpr double kLeastRatio = 0.1;
  const TurnPoint *before = top - 1, *after = top + 1;
  const double spacing = kLeastRatio * std::max(top->time - before->time, after->time - top->time);
  while (before != first && top->time - before->time < spacing) --before;
  while (after != last && after->time - top->time < spacing) ++after;
  parabolaPeak(*before, *top, *after, pulse);
}

/// Impulse at a part x in [0, 1] of the way from a to b: cubic with the forces as slopes.
double hermite(const TurnPoint& a, const TurnPoint& b, double x) noexcept {
  const double dt = b.time - a.time;
  const double y = 1.0 - x;
  return y * y * ((1.0 + 2.0 * x) * a.impulse_z + x * dt * a.force_z) +
         x * x * ((1.0 + 2.0 * y) * b.impulse_z - y * dt * b.force_z);
}

}  // namespace

HalfSinePulse pulseOfTurn(const TurnPoint* points, std::size_t count) noexcept {
  HalfSinePulse pulse;
  if (count < 3) return pulse;
  const TurnPoint& last = points[count - 1];
  pulse.period = last.time;
  pulse.turn_impulse_x = last.impulse_x;
  pulse.turn_impulse_z = last.impulse_z;

  const auto top = std::max_element(points, points + count,
                                    [](const TurnPoint& a, const TurnPoint& b) { return a.force_z < b.force_z; });
  pulse.amplitude = top->force_z;
  pulse.peak_time = top->time;
  if (top != points && top != &last) peakBetweenPoints(points, top, &last, pulse);

  const std::ptrdiff_t rise = lastRise([&](std::size_t i) { return points[i].force_z; }, count, pulse.amplitude);
  double before_lobe = 0.0;
  if (rise >= 0) {
    const TurnPoint& a = points[rise];
    const TurnPoint& b = points[rise + 1];
    before_lobe = hermite(a, b, -a.force_z / (b.force_z - a.force_z));
  }
  pulse.impulse = pulse.amplitude > 0.0 ? last.impulse_z - before_lobe : 0.0;
  shapeFromImpulse(pulse);

  double sum = 0.0, previous = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double deviation = points[i].force_z - halfSine(pulse, points[i].time);
    const double square = deviation * deviation;
    if (i > 0) sum += 0.5 * (square + previous) * (points[i].time - points[i - 1].time);
    previous = square;
  }
  pulse.half_sine_rms_error = pulse.amplitude > 0.0 ? std::sqrt(sum / pulse.period) / pulse.amplitude : 0.0;
  return pulse;
}

namespace {

/// One turn at constant speed as a function of phi in [0, 2 pi]: after the blow up to pi, then before the next one.
class Turn {
 public:
  Turn(const Mechanism& mechanism, Level level, double speed, Gravity gravity)
      : mechanism_(mechanism), level_(level), speed_(speed), gravity_(gravity) {}

  static CrankAngle at(double phi) noexcept {
    return phi <= kPi ? CrankAngle{phi, Side::kAfterBlow} : CrankAngle{phi - kTwoPi, Side::kBeforeBlow};
  }
  double forceZ(CrankAngle angle) const noexcept {
    return hullWrench(mechanism_, level_, {angle, speed_, 0.0}, gravity_).force_z;
  }
  double forceZ(double phi) const noexcept { return forceZ(at(phi)); }
  /// Since the turn's start [N s], as (x, z).
  std::array<double, 2> impulse(double phi) const noexcept {
    const LinkMomentum begin = linkMomentum(mechanism_, level_, {0.0, Side::kAfterBlow}, speed_);
    const CrankAngle angle = phi < kTwoPi ? at(phi) : CrankAngle{0.0, Side::kBeforeBlow};
    const LinkMomentum end = linkMomentum(mechanism_, level_, angle, speed_);
    const double mass_time = movingMass(mechanism_, level_) * phi / speed_;
    return {begin.x - end.x + mass_time * gravity_.x, begin.z - end.z + mass_time * gravity_.z};
  }

 private:
  const Mechanism& mechanism_;
  Level level_;
  double speed_;
  Gravity gravity_;
};

/// First and second derivative of Fz by phi, central differences of order 8 on the smooth branch of phi's side (which
/// continues beyond the blow): no noise of the difference of nearly equal values, as with a narrow stencil.
std::array<double, 2> slopes(const Turn& turn, CrankAngle angle, double h) noexcept {
  constexpr std::array<double, 4> kFirst{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  constexpr std::array<double, 4> kSecond{8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0};
  const double middle = turn.forceZ(angle);
  double first = 0.0, second = 0.0;
  for (std::size_t k = 0; k < kFirst.size(); ++k) {
    const double shift = static_cast<double>(k + 1) * h;
    const double up = turn.forceZ(CrankAngle{angle.offset + shift, angle.side});
    const double down = turn.forceZ(CrankAngle{angle.offset - shift, angle.side});
    first += kFirst[k] * (up - down);
    second += kSecond[k] * ((up - middle) + (down - middle));
  }
  return {first / h, second / (h * h)};
}

/// Crank angle of the largest Fz within one step on either side of a sample: Newton's method on the slope.
double refinePeak(const Turn& turn, double phi, double step, double stencil) noexcept {
  const double low = std::max(0.0, phi - step), high = std::min(kTwoPi, phi + step);
  double at = phi;
  for (int i = 0; i < 12; ++i) {
    const auto [first, second] =
        slopes(turn, at >= kTwoPi ? CrankAngle{0.0, Side::kBeforeBlow} : Turn::at(at), stencil);
    if (!(second < 0.0)) break;
    const double next = std::clamp(at - first / second, low, high);
    const double change = next - at;
    at = next;
    if (std::abs(change) < 1e-15) break;
  }
  return turn.forceZ(at) >= turn.forceZ(phi) ? at : phi;
}

/// rms of (Fz - half sine)/H over the turn, Gauss quadrature in pieces that end at the half sine's start.
double halfSineError(const Turn& turn, const HalfSinePulse& pulse, double speed) {
  const auto square = [&](double phi) {
    const double deviation = turn.forceZ(phi) - halfSine(pulse, phi / speed);
    return deviation * deviation;
  };
  constexpr int kPieces = 48;
  const double start = std::clamp(speed * pulse.start, 0.0, kTwoPi);
  double sum = 0.0;
  for (const auto& [from, to] : {std::pair{0.0, start}, std::pair{start, kTwoPi}}) {
    const double width = (to - from) / kPieces;
    for (int i = 0; i < kPieces; ++i) {
      sum += boost::math::quadrature::gauss<double, 10>::integrate(square, from + i * width, from + (i + 1) * width);
    }
  }
  return std::sqrt(sum / kTwoPi) / pulse.amplitude;
}

/// Angle over which Fz may change its shape: distance of the nearest singularity of the transfer functions from the
/// real axis, (lambda0 - 1)/sqrt(lambda0) at the blow and 2 sqrt(g) opposite to it [rad], at most 1.
double shapeAngle(const CrankRocker& linkage) noexcept {
  const LinkLengths& l = linkage.lengths();
  const double at_blow = (l.pivot_distance - l.crank) / std::sqrt(l.pivot_distance * l.crank);
  return std::min({1.0, at_blow, 2.0 * std::sqrt(linkage.ratios().g)});
}

}  // namespace

ConstantSpeedPulse pulseAtConstantSpeed(const Mechanism& mechanism, Level level, double speed, Gravity gravity) {
  const Turn turn(mechanism, level, speed, gravity);
  const double shape = shapeAngle(mechanism.linkage());
  const std::size_t steps = static_cast<std::size_t>(std::clamp(std::ceil(720.0 / shape), 720.0, 72000.0));
  const double step = kTwoPi / static_cast<double>(steps);
  std::vector<double> force(steps + 1);
  for (std::size_t i = 0; i < steps; ++i) force[i] = turn.forceZ(static_cast<double>(i) * step);
  force[steps] = turn.forceZ(CrankAngle{0.0, Side::kBeforeBlow});

  ConstantSpeedPulse result;
  HalfSinePulse& pulse = result.pulse;
  const std::ptrdiff_t top = std::max_element(force.begin(), force.end()) - force.begin();
  result.peak_angle = refinePeak(turn, static_cast<double>(top) * step, step, 0.01 * shape);
  pulse.amplitude = turn.forceZ(result.peak_angle);
  pulse.peak_time = result.peak_angle / speed;
  pulse.period = kTwoPi / speed;
  const std::array<double, 2> whole = turn.impulse(kTwoPi);
  pulse.turn_impulse_x = whole[0];
  pulse.turn_impulse_z = whole[1];

  const std::ptrdiff_t rise = lastRise([&](std::size_t i) { return force[i]; }, steps + 1, pulse.amplitude);
  double before_lobe = 0.0;
  if (rise > 0 || (rise == 0 && force[0] < 0.0)) {
    std::uintmax_t iterations = 100;
    const double from = static_cast<double>(rise) * step;
    const auto root = boost::math::tools::toms748_solve([&](double phi) { return turn.forceZ(phi); }, from,
                                                        std::min(from + step, kTwoPi),
                                                        boost::math::tools::eps_tolerance<double>(52), iterations);
    before_lobe = turn.impulse(0.5 * (root.first + root.second))[1];
  }
  pulse.impulse = pulse.amplitude > 0.0 ? whole[1] - before_lobe : 0.0;
  shapeFromImpulse(pulse);
  pulse.half_sine_rms_error = pulse.amplitude > 0.0 ? halfSineError(turn, pulse, speed) : 0.0;
  return result;
}

}  // namespace hammer_loads
