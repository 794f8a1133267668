/// Properties of random linkages of the grapple's topology: one branch, kept, and correct to 50 digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "grapple/explicit_curve.h"
#include "grapple/grapples.h"
#include "hammer_loads/grapple/slider_drive.h"

namespace hammer_loads {
namespace {

/// Computes theta2 and theta5 over the whole working branch by Newton's method alone, in steps too small to leave the
/// curve. It uses no predictors, signs or polynomials, and the limits only to know where to stop.
class DenseBranch {
 public:
  explicit DenseBranch(const Grapple& grapple) : grapple_(grapple), group_(grapple.parameters()) {
    const GrappleParameters& p = grapple.parameters();
    const double low = grapple.lowerLimit().slider, high = grapple.upperLimit().slider;
    const Angles start{p.reference_slider, p.reference_ab, p.reference_od};
    extend(start, low);
    std::reverse(nodes_.begin(), nodes_.end());
    extend(start, high);
  }

  /// Interpolates linearly between nodes.
  std::pair<double, double> at(double slider) const {
    const auto after = std::lower_bound(nodes_.begin() + 1, nodes_.end() - 1, slider,
                                        [](const Angles& n, double s) { return n.slider < s; });
    const Angles& a = *(after - 1);
    const double part = (slider - a.slider) / (after->slider - a.slider);
    return {a.theta2 + part * (after->theta2 - a.theta2), a.theta5 + part * (after->theta5 - a.theta5)};
  }

  double low() const { return nodes_.front().slider; }
  double high() const { return nodes_.back().slider; }

 private:
  struct Angles {
    double slider, theta2, theta5;
  };

  /// Steps so that no angle moves by more than 0.001 rad; ends beside the limit, where the steps become tiny.
  void extend(Angles here, double limit) {
    const GrappleParameters& p = grapple_.parameters();
    const SliderDrive drive(p);
    double stride = 1e-8 * (limit - here.slider);
    if (nodes_.empty()) nodes_.push_back(here);
    while (std::abs(stride) > 1e-10) {
      const double slider = here.slider + stride;
      const auto motion = drive.at(slider);
      if (!motion) return;
      const Planar a = p.o1 + (p.o1a / p.o1h) * (motion->o1h * direction(-p.ho1a));
      GroupPose pose = group_.pose(a, here.theta2, here.theta5);
      Closure closure;
      const bool closed = group_.solve(a, 10, pose, closure);
      const double moved = std::max(std::abs(pose.theta2 - here.theta2), std::abs(pose.theta5 - here.theta5));
      if (!closed || !(moved < 0.001) || std::abs(slider - limit) >= std::abs(here.slider - limit)) {
        stride *= 0.5;
        continue;
      }
      here = {slider, pose.theta2, pose.theta5};
      nodes_.push_back(here);
      if (moved < 0.0003) stride *= 1.5;
      const double remaining = 0.5 * (limit - here.slider);
      if (std::abs(stride) > std::abs(remaining)) stride = remaining;
    }
  }

  const Grapple& grapple_;
  LeverGroup group_;
  std::vector<Angles> nodes_;
};

using test::apart;

TEST(RandomGrapples, ColdAndWarmStayOnTheBranchWhateverTheJump) {
  test::Random random(41);
  int grapples = 0, samples = 0;
  for (int i = 0; i < 750; ++i) {
    const auto grapple = test::randomGrapple(random);
    if (!grapple) continue;
    ++grapples;
    const DenseBranch dense(*grapple);
    const double width = dense.high() - dense.low();
    std::optional<GrappleMotion> warm = grapple->at(grapple->parameters().reference_slider);
    ASSERT_TRUE(warm);
    for (int j = 0; j < 40; ++j) {
      const double slider = dense.low() + width * random(0.001, 0.999);
      const auto cold = grapple->at(slider);
      warm = grapple->follow(*warm, slider);
      ASSERT_TRUE(cold && warm) << i << ' ' << slider;
      const auto [theta2, theta5] = dense.at(slider);
      ASSERT_LT(std::max(apart(cold->theta2, theta2), apart(cold->theta5, theta5)), 0.003) << i << " cold " << slider;
      ASSERT_LT(std::max(apart(warm->theta2, theta2), apart(warm->theta5, theta5)), 0.003) << i << " warm " << slider;
      ++samples;
    }
  }
  std::printf("%d grapples, %d jumps\n", grapples, samples);
  EXPECT_GT(grapples, 40);
}

TEST(RandomGrapples, EqualTheExplicitCurveToFiftyDigits) {
  test::Random random(42);
  int well_conditioned = 0, checked = 0;
  test::CurveErrors errors;
  for (int i = 0; i < 750; ++i) {
    const auto grapple = test::randomGrapple(random);
    if (!grapple) continue;
    const GrappleParameters& p = grapple->parameters();
    const auto m = grapple->at(p.reference_slider);
    ASSERT_TRUE(m) << i;
    const auto exact = test::exactPoseOf(p, *m);
    ASSERT_TRUE(exact) << i;
    ++checked;
    const double size = std::max({p.ab, p.ac, p.bd, p.ce, p.od, p.oe});
    const double from_limit =
        std::min(m->slider - grapple->lowerLimit().slider, grapple->upperLimit().slider - m->slider);
    if (std::abs(m->determinant) < 1e-2 * std::pow(size, 4) || from_limit < 1e-2) continue;
    ++well_conditioned;
    errors.add(*m, *exact);
  }
  std::printf("%d checked, %d well conditioned: P %.1e, dP/ds %.1e, d2P/ds2 %.1e\n", checked, well_conditioned,
              errors.position, errors.first, errors.second);
  EXPECT_GT(well_conditioned, 25);
  EXPECT_LT(errors.position, 1e-12);
  EXPECT_LT(errors.first, 1e-10);
  EXPECT_LT(errors.second, 1e-8);
}

TEST(RandomGrapples, RefuseEverythingBeyondTheirLimits) {
  test::Random random(44);
  int across_fold = 0, across_dead_centre = 0, out_of_reach = 0;
  for (int i = 0; i < 750; ++i) {
    const auto grapple = test::randomGrapple(random);
    if (!grapple) continue;
    const auto inside = grapple->at(grapple->parameters().reference_slider);
    ASSERT_TRUE(inside);
    for (const auto& [limit, outwards] : {std::pair{grapple->lowerLimit(), -1.0}, {grapple->upperLimit(), 1.0}}) {
      EXPECT_EQ(grapple->judge(limit.slider - outwards * 1e-9), SliderRefusal::kNone) << i;
      for (const double beyond : {0.0, 1e-13, 1e-6, 1e-2, 0.3, 3.0}) {
        const double slider = limit.slider + outwards * beyond;
        const SliderRefusal refusal = grapple->judge(slider);
        EXPECT_NE(refusal, SliderRefusal::kNone);
        EXPECT_FALSE(grapple->at(slider));
        EXPECT_FALSE(grapple->follow(*inside, slider));
        EXPECT_NE(grapple->explain(refusal, slider).find("must"), std::string::npos);
        across_fold += refusal == SliderRefusal::kAcrossFold;
        across_dead_centre += refusal == SliderRefusal::kAcrossDeadCentre;
        out_of_reach += refusal == SliderRefusal::kOutOfReach;
      }
    }
  }
  EXPECT_GT(across_fold, 25);
  EXPECT_GT(across_dead_centre, 1);
  EXPECT_GT(out_of_reach, 25);
}

}  // namespace
}  // namespace hammer_loads
