// Shares of a budget against machines that are one constant off (JCGM 101: draws, here of one source at a time).
#include "hammer_loads/pipeline/budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/util/square.h"
#include "pipeline/shipped_machine.h"
#include "support/exact_hammer.h"
#include "support/held_hull.h"

namespace hammer_loads {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The shipped hammer with deviations of these constants alone, as parts of them.
Settings drawing(const std::map<std::string, double>& known) {
  Settings settings = test::heldHull(*load(configDirectory(), {}).value);
  HammerParameters p = settings.mechanism.parameters();
  p.deviations = {};
  p.rod_std = {};
  p.crank_mass = p.crank_inertia_about_com = p.rod_mass = p.rod_inertia_about_com = 0.0;
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i) {
    const auto found = known.find(kHammerConstants[i].key);
    if (found != known.end()) p.deviations[i] = found->second * kHammerConstants[i].field(p);
  }
  settings.mechanism = test::mechanismOf(p);
  settings.pipeline.level = Level::kLinkage;
  return settings;
}

/// Follows a run of the drawing's own machine.
template <typename Use>
void follow(const Settings& settings, const Use& use) {
  simulation::MachineSettings machine = test::shippedMachine(settings, 10.0, 77);
  machine.level = Level::kLinkage;
  machine.crank.drop_outs.clear();
  const simulation::Session session = simulation::recordSession(machine);
  accuracy::SessionPlayer player(settings.mechanism, settings.pipeline, {}, session);
  BudgetRecorder budget(player.pipeline);
  EXPECT_TRUE(budget.figures().empty() && budget.ofRange(1).empty());
  player.playTo(kInfinity, [&](double, const SampleResult&) { budget.follow(); });
  use(budget);
}

std::map<std::string, BudgetFigure> figuresOf(const Settings& settings) {
  std::map<std::string, BudgetFigure> figures;
  follow(settings, [&](const BudgetRecorder& budget) {
    for (const BudgetFigure& figure : budget.figures()) figures[figure.quantity] = figure;
  });
  return figures;
}

double variance(const BudgetFigure& figure, const std::string& source) {
  for (const BudgetFigure::Source& s : figure.sources)
    if (s.name == source) return s.variance;
  return 0.0;
}

TEST(Budget, SharesAreSquaresOfWhatConstantsDo) {
  const std::map<std::string, double> known{{"rocker_mass_kg", 0.03}, {"rocker_inertia_about_pivot_kg_m2", 0.03}};
  const auto figures = figuresOf(drawing(known));
  const BudgetFigure& impulse = figures.at("pulse/turn_impulse_z");
  // The impulse of links that swing as they did is first moment times speed: in proportion to the mass, not to the
  // inertia, which is the crank's to know by its own speed.
  const double by_mass = std::sqrt(variance(impulse, "rocker_mass_kg"));
  EXPECT_NEAR(by_mass, 0.03 * std::abs(impulse.value), 0.1 * 0.03 * std::abs(impulse.value));
  EXPECT_LT(std::sqrt(variance(impulse, "rocker_inertia_about_pivot_kg_m2")), 0.2 * by_mass);
  // A blow's energy is that of the rocker's rotation.
  const BudgetFigure& energy = figures.at("blow/energy");
  EXPECT_GT(variance(energy, "rocker_inertia_about_pivot_kg_m2"), variance(energy, "rocker_mass_kg"));
  double all = 0.0;
  for (const BudgetFigure::Source& source : impulse.sources) all += source.variance;
  EXPECT_NEAR(all, impulse.deviation * impulse.deviation, 1e-9 * all);
}

TEST(Budget, AnExactHammerHasNoShare) {
  const auto figures = figuresOf(test::withExactHammer(drawing({})));
  for (const auto& [name, figure] : figures) {
    for (const BudgetFigure::Source& source : figure.sources)
      EXPECT_EQ(source.name.find("rocker_"), std::string::npos) << name << ' ' << source.name;
  }
  EXPECT_EQ(figures.size(), 6U);
}

TEST(Budget, RangesOfTheHullsLoadsHaveThePartOfTheMass) {
  double by_mass = 0.0;
  follow(drawing({{"rocker_mass_kg", 0.03}}), [&](const BudgetRecorder& budget) {
    for (const BudgetFigure::Source& s : budget.ofRange(1)) by_mass += s.name == "rocker_mass_kg" ? s.variance : 0.0;
  });
  EXPECT_NEAR(std::sqrt(by_mass), 0.03, 0.003);
}

/// The shipped file says nothing of the rod: what a ring may do to blow and pulse is its share, whatever the readings.
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

/// Readings of 1024 counts that jitter do not show whether the rod rings: that is most of the range's own deviation, in
/// the budget as in the ledger.
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
  player.playTo(kInfinity, [&](double, const SampleResult&) { budget.follow(), follower.follow(); });
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
}  // namespace hammer_loads
