// Section loads, joint reactions and pin forces compared with point masses whose accelerations are differences in time.
// Newton's law is applied to the part before the cut with the reaction of the base.
#include "hammer_loads/boom/steel_loads.h"

#include <gtest/gtest.h>

#include "boom/linkage_reference.h"
#include "boom/mass_points.h"

namespace hammer_loads {
namespace {

using namespace test::mass_points;
using test::kGravity;

/// Pose of the shipped boom with moving joints, a leaning base and any load of the hammer.
struct Case {
  JointMotion motion;
  Eigen::Vector3d g;
  Wrench w;
};

Case randomCase(const Chain& chain, std::mt19937& random) {
  Case c;
  c.motion.position = test::randomPosition(chain, random);
  c.motion.velocity.resize(4), c.motion.acceleration.resize(4);
  for (int j = 0; j < 4; ++j) {
    c.motion.velocity[j] = test::between(random, -1.0, 1.0);
    c.motion.acceleration[j] = test::between(random, -20.0, 20.0);
  }
  c.g = test::randomVector(random, 8.0);
  c.w = test::randomWrench(random);
  return c;
}

class Steel : public testing::Test {
 protected:
  Steel() : boom_(test::shippedBoom()), row_(test::shippedUrdf()) {}

  Load tip(const Case& c) const {
    const Place hull = row_.places(c.motion, 0).back();
    Load load;
    load.add(hull.p, hull.R * c.w.force.cast<Real>());
    load.moment += hull.R * c.w.torque.cast<Real>();
    return load;
  }

  /// Pin of a cylinder in the base's frame and the force on the chain there. The cylinder holds its joint against all
  /// loads beyond it. Its moment arm follows from virtual work, with differences of its length.
  struct Pin {
    int link;
    Vector on_link, place, force;
  };
  struct Held {
    int beyond;
    Real force;
    std::vector<Pin> pins;  ///< the pin on the link beyond is last
  };
  static Vector inSpace(const test::LinkageReference::Point& p) { return {p.x(), 0, p.y()}; }

  Held held(const Case& c, const CylinderParameters& p) const {
    const int joint = *boom_.chain().jointIndex(p.joint), beyond = boom_.chain().linkBeyond(joint);
    const auto link = static_cast<std::size_t>(beyond);
    const std::vector<Place> places = row_.places(c.motion, 0);
    const Load beyond_demands =
        row_.demanded(row_.points(), c.motion, c.g, [&](const Point& point) { return point.link >= beyond; });
    const Load hammer = tip(c);
    const Vector axis = places[link].R * boom_.chain().link(beyond).axis.cast<Real>();
    const Load net{hammer.force - beyond_demands.force, hammer.moment - beyond_demands.moment};
    const Real torque = axis.dot(net.moment - places[link].p.cross(net.force));
    const Vector base(p.base_x, 0, p.base_z), rod(p.rod_x, 0, p.rod_z);
    if (p.linkage) {
      const Eigen::Vector3d origin = boom_.chain().link(beyond).origin;
      const Eigen::Vector2d from(origin.x(), origin.z());
      BucketLinkageParameters lengths = *p.linkage;
      lengths.branch = -1.0;
      const test::LinkageReference reference({{p.base_x - from.x(), p.base_z - from.y()},
                                              {lengths.guide_x - from.x(), lengths.guide_z - from.y()},
                                              {p.rod_x, p.rod_z}},
                                             lengths);
      const Real q = c.motion.position[joint], force = -torque / reference.arm(q);
      const test::LinkageReference::Forces f = reference.forces(q);
      const Matrix turn = places[link - 1].R;
      const Vector guide(lengths.guide_x, 0, lengths.guide_z);
      return {beyond,
              force,
              {{beyond - 1, base, places[link - 1].at(base), turn * (force * inSpace(f.base))},
               {beyond - 1, guide, places[link - 1].at(guide), turn * (force * inSpace(f.pivot))},
               {beyond, rod, places[link].at(rod), turn * (force * inSpace(f.driven))}}};
    }
    const auto pins = [&](Real step) {
      JointMotion moved = c.motion;
      moved.position[joint] += static_cast<double>(step);
      const std::vector<Place> then = row_.places(moved, 0);
      return std::pair<Vector, Vector>(then[link - 1].at(base), then[link].at(rod));
    };
    const Real slope = test::LinkageReference::slope(
        [&](Real step) {
          const auto [from, to] = pins(step);
          return (to - from).norm();
        },
        0);
    const auto [from, to] = pins(0);
    const Vector push = -torque / slope * (to - from).normalized();
    return {beyond, -torque / slope, {{beyond - 1, base, from, -push}, {beyond, rod, to, push}}};
  }

