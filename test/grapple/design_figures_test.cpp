#include "hammer_loads/grapple/design_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "grapple/grapples.h"
#include "hammer_loads/grapple/grapple_table.h"

namespace hammer_loads {
namespace {

DesignFigures figuresOf(const GrappleParameters& p) {
  return designFigures(test::grappleOf(p), p.slider_closed, p.slider_open);
}

/// Evaluates the definitions literally on a fine polyline.
struct Polyline {
  std::vector<double> arc, y;
  explicit Polyline(const GrappleParameters& p, int points = 40000) {
    const Grapple grapple = test::grappleOf(p);
    GrappleMotion before = *grapple.at(p.slider_closed);
    arc.push_back(0.0);
    y.push_back(before.p.im);
    for (int i = 1; i < points; ++i) {
      const GrappleMotion m = *grapple.at(p.slider_closed + (p.slider_open - p.slider_closed) * i / (points - 1));
      arc.push_back(arc.back() + norm(m.p - before.p));
      y.push_back(m.p.im);
      before = m;
    }
  }
  std::size_t end(double share) const {
    return static_cast<std::size_t>(std::lower_bound(arc.begin(), arc.end(), share * arc.back()) - arc.begin());
  }
  double low(std::size_t end) const { return *std::min_element(y.begin(), y.begin() + static_cast<long>(end) + 1); }
  double high(std::size_t end) const { return *std::max_element(y.begin(), y.begin() + static_cast<long>(end) + 1); }
  double deviation(std::size_t end) const { return 0.5 * (high(end) - low(end)) / arc[end]; }
};

TEST(DesignFigures, FollowTheirDefinitions) {
  for (const GrappleParameters& p : {test::claimsParameters(), test::straightParameters()}) {
    const DesignFigures f = figuresOf(p);
    const Polyline path(p);
    const std::size_t end = path.end(0.8), last = path.y.size() - 1;
    EXPECT_NEAR(f.path_length, path.arc.back(), 1e-8);
    EXPECT_NEAR(f.line_height, 0.5 * (path.low(end) + path.high(end)), 5e-6);  // tolerance: the polyline's step
    EXPECT_NEAR(f.scoop_height, path.y[last] - f.line_height, 1e-12);
    EXPECT_NEAR(f.deviation_first_80, path.deviation(end), 1e-6);
    EXPECT_NEAR(f.deviation_whole, path.deviation(last), 1e-8);
    for (const auto& [share, tolerance] : {std::pair{f.straight_share_band, 0.015}, {f.straight_share_off, 0.03}}) {
      EXPECT_LE(path.deviation(std::min(path.end(share), last)), tolerance + 1e-5);
      if (share < 0.99) {
        EXPECT_GT(path.deviation(path.end(share + 0.005)), tolerance);
      }
    }
  }
}

TEST(DesignFigures, ClaimsSetReproducesWhatCanBeReproduced) {
  const DesignFigures f = figuresOf(test::claimsParameters());
  EXPECT_NEAR(f.scoop_height, 0.070, 0.001);                 // h = 70 mm: the set was fitted to it
  EXPECT_NEAR(f.deviation_first_80, 0.0106, 5e-5);           // 80 % of the path within +-1.06 % of its length
  EXPECT_NEAR(f.deviation_whole, 0.022, 5e-4);               // < 3 % even over the whole path
  EXPECT_NEAR(f.scoop_height / f.path_length, 0.035, 5e-4);  // above 3 % as distance from the line of the 80 %
  EXPECT_GT(f.straight_share_band, 0.8);                     // a band of 3 % holds more than the claimed 80 %
  EXPECT_EQ(f.straight_share_off, 1.0);
  EXPECT_NEAR(f.opening, 4.0067, 1e-4);  // 4 m, not 200 mm
  EXPECT_NEAR(f.least_transmission.value * 180.0 / kPi, 46.0, 0.5);
  EXPECT_NEAR(f.most_transmission.value * 180.0 / kPi, 117.0, 0.5);
  EXPECT_NEAR(f.least_determinant.value, 0.092, 5e-4);
  EXPECT_EQ(f.least_determinant.slider, 0.656);
}

TEST(DesignFigures, StraightSetIsStraighterButDropsAtTheOpenEnd) {
  const GrappleParameters p = test::straightParameters();
  const DesignFigures f = figuresOf(p);
  EXPECT_NEAR(f.deviation_first_80, 0.0035, 5e-5);
  EXPECT_NEAR(2.0 * f.deviation_whole, 0.025, 5e-4);
  EXPECT_LT(f.scoop_height, 0.0);
  const Grapple grapple = test::grappleOf(p);
  EXPECT_NEAR(grapple.at(p.slider_closed)->p.im - grapple.at(p.slider_open)->p.im, 0.036, 5e-4);
  // +-0.13 % over one metre
  double low = 0.0, high = -10.0;
  for (double x = 0.0; x <= 1.0; x += 0.001) {
    const double y = grapple.at(*sliderForOpening(grapple, 2.0 * x).value)->p.im;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  EXPECT_NEAR(0.5 * (high - low), 0.0013, 5e-5);
}

TEST(DesignFigures, NoStretchOf200MillimetresRises70Millimetres) {
  // The paper states L = 200 mm with h = 70 mm. Neither set has this anywhere on its path, whether L is meant per jaw
  // or for both.
  for (const GrappleParameters& p : {test::claimsParameters(), test::straightParameters()}) {
    const Grapple grapple = test::grappleOf(p);
    for (const double extent : {0.1, 0.2}) {
      double most = 0.0;
      const double widest = grapple.at(p.slider_open)->p.re;
      for (double x = 0.0; x + extent < widest; x += 0.01) {
        double low = 0.0, high = -10.0;
        for (int i = 0; i <= 40; ++i) {
          const double y = grapple.at(*sliderForOpening(grapple, 2.0 * (x + extent * i / 40.0)).value)->p.im;
          low = std::min(low, y);
          high = std::max(high, y);
        }
        most = std::max(most, high - low);
      }
      EXPECT_LT(most, 0.040) << extent;
    }
  }
}

TEST(SliderForOpening, InvertsThePath) {
  for (const GrappleParameters& p : {test::claimsParameters(), test::straightParameters()}) {
    const Grapple grapple = test::grappleOf(p);
    test::Random random(61);
    for (int i = 0; i < 500; ++i) {
      const double slider = p.slider_closed + (p.slider_open - p.slider_closed) * random(0.0, 1.0);
      const Checked<double> found = sliderForOpening(grapple, 2.0 * grapple.at(slider)->p.re);
      ASSERT_TRUE(found.value);
      EXPECT_NEAR(*found.value, slider, 1e-14);
    }
    EXPECT_NEAR(*sliderForOpening(grapple, 2.0 * grapple.at(p.slider_open)->p.re).value, p.slider_open, 1e-14);
    EXPECT_NEAR(sliderForOpening(grapple, 0.0).value.value(), p.slider_closed, 1e-14) << "whatever its rounding";
  }
}

TEST(SliderForOpening, NamesTheReachableOpenings) {
  const Grapple grapple = test::grappleOf(test::claimsParameters());
  for (const double opening : {-0.1, 4.1, std::nan("")}) {
    const Checked<double> none = sliderForOpening(grapple, opening);
    EXPECT_FALSE(none.value);
    ASSERT_EQ(none.problems.size(), 1u);
    EXPECT_NE(none.problems[0].find("must lie between 0.000000000 m (closed) and 4.006659937 m (open)"),
              std::string::npos)
        << none.problems[0];
  }
}

TEST(GrappleTable, HasTheContractsColumnsAndEveryDigit) {
  const Grapple grapple = test::grappleOf(test::claimsParameters());
  std::ostringstream out;
  TableRequest request;
  request.from = 0.008;
  request.to = 0.656;
  request.steps = 40;
  EXPECT_FALSE(printTable(grapple, request, out));
  std::istringstream lines(out.str());
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "s_m,x_m,y_m,dx_ds,dy_ds,d2x_ds2,d2y_ds2");
  int rows = 0;
  double x = 0.0;
  for (; std::getline(lines, line); ++rows) {
    double slider = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,", &slider, &x), 2);
    EXPECT_NEAR(x, grapple.at(slider)->p.re, 1e-14);
  }
  EXPECT_EQ(rows, 41);
  EXPECT_NEAR(x, 2.00332996839681, 1e-12);
}

TEST(GrappleTable, NamesTheOptionThatPassesALimit) {
  const Grapple grapple = test::grappleOf(test::claimsParameters());
  std::ostringstream out;
  TableRequest request;
  request.from = -0.26;  // outside the stroke, but a regular pose
  request.to = 0.74;
  request.steps = 10;
  EXPECT_EQ(printTable(grapple, request, out).value_or(""),
            "--to: 0.74 m, across fold: must lie between the dead centre at -0.27 m and the fold at 0.7331923934967 m");
  EXPECT_TRUE(out.str().empty());
  request.to = 0.733;
  EXPECT_FALSE(printTable(grapple, request, out));
}

TEST(GrappleTable, SummaryAndOpening) {
  const Grapple grapple = test::grappleOf(test::claimsParameters());
  std::ostringstream summary, row;
  TableRequest request;
  request.summary = true;
  EXPECT_FALSE(printTable(grapple, request, summary));
  for (const char* line :
       {"slider_open_m: 0.656\n", "scoop_height_m: 0.070706", "straight_share_within_3pct: 1\n",
        "lower_limit_kind: dead centre\n", "upper_limit_m: 0.733192393497\n", "upper_limit_kind: fold\n"})
    EXPECT_NE(summary.str().find(line), std::string::npos) << line << summary.str();
  TableRequest inverse;
  inverse.opening = 0.2;
  EXPECT_FALSE(printTable(grapple, inverse, row));
  const std::string text = row.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
  EXPECT_NE(text.find("0.0461141485819"), std::string::npos) << text;
}

}  // namespace
}  // namespace hammer_loads
