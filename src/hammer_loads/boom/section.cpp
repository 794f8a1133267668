#include "hammer_loads/boom/section.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/figure_limits.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

void checkRanges(const SectionParameters& p, std::vector<std::string>& problems) {
  const auto check = [&](const char* key, double value, const char* unit, double least, double most) {
    checkRange(p.name + "_section_" + key, value, unit, least, most, problems);
  };
  constexpr const char* kOrigin[] = {"x_m", "y_m", "z_m"};
  constexpr const char* kCom[] = {"com_beyond_x_m", "com_beyond_y_m", "com_beyond_z_m"};
  for (int i = 0; i < 3; ++i) check(kOrigin[i], p.origin[i], "m", -figure::kMostLength, figure::kMostLength);
  check("pitch_rad", p.pitch, "rad", -7.0, 7.0);
  if (!p.beyond) return;
  for (int i = 0; i < 3; ++i) check(kCom[i], p.beyond->com[i], "m", -figure::kMostLength, figure::kMostLength);
  check("inertia_beyond_kg_m2", p.beyond->inertia_y, "kg m2", 0.0, 1e12);
}

bool isName(const std::string& name) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), good);
}

/// A bar along e from `from`, without thickness.
RigidBody slenderBar(double mass, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d e = to - from;
  RigidBody bar;
  bar.mass = mass;
  bar.com = 0.5 * (from + to);
  bar.inertia = mass / 12.0 * (e.squaredNorm() * Eigen::Matrix3d::Identity() - e * e.transpose());
  return bar;
}

}  // namespace

Checked<Section> Section::make(const SectionParameters& p, const Chain& chain) {
  Checked<Section> result;
  const char* name = p.name.c_str();
  if (!isName(p.name)) {
    result.problems.push_back(format("sections: %s, must be names of letters, digits and _", name));
    return result;
  }
  checkRanges(p, result.problems);
  const std::optional<int> link = chain.linkIndex(p.link);
  if (!link || *link == 0 || *link == chain.tip()) {
    result.problems.push_back(format("%s_section_link: %s, must be a link between %s and %s", name, p.link.c_str(),
                                     chain.link(0).name.c_str(), chain.link(chain.tip()).name.c_str()));
  }
  if (!result.problems.empty()) return result;

  Section section;
  section.parameters_ = p;
  section.link_ = *link;
  section.X_LC_.translation() = p.origin;
  section.X_LC_.linear() = Eigen::AngleAxisd(p.pitch, Eigen::Vector3d::UnitY()).toRotationMatrix();
  // The bar from the link's own joint, at its frame's origin, to the next.
  const Eigen::Vector3d end = chain.link(*link + 1).origin;
  const Eigen::Vector3d normal = section.X_LC_.linear().col(0);
  const double before = -normal.dot(p.origin), behind = normal.dot(end - p.origin);
  const double along = end.squaredNorm() > 0.0 ? std::clamp(p.origin.dot(end) / end.squaredNorm(), 0.0, 1.0) : 0.0;
  if (!(before < 0.0) || !(behind > 0.0) || (p.origin - along * end).norm() > end.norm()) {
    result.problems.push_back(
        format("%s_section_x_m: %.9g m, outside the link: the plane must part its joints at (0, 0, 0) and (%.6g, %.6g, "
               "%.6g) m of %s, x towards the second",
               name, p.origin.x(), end.x(), end.y(), end.z(), p.link.c_str()));
    return result;
  }
  const double link_mass = chain.link(*link).body.mass;
  if (p.beyond) {
    if (!(p.beyond->mass >= 0.0 && p.beyond->mass <= link_mass)) {
      result.problems.push_back(format("%s_section_mass_beyond_kg: %.9g kg, must be from 0 to the mass of %s, %.9g kg",
                                       name, p.beyond->mass, p.link.c_str(), link_mass));
      return result;
    }
    section.part_.mass = p.beyond->mass;
    section.part_.com = p.beyond->com;
    section.part_.inertia.diagonal() << 0.0, p.beyond->inertia_y, p.beyond->inertia_y;
  } else {
    const double share = before / (before - behind);  // part of the bar that lies before the cut
    section.part_ = slenderBar((1.0 - share) * link_mass, share * end, end);
    result.notes.push_back(format("%s_section_mass_beyond_kg: not given, %s counts as a uniform bar between its joints",
                                  name, p.link.c_str()));
  }
  result.value = section;
  return result;
}

bool Section::beyond(const Eigen::Vector3d& p_L) const noexcept {
  return X_LC_.linear().col(0).dot(p_L - X_LC_.translation()) > 0.0;
}

}  // namespace hammer_loads
