// Checks the shares of a budget by Monte Carlo (JCGM 101). Many hammers, drawn from the file's standard deviations,
// play one recording. The effect of a constant on a figure is the slope of the figure over the draws of that constant.
#include "hammer_loads/pipeline/budget.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/util/functions.h"
#include "pipeline/shipped_machine.h"
#include "support/exact_hammer.h"
#include "support/held_hull.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace budget {
namespace {

constexpr double kEver = std::numeric_limits<double>::infinity();
constexpr Eigen::Index kHammers = 250;
constexpr auto kConstants = static_cast<Eigen::Index>(kHammerConstants.size());

using Draw = Eigen::Matrix<double, 1, kConstants>;

/// Returns draws in standard deviations. The limit of -1.9 keeps a mass positive if its deviation is half of it.
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

constexpr double kZeroIsKnown = 3.0;  // [s]; before, the zero's prior adds to the deviations, but to no drawn hammer
constexpr const char* kRange = "equivalent range of Fz";

/// Results of one hammer on the recording.
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

/// Returns the relative error of the range, as counted for the life of the hull.
double rangeError(const Work& drawn, const Work& right) {
  accuracy::LifeError error;
  for (std::size_t i = 0; i < right.force_z.size(); ++i)
    if (std::isfinite(drawn.force_z[i]) && std::isfinite(right.force_z[i]))
      error.add(drawn.force_z[i], right.force_z[i]);
  return error.figure().error;
}

/// Returns the effect of one standard deviation of each constant on each figure, as the linear part of a fit. Squares
/// are fitted as well, and the product of the rod's mass and centre, whose deviations are half of their values.
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
  parameters.rod_std = {};  // the recorded rod is rigid, and no draw has an elastic one
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
    // The deviation of a restitution, some thousandths, is a small difference of two speeds.
    EXPECT_NEAR(figure->deviation, of_draws.norm(), (quantity == "blow/restitution" ? 0.25 : 0.05) * of_draws.norm())
        << quantity;
    if (quantity == "blow/restitution") continue;
    for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
      const double share = of_draws.cwiseAbs2()[static_cast<Eigen::Index>(i)] / of_draws.squaredNorm();
      double stated = 0.0;
      for (const BudgetFigure::Source& source : figure->sources)
        if (source.name == kHammerConstants[i].key) stated = source.variance / (figure->deviation * figure->deviation);
      compared += share > 0.1;
      EXPECT_NEAR(stated, share, share > 0.1 ? 0.1 * share : 0.03) << quantity << ' ' << kHammerConstants[i].key;
    }
  }
  EXPECT_GE(compared, 15);
}

/// Returns the figures of a run with a machine of the nominal parameters.
std::map<std::string, BudgetFigure> figuresOf(const Settings& settings) {
  simulation::MachineSettings machine = test::shippedMachine(settings, 10.0, 77);
  machine.level = Level::kLinkage;
  machine.crank.drop_outs.clear();
  const simulation::Session session = simulation::recordSession(machine);
  accuracy::SessionPlayer player(settings.mechanism, settings.pipeline, {}, session);
  BudgetRecorder budget(player.pipeline);
  EXPECT_TRUE(budget.figures().empty() && budget.ofRange(1).empty());
  player.playTo(kEver, [&](double, const SampleResult&) { budget.follow(); });
  std::map<std::string, BudgetFigure> figures;
  for (const BudgetFigure& figure : budget.figures()) figures[figure.quantity] = figure;
  return figures;
}

double variance(const BudgetFigure& figure, const std::string& source) {
  for (const BudgetFigure::Source& s : figure.sources)
    if (s.name == source) return s.variance;
  return 0.0;
}

/// The shipped file gives no rod stiffness. A possible vibration adds its share to blow and pulse with any readings.
TEST(Budget, ARodThatNoFileGivesIsNoReading) {
  Settings shipped = test::heldHull(*load(configDirectory(), {}).value);
  shipped.pipeline.level = Level::kLinkage;
  const auto figures = figuresOf(shipped);
  for (const char* name : {"blow/restitution", "blow/energy", "pulse/turn_impulse_z"}) {
    const BudgetFigure& figure = figures.at(name);
    EXPECT_GT(variance(figure, "rod_stiffness_N_m"), 5.0 * variance(figure, "readings")) << name;
    double all = 0.0;
    for (const BudgetFigure::Source& source : figure.sources) all += source.variance;
    EXPECT_NEAR(all, square(figure.deviation), 1e-9 * all) << name;
  }
  for (const auto& [name, figure] : figuresOf(test::withExactHammer(shipped))) {
    EXPECT_EQ(variance(figure, "rod_stiffness_N_m"), 0.0) << name;
    EXPECT_GT(variance(figure, "readings"), 0.0) << name;
  }
}

/// Jittering readings of 1024 counts do not show whether the rod vibrates. This uncertainty is most of the range's own
/// deviation, in the budget as in the ledger.
TEST(Budget, RangesReachAsFarAsInTheLedger) {
  Settings shipped = test::heldHull(*load(configDirectory(), {}).value);
  simulation::MachineSettings machine = test::shippedMachine(shipped, 12.0, 78);
  machine.level = Level::kLinkage;
  accuracy::makeTypical(machine);
  const simulation::Session session = simulation::recordSession(machine);
  accuracy::SessionPlayer player(shipped.mechanism, shipped.pipeline, {}, session);
  BudgetRecorder budget(player.pipeline);
  life::LifeSettings counted;
  counted.channels = {{"hull_wrench/force_z", *life::LoadGrid::make(-1e5, 1e5, 4096).value}};
  counted.period = 1;
  LifeFollower follower(player.pipeline, counted);
  player.playTo(kEver, [&](double, const SampleResult&) { budget.follow(), follower.follow(); });
  const life::RangeDeviation ledger = life::rangeDeviation(follower.take().counts[0]);
  double readings = 0.0, rod = 0.0;
  for (const BudgetFigure::Source& source : budget.ofRange(1)) {
    if (source.name == "readings") readings = source.variance;
    if (source.name == "rod_stiffness_N_m") rod = source.variance;
  }
  EXPECT_GT(ledger.own, 0.2);
  EXPECT_NEAR(std::sqrt(readings + rod), ledger.own, 0.1 * ledger.own);
  EXPECT_GT(rod, 10.0 * readings);
}

}  // namespace
}  // namespace budget
}  // namespace hammer_loads
