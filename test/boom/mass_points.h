/// The shipped boom as point masses, read from its description by separate code. The loads by their weight and inertia
/// follow from differences in time. Shares no code with src/hammer_loads/boom.
#pragma once

#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>

#include "boom/booms.h"

namespace hammer_loads::test::mass_points {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;

struct Load {
  Vector force = Vector::Zero(), moment = Vector::Zero();
  void add(const Vector& p, const Vector& f) { force += f, moment += p.cross(f); }
};

struct Place {
  Matrix R = Matrix::Identity();
  Vector p = Vector::Zero();
  Vector at(const Vector& point) const { return p + R * point; }
};

/// Point mass on a link of the description.
struct Point {
  int link;  ///< index in the row
  Vector p;
  Real mass;
};

/// Row of links from base_link to hammer_hull, read from the description by separate code.
class Row {
 public:
  explicit Row(const std::string& urdf) : model_(urdf::parseURDF(urdf)) {
    for (urdf::LinkConstSharedPtr link = model_->getLink("hammer_hull"); link->parent_joint; link = link->getParent())
      joints_.insert(joints_.begin(), link->parent_joint);
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const urdf::LinkConstSharedPtr link = model_->getLink(joints_[i]->child_link_name);
      const int index = static_cast<int>(i) + 1;
      names_[link->name] = index;
      if (!link->inertial) continue;
      const urdf::Inertial& b = *link->inertial;
      Eigen::Matrix3d inertia;
      inertia << b.ixx, b.ixy, b.ixz, b.ixy, b.iyy, b.iyz, b.ixz, b.iyz, b.izz;
      const urdf::Vector3& c = b.origin.position;
      addBody(index, {b.mass, {c.x, c.y, c.z}, inertia}, 1.0, points_);
    }
  }

  int link(const std::string& name) const { return names_.at(name); }
  const std::vector<Point>& points() const { return points_; }

  /// Adds six points with the mass, centre of mass and inertia of a body; sign -1 subtracts it.
  static void addBody(int link, const RigidBody& body, Real sign, std::vector<Point>& points) {
    if (body.mass == 0.0) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(body.inertia);
    const Eigen::Vector3d I = principal.eigenvalues();
    for (int k = 0; k < 3; ++k) {
      const Real spread = 0.5L * (Real(I[(k + 1) % 3]) + I[(k + 2) % 3] - I[k]);
      // The eigenvectors are orthogonal to 1e-15 only, which is the error of this reference.
      const Vector away =
          std::sqrt(std::max(Real(0), 3 * spread / Real(body.mass))) * principal.eigenvectors().col(k).cast<Real>();
      for (Real side : {-1.0L, 1.0L})
        points.push_back({link, body.com.cast<Real>() + side * away, sign * Real(body.mass) / 6});
    }
  }

  /// Returns the places of the links at a time, with constant accelerations of the joints.
  std::vector<Place> places(const JointMotion& m, Real t) const {
    std::vector<Place> places(1);
    int moving = 0;
    for (const urdf::JointSharedPtr& joint : joints_) {
      const urdf::Vector3& p = joint->parent_to_joint_origin_transform.position;
      Place place = places.back();
      place.p = place.at(Vector(p.x, p.y, p.z));
      if (joint->type != urdf::Joint::FIXED) {
        const Real q = m.position[moving] + t * m.velocity[moving] + t * t / 2 * m.acceleration[moving];
        const Vector axis(joint->axis.x, joint->axis.y, joint->axis.z);
        place.R = place.R * Eigen::AngleAxis<Real>(q, axis).toRotationMatrix();
        ++moving;
      }
      places.push_back(place);
    }
    return places;
  }

  /// Returns the load that weight and inertia of the wanted points require: sum of m (a - g), about the base's origin.
  template <typename Wanted>
  Load demanded(const std::vector<Point>& points, const JointMotion& m, const Eigen::Vector3d& g, Wanted wanted) const {
    constexpr Real h = 4e-3L;
    constexpr Real kWeight[] = {-205.0L / 72, 8.0L / 5, -1.0L / 5, 8.0L / 315, -1.0L / 560};  // order 8
    Load load;
    for (int step = -4; step <= 4; ++step) {
      const std::vector<Place> now = places(m, 0), then = places(m, step * h);
      for (const Point& point : points) {
        if (!wanted(point)) continue;
        const auto link = static_cast<std::size_t>(point.link);
        Vector a = kWeight[std::abs(step)] / (h * h) * then[link].at(point.p);
        if (step == 0) a -= g.cast<Real>();
        load.add(now[link].at(point.p), point.mass * a);
      }
    }
    return load;
  }

 private:
  urdf::ModelInterfaceSharedPtr model_;
  std::vector<urdf::JointSharedPtr> joints_;
  std::map<std::string, int> names_;
  std::vector<Point> points_;
};

}  // namespace hammer_loads::test::mass_points