  /// Returns the load of the part beyond on the part before, from the forces of base and cylinders on the part before
  /// and its motion. `before` selects the points, `isBefore` the pins of the cylinders.
  template <typename Before, typename IsBefore>
  Load fromBefore(const Case& c, const std::vector<Point>& points, Before before, IsBefore isBefore) const {
    const Load all = row_.demanded(row_.points(), c.motion, c.g, [](const Point&) { return true; });
    const Load hammer = tip(c);
    const Load base{all.force - hammer.force, all.moment - hammer.moment};
    Load result = row_.demanded(points, c.motion, c.g, before);
    result.force -= base.force, result.moment -= base.moment;
    for (const CylinderParameters& p : boom_.parameters().cylinders) {
      const Held held = this->held(c, p);
      for (const Pin& pin : held.pins)
        if (isBefore(pin)) result.add(pin.place, -pin.force);
    }
    return result;
  }

  static Wrench seenAt(const Load& load, const Place& place) {
    return {(place.R.transpose() * load.force).cast<double>(),
            (place.R.transpose() * (load.moment - place.p.cross(load.force))).cast<double>()};
  }
  static double difference(const Wrench& a, const Wrench& b) {
    return std::max((a.force - b.force).norm() / 5e4, (a.torque - b.torque).norm() / 1e5);
  }

