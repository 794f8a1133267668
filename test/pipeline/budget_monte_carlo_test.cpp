// Shares of a budget against Monte Carlo (JCGM 101): one recording, worked by many hammers drawn from the file's
// deviations. What each constant does to a figure is the slope of the figures over its draws.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "hammer_loads/bench/life_error.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/pipeline/budget.h"
#include "pipeline/shipped_machine.h"
#include "support/held_hull.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace monte_carlo {
namespace {

constexpr double kEver = std::numeric_limits<double>::infinity();
constexpr Eigen::Index kHammers = 400;
constexpr auto kConstants = static_cast<Eigen::Index>(kHammerConstants.size());

using Draw = Eigen::Matrix<double, 1, kConstants>;
using Figures = std::map<std::string, double>;

/// Of standard deviations; half a mass is 2 of them.
Draw drawn(simulation::NormalNoise& noise) {
  Draw draw;
  for (Eigen::Index i = 0; i < draw.size(); ++i) draw[i] = std::clamp(noise(), -1.9, 3.0);
  return draw;
}

HammerParameters off(HammerParameters p, const Draw& draw) {
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i)
    kHammerConstants[i].field(p) += p.deviations[i] * draw[static_cast<Eigen::Index>(i)];
  p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  return p;
}

constexpr double kZeroIsKnown = 3.0;  // [s]; before, its prior is part of the deviations, and no hammer's
constexpr const char* kRange = "equivalent range of Fz";

/// What one hammer makes of the recording.
struct Work {
  std::vector<BudgetFigure> figures;
  std::vector<double> force_z;  ///< NaN where nothing is published
};

Work work(const Settings& settings, const Mechanism& mechanism, const simulation::Session& session) {
  accuracy::SessionPlayer player(mechanism, settings.pipeline, {}, session);
  BudgetRecorder budget(player.pipeline);
  Work work;
  player.playTo(kEver, [&](double time, const SampleResult& loads) {
    if (time > kZeroIsKnown) budget.follow();
    const bool known = loads.isPublished();
    work.force_z.push_back(known ? loads.wrench.force_z : std::numeric_limits<double>::quiet_NaN());
  });
  work.figures = budget.figures();
  BudgetFigure range{kRange, 1.0, 0.0, budget.ofRange(1)};
  for (const BudgetFigure::Source& source : range.sources)
    range.deviation = std::hypot(range.deviation, std::sqrt(source.variance));
  work.figures.push_back(range);
  return work;
}

/// Relative, as the life of the hull counts it.
double rangeError(const Work& drawn, const Work& right) {
  accuracy::LifeError error;
  for (std::size_t i = 0; i < right.force_z.size(); ++i)
    if (std::isfinite(drawn.force_z[i]) && std::isfinite(right.force_z[i]))
      error.add(drawn.force_z[i], right.force_z[i]);
  return error.figure().error;
}

/// What the constants do to each figure, one standard deviation each: the linear part of a fit to its values. Squares
/// and the product of the rod's mass and centre, both known to a half, are fitted beside it.
std::map<std::string, Eigen::VectorXd> slopesOfDraws(const Settings& settings, const simulation::Session& session,
                                                     const Work& right) {
  const HammerParameters drawing = settings.mechanism.parameters();
  constexpr Eigen::Index kTerms = 2 * kConstants + 2;
  Eigen::MatrixXd regressors(kHammers, kTerms);
  std::map<std::string, Eigen::VectorXd> values;
  const auto at = [](const char* key) {
    const auto found = std::find_if(kHammerConstants.begin(), kHammerConstants.end(),
                                    [&](const HammerConstant& c) { return std::string(c.key) == key; });
    return found - kHammerConstants.begin();
  };
  const auto mass = at("rod_mass_kg"), centre = at("rod_com_along_m");
  simulation::NormalNoise noise(4711);
  for (Eigen::Index row = 0; row < kHammers;) {
    const Draw draw = drawn(noise);
    const auto mechanism = Mechanism::make(off(drawing, draw));
    if (!mechanism.value) continue;
    regressors.row(row) << 1.0, draw, draw.cwiseAbs2(), draw[mass] * draw[centre];
    const Work of_draw = work(settings, *mechanism.value, session);
    for (const BudgetFigure& figure : of_draw.figures) {
      const double value = figure.quantity == kRange ? rangeError(of_draw, right) : figure.value;
      values.try_emplace(figure.quantity, Eigen::VectorXd::Zero(kHammers)).first->second[row] = value;
    }
    ++row;
  }
  const Eigen::LDLT<Eigen::MatrixXd> normal(regressors.transpose() * regressors);
  std::map<std::string, Eigen::VectorXd> slopes;
  for (const auto& [quantity, of_draws] : values)
    slopes[quantity] = normal.solve(regressors.transpose() * of_draws).segment(1, kConstants);
  return slopes;
}

TEST(BudgetMonteCarlo, SharesAreThoseOfDrawnHammers) {
  Settings settings = test::heldHull(*load(configDirectory(), {}).value);
  settings.pipeline.level = Level::kLinkage;
  HammerParameters parameters = settings.mechanism.parameters();
  parameters.rod_std = {};  // the recorded rod is rigid, and draws say nothing of another
  settings.mechanism = test::mechanismOf(parameters);
  simulation::MachineSettings machine = test::shippedMachine(settings, 6.0, 5);
  machine.level = Level::kLinkage;
  machine.crank.drop_outs.clear();
  const simulation::Session session = simulation::recordSession(machine);
  const Work right = work(settings, settings.mechanism, session);
  int compared = 0;
  for (const auto& [quantity, of_draws] : slopesOfDraws(settings, session, right)) {
    const auto figure = std::find_if(right.figures.begin(), right.figures.end(),
                                     [name = quantity](const BudgetFigure& f) { return f.quantity == name; });
    ASSERT_NE(figure, right.figures.end());
    // A restitution's few thousandths are what is left of two speeds.
    EXPECT_NEAR(figure->deviation, of_draws.norm(), (quantity == "blow/restitution" ? 0.25 : 0.05) * of_draws.norm())
        << quantity;
    if (quantity == "blow/restitution") continue;
    for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
      const double share = of_draws.cwiseAbs2()[static_cast<Eigen::Index>(i)] / of_draws.squaredNorm();
      double said = 0.0;
      for (const BudgetFigure::Source& source : figure->sources)
        if (source.name == kHammerConstants[i].key) said = source.variance / (figure->deviation * figure->deviation);
      compared += share > 0.1;
      EXPECT_NEAR(said, share, share > 0.1 ? 0.1 * share : 0.03) << quantity << ' ' << kHammerConstants[i].key;
    }
  }
  EXPECT_GE(compared, 15);
}

}  // namespace
}  // namespace monte_carlo
}  // namespace hammer_loads
