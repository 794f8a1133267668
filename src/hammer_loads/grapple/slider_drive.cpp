#include "hammer_loads/grapple/slider_drive.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/grapple/grapple_parameters.h"

namespace hammer_loads {

SliderDrive::SliderDrive(const GrappleParameters& p)
    : o1_(p.o1), slider_x_(p.slider_x), o1h_(p.o1h), gh_(p.gh), ho1a_(p.ho1a), sign_(p.drive_sign) {}

std::optional<DriveMotion> SliderDrive::at(double slider) const noexcept {
  const Planar g{slider_x_ - o1_.re, slider - o1_.im};
  const double distance_squared = squaredNorm(g);
  const double distance = std::sqrt(distance_squared);
  // Heron: (4 x area of G-H-O1)^2, the differences formed from the lengths.
  const double product =
      (gh_ - o1h_ + distance) * (gh_ + o1h_ - distance) * (o1h_ + distance - gh_) * (o1h_ + distance + gh_);
  if (!(product > 0.0)) return std::nullopt;
  const double four_areas = sign_ * std::sqrt(product);

  DriveMotion m;
  const double scale = 0.5 / distance_squared;
  m.o1h = (scale * (distance_squared + (o1h_ - gh_) * (o1h_ + gh_))) * g + (scale * four_areas) * turned(g);
  // |GH| is constant: q . (i r t1 - i) = 0 with r = O1H, q = GH; q . i r = four_areas/2.
  const Planar q = m.o1h - g;
  const double inverse = 2.0 / four_areas;
  m.dtheta1 = q.im * inverse;
  const Planar h_velocity = m.dtheta1 * turned(m.o1h) - Planar{0.0, 1.0};
  m.ddtheta1 = (dot(q, m.o1h) * m.dtheta1 * m.dtheta1 - squaredNorm(h_velocity)) * inverse;
  return m;
}

std::optional<Reach> SliderDrive::reachAround(double slider) const noexcept {
  if (!at(slider)) return std::nullopt;
  const double across = std::abs(slider_x_ - o1_.re);
  const double farthest = o1h_ + gh_, nearest = std::abs(o1h_ - gh_);
  const double high = std::sqrt((farthest - across) * (farthest + across));
  if (nearest < across) return Reach{o1_.im - high, o1_.im + high};
  const double low = std::sqrt((nearest - across) * (nearest + across));
  return slider > o1_.im ? Reach{o1_.im + low, o1_.im + high} : Reach{o1_.im - high, o1_.im - low};
}

double SliderDrive::theta1(double slider) const noexcept {
  // Measured from a direction that G never leaves by 180 deg within one interval of reach.
  const Planar g{slider_x_ - o1_.re, slider - o1_.im};
  const bool passes_beside = std::abs(o1h_ - gh_) < std::abs(g.re);
  const Planar middle = passes_beside ? Planar{std::copysign(1.0, g.re), 0.0} : Planar{0.0, std::copysign(1.0, g.im)};
  const double arg_g = angleOf(middle) + std::atan2(cross(middle, g), dot(middle, g));
  const Planar o1h = at(slider)->o1h;
  return arg_g + std::atan2(cross(g, o1h), dot(g, o1h)) - ho1a_;
}

std::array<double, 2> SliderDrive::slidersAt(double theta1) const noexcept {
  const Planar h = o1_ + o1h_ * direction(theta1 + ho1a_);
  const double across = std::abs(slider_x_ - h.re);
  const double along = std::sqrt((gh_ - across) * (gh_ + across));  // NaN where the rod does not reach the line
  return {h.im - along, h.im + along};
}

}  // namespace hammer_loads