  Boom boom_;
  Row row_;
};

TEST_F(Steel, SectionsAreTheSameFromEitherSide) {
  // Rotated cuts, uniform bars and cuts on the bracket are included.
  BoomParameters parameters = test::shippedBoomParameters();
  ASSERT_EQ(parameters.sections.size(), 3U);
  parameters.sections.push_back({"turned", "boom_link", {1.0, 0.1, 0.2}, 0.7, {}});
  parameters.sections.push_back({"before_the_pins", "arm_link", {0.2, 0.0, 0.0}, -0.3, {}});
  parameters.sections.push_back({"bracket", "hammer_link", {0.05, 0.0, -0.2}, 1.4, {}});
  const Checked<Boom> made = Boom::make(test::shippedUrdf(), parameters);
  ASSERT_TRUE(made.value) << made.problems.front();
  EXPECT_EQ(made.notes.size(), 3U);
  boom_ = *made.value;
  std::mt19937 random(31);
  double worst = 0.0;
  for (int i = 0; i < 40; ++i) {
    const Case c = randomCase(boom_.chain(), random);
    boom_.move(c.motion, c.g);
    SteelLoads loads;
    ASSERT_TRUE(boom_.steelLoads(c.w, true, loads));
    for (std::size_t k = 0; k < boom_.sections().size(); ++k) {
      const Section& section = boom_.sections()[k];
      const SectionParameters& p = section.parameters();
      const int link = row_.link(p.link);
      const Matrix turn = Eigen::AngleAxis<Real>(p.pitch, Vector::UnitY()).toRotationMatrix();
      const auto x = [&](const Vector& point) { return turn.col(0).dot(point - p.origin.cast<Real>()); };
      std::vector<Point> points = row_.points();
      Row::addBody(link, section.part(), -1.0, points);
      const Load load = fromBefore(
          c, points, [&](const Point& point) { return point.link <= link; },
          [&](const Pin& pin) { return pin.link < link || (pin.link == link && !(x(pin.on_link) > 0)); });
      Place place = row_.places(c.motion, 0)[static_cast<std::size_t>(link)];
      place.p = place.at(p.origin.cast<Real>());
      place.R = place.R * turn;
      const double error = difference(loads.section[k], seenAt(load, place));
      EXPECT_LT(error, 1e-9) << p.name;
      worst = std::max(worst, error);
    }
  }
  RecordProperty("worst", format("%.2g", worst));
}

TEST_F(Steel, JointReactionsAreTheSameFromEitherSide) {
  std::mt19937 random(32);
  double worst = 0.0, worst_moment = 0.0;
  for (int i = 0; i < 40; ++i) {
    const Case c = randomCase(boom_.chain(), random);
    boom_.move(c.motion, c.g);
    SteelLoads loads;
    BoomLoads torques;
    ASSERT_TRUE(boom_.steelLoads(c.w, true, loads));
    boom_.loads(c.w, true, torques);
    for (int j = 0; j < 4; ++j) {
      const int beyond = boom_.chain().linkBeyond(j);
      const Load load = fromBefore(
          c, row_.points(), [&](const Point& point) { return point.link < beyond; },
          [&](const Pin& pin) { return pin.link < beyond; });
      Place place = row_.places(c.motion, 0)[static_cast<std::size_t>(beyond) - 1];
      place.p = place.at(boom_.chain().link(beyond).origin.cast<Real>());
      const Wrench& reaction = loads.joint[static_cast<std::size_t>(j)];
      worst = std::max(worst, difference(reaction, seenAt(load, place)));
      const double about_axis = reaction.torque.dot(boom_.chain().link(beyond).axis);
      const double expected = j == 0 ? torques.total[0] : 0.0;  // swing is held, the others have cylinders
      worst_moment = std::max(worst_moment, std::abs(about_axis - expected) / 1e5);
    }
  }
  RecordProperty("worst", format("%.2g", worst));
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(worst_moment, 1e-13);
}

TEST_F(Steel, PinsCarryTheCylindersForce) {
  std::mt19937 random(33);
  for (int i = 0; i < 40; ++i) {
    const Case c = randomCase(boom_.chain(), random);
    boom_.move(c.motion, c.g);
    SteelLoads loads;
    BoomLoads torques;
    boom_.steelLoads(c.w, true, loads);
    boom_.loads(c.w, true, torques);
    for (std::size_t k = 0; k < 3; ++k) {
      const Held held = this->held(c, boom_.parameters().cylinders[k]);
      const std::vector<Place> places = row_.places(c.motion, 0);
      const auto expectAs = [&](const Eigen::Vector3d& got, const Pin& pin) {
        const Matrix& axes = places[static_cast<std::size_t>(pin.link)].R;
        const Eigen::Vector3d want = (axes.transpose() * pin.force).cast<double>();
        EXPECT_LT((got - want).norm(), 1e-9 * (want.norm() + 1e4));
      };
      expectAs(loads.pins[k].base, held.pins.front());
      expectAs(loads.pins[k].rod, held.pins.back());
      if (held.pins.size() == 3)
        expectAs(loads.pins[k].guide, held.pins[1]);
      else
        EXPECT_TRUE(loads.pins[k].guide.isZero(0.0));
      EXPECT_NEAR(loads.pins[k].base.norm(), std::abs(torques.cylinder[k].force),
                  1e-9 * (loads.pins[k].base.norm() + 1e4));
    }
  }
}

TEST_F(Steel, VibrationCountsAsWhatItAccelerates) {
  const JointVector zero = JointVector::Zero(4);
  boom_.moveCompliant({test::workingPosition(), zero, zero}, {0.0, 0.0, -kGravity});
  const Wrench w{Eigen::Vector3d(1e3, 50.0, 8e3), Eigen::Vector3d(20.0, -700.0, 30.0)};
  const JointVector torque = boom_.hammerTorque(w);
  for (int i = 0; i < 30; ++i) boom_.vibration().advance(1e-3, {torque, torque, torque});
  BoomLoads torques;
  SteelLoads loads;
  ASSERT_TRUE(boom_.loads(w, false, torques));
  ASSERT_TRUE(boom_.steelLoads(w, false, loads));
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(loads.pins[k].base.norm(), std::abs(torques.cylinder[k].force), 1e-9 * loads.pins[k].base.norm());
  EXPECT_NEAR(loads.joint[0].torque.z(), torques.total[0], 1e-8);
  // A rigid boom whose joints make this motion has equal section loads.
  Boom driven = test::shippedBoom();
  driven.move({test::workingPosition(), boom_.vibration().velocity(), boom_.vibration().acceleration()},
              {0.0, 0.0, -kGravity});
  SteelLoads expected;
  driven.steelLoads(w, true, expected);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(difference(loads.section[k], expected.section[k]), 1e-14);
  // The vibration's effect is not negligible.
  driven.move({test::workingPosition(), zero, zero}, {0.0, 0.0, -kGravity});
  driven.steelLoads(w, true, expected);
  EXPECT_GT(std::abs(loads.section[0].torque.y() - expected.section[0].torque.y()), 500.0);
}

}  // namespace
}  // namespace hammer_loads
