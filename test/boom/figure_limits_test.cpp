// Figures of no machine are refused: each limit lies where it is said to be, within a factor of 1.25.
#include <gtest/gtest.h>

#include <functional>

#include "boom/booms.h"
#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/boom/section.h"

namespace hammer_loads {
namespace {

using Problems = std::vector<std::string>;

class FigureLimits : public testing::Test {
 protected:
  FigureLimits() : urdf_(test::shippedUrdf()), chain_(*Chain::make(urdf_, {}).value) {}

  /// problems(figure): of whatever is made with it; named: in those of a figure beyond the limit.
  static void expectAbout(double limit, const std::string& named, const std::function<Problems(double)>& problems) {
    const auto isRefused = [&](double figure) {
      for (const std::string& problem : problems(figure))
        if (problem.find(named) != std::string::npos) return true;
      return false;
    };
    EXPECT_FALSE(isRefused(0.8 * limit)) << named;
    EXPECT_TRUE(isRefused(1.25 * limit)) << named;
  }
  /// As above, of a least figure.
  static void expectLeast(double limit, const std::string& named, const std::function<Problems(double)>& problems) {
    expectAbout(1.0 / limit, named, [&problems](double inverse) { return problems(1.0 / inverse); });
  }
  /// Of the first cylinder with another figure.
  std::function<Problems(double)> cylinderWith(double CylinderParameters::*member) const {
    return [this, member](double figure) {
      CylinderParameters p = test::shippedBoomParameters().cylinders.front();
      p.*member = figure;
      return Cylinder::make(p, 1e9, chain_).problems;
    };
  }
  /// Of the description with another text in place of its first `from`.
  std::function<Problems(double)> urdfWith(const std::string& from, const std::string& begin,
                                           const std::string& end) const {
    return [this, from, begin, end](double figure) {
      return Chain::make(test::withFirstReplaced(urdf_, from, begin + format("%.17g", figure) + end), {}).problems;
    };
  }

  const std::string urdf_;
  const Chain chain_;
};

TEST_F(FigureLimits, OfCylinders) {
  expectAbout(1e3, "base_x_m: ", cylinderWith(&CylinderParameters::base_x));
  expectAbout(1e3, "stroke_m: ", cylinderWith(&CylinderParameters::stroke));
  expectLeast(1e-6, "bore_m: ", cylinderWith(&CylinderParameters::bore));
  expectAbout(1e6, "bore_hose_volume_m3: ", cylinderWith(&CylinderParameters::bore_hose_volume));
  expectLeast(1e-12, "rod_hose_volume_m3: ", cylinderWith(&CylinderParameters::rod_hose_volume));
  expectAbout(1e12, "relief_pressure_Pa: ", cylinderWith(&CylinderParameters::relief_pressure));
  expectAbout(0.5, "friction: ", cylinderWith(&CylinderParameters::friction));
  expectAbout(0.5, "joint_zero_rad: ", cylinderWith(&CylinderParameters::joint_zero));
}

TEST_F(FigureLimits, OfSections) {
  SectionParameters given;
  given.name = "cut", given.link = "arm_link";
  expectAbout(1e3, "cut_section_y_m: ", [&](double figure) {
    given.origin.y() = figure;
    return Section::make(given, chain_).problems;
  });
}

TEST_F(FigureLimits, OfWeighedLinks) {
  const auto weighedWith = [this](double WeighedLink::*member) {
    return [this, member](double figure) {
      WeighedLink weighed;
      weighed.name = "arm_link", weighed.mass = 230.0, weighed.inertia = 86.0;
      weighed.*member = figure;
      ChainRequest request;
      request.weighed = {weighed};
      return Chain::make(urdf_, request).problems;
    };
  };
  expectAbout(1e9, "arm_link_mass_kg: ", weighedWith(&WeighedLink::mass));
  expectAbout(1e9, "arm_link_inertia_kg_m2: ", weighedWith(&WeighedLink::inertia));
  expectAbout(1e3, "arm_link_com_x_m: ", weighedWith(&WeighedLink::com_x));
}

TEST_F(FigureLimits, OfDescriptions) {
  expectAbout(1e9, "mass of link arm_link", urdfWith("<mass value=\"230\"/>", "<mass value=\"", "\"/>"));
  expectAbout(1e6, "centre of mass of link arm_link", urdfWith("xyz=\"0.70 0 0.06\"", "xyz=\"", " 0 0\""));
  expectAbout(1e6, "origin of joint hammer_joint", urdfWith("xyz=\"1.70 0 0\"", "xyz=\"", " 0 0\""));
  expectAbout(1e18, "inertia of link arm_link: must be finite", urdfWith("iyy=\"86.03\"", "iyy=\"", "\""));
}

TEST_F(FigureLimits, OfTheModesAngle) {
  expectAbout(0.05, "mode_refresh_angle_rad: ", [this](double figure) {
    BoomParameters p = test::shippedBoomParameters();
    p.vibration.refresh_angle = figure;
    return Boom::make(urdf_, p).problems;
  });
}

}  // namespace
}  // namespace hammer_loads
