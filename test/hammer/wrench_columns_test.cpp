// Effect of the hammer's constants on the loads, compared with the loads of hammers with slightly changed constants.
#include <gtest/gtest.h>

#include <random>

#include "hammer_loads/hammer/hull_model.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kRounding = 1e-6;  // of single precision

/// Returns a hammer whose constants are all uncertain, including those that are 0 or usually exact.
HammerParameters uncertain(double drive_reaction_ratio) {
  HammerParameters p = test::mo100LinkageParameters();
  p.drive_reaction_ratio = drive_reaction_ratio;
  p.deviations = usualDeviations(p);
  for (double& deviation : p.deviations)
    if (!(deviation > 0.0)) deviation = 2e-3;
  return p;
}

/// Returns the hammer with one changed constant and a rod that closes the linkage.
Mechanism beside(HammerParameters p, const std::string& key, double by) {
  for (const HammerConstant& constant : kHammerConstants)
    if (constant.key == key) constant.field(p) += by;
  p.lengths.rod = p.lengths.pivot_distance + p.lengths.rocker - p.lengths.crank;
  return test::mechanismOf(p);
}

/// Returns the standard deviation of a constant with the sign of the step that the columns take.
double deviationOf(const HammerParameters& p, const std::string& key) {
  for (std::size_t i = 0; i < kHammerConstants.size(); ++i)
    if (kHammerConstants[i].key == key) return kHammerConstants[i].away * p.deviations[i];
  return 0.0;
}

/// Returns the effect of one standard deviation from a hammer at kStep of it. load: load of a hammer at a level.
template <typename Load>
Eigen::Vector3d columnOf(const Mechanism& mechanism, Level level, const std::string& name, const Load& load) {
  if (name.rfind("level", 0) == 0) return load(mechanism, Level::kLinkage) - load(mechanism, level);
  const HammerParameters& p = mechanism.parameters();
  const Mechanism other = beside(p, name, MachineColumn::kStep * deviationOf(p, name));
  return (load(other, level) - load(mechanism, level)) / MachineColumn::kStep;
}

struct Place {
  CrankMotion crank;
  HullMotion hull;
};

std::vector<Place> drawnPlaces() {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  std::vector<Place> places;
  for (int i = 0; i < 40; ++i) {
    Place place;
    place.crank = {CrankAngle::fromOffset(between(-kPi, kPi)), between(-40.0, 40.0), between(-800.0, 800.0)};
    place.hull.gravity = {between(-12.0, 12.0), between(-12.0, 12.0)};
    if (i % 4 != 0) place.hull.rate = between(-3.0, 3.0), place.hull.acceleration = between(-60.0, 60.0);
    places.push_back(place);
  }
  return places;
}

TEST(WrenchColumns, EqualTheLoadsOfTheHammersBesideIt) {
  constexpr double kInertia = 0.7;
  int seen = 0;
  for (const double ratio : {0.0, 0.3, 1.0}) {
    const HammerParameters p = uncertain(ratio);
    const Mechanism mechanism = test::mechanismOf(p);
    for (const Level level : {Level::kPulse, Level::kRocker, Level::kLinkage}) {
      const HullModel model(mechanism, level);
      const WrenchColumns columns(model);
      const std::vector<std::string> names = columns.names();
      for (const Place& at : drawnPlaces()) {
        const WrenchColumns::Matrix found = columns.wrench(kInertia, linksAt(model, at.crank.angle), at.crank, at.hull);
        const auto load = [&](const Mechanism& other, Level of) {
          const HullModel there(other, of);
          return vectorOf(hullWrench(there, driveReaction(there, kInertia), at.crank, at.hull));
        };
        for (std::size_t i = 0; i < names.size(); ++i) {
          if (names[i].rfind("striking", 0) == 0) continue;
          const Eigen::Vector3d truth = columnOf(mechanism, level, names[i], load);
          const Eigen::Vector3d size = found.cast<double>().cwiseAbs().rowwise().maxCoeff();
          for (int row = 0; row < 3; ++row)
            EXPECT_NEAR(found(row, static_cast<Eigen::Index>(i)), truth[row], kRounding * size[row])
                << names[i] << ", row " << row << ", level " << static_cast<int>(level) << ", ratio " << ratio;
          ++seen;
        }
      }
    }
  }
  EXPECT_GT(seen, 3 * 3 * 40 * 12);
}

TEST(WrenchColumns, EqualTheLoadsOnTheShaftOfTheHammersBesideIt) {
  const HammerParameters p = uncertain(1.0);
  const Mechanism mechanism = test::mechanismOf(p);
  for (const Level level : {Level::kRocker, Level::kLinkage}) {
    const MachineColumns columns(mechanism, level);
    for (const Place& at : drawnPlaces()) {
      const HullMotion hull{at.hull.gravity, 0.0, 0.0};
      const MachineColumns::OnShaft found = columns.onShaft(at.crank.angle, hull.gravity);
      const auto load = [&](const Mechanism& other, Level of) {
        const ShaftLoad l = shaftLoad(other, of, at.crank.angle, hull);
        return Eigen::Vector3d(l.inertia, l.half_inertia_slope, l.weight_torque);
      };
      for (std::size_t i = 0; i < columns.columns().size(); ++i) {
        const std::string& name = columns.columns()[i].name;
        if (columns.columns()[i].enters == HammerConstant::Enters::kBlow) continue;
        const Eigen::Vector3d truth = columnOf(mechanism, level, name, load);
        const Eigen::Vector3d size = found.cast<double>().cwiseAbs().rowwise().maxCoeff();
        for (int row = 0; row < 3; ++row)
          EXPECT_NEAR(found(row, static_cast<Eigen::Index>(i)), truth[row], kRounding * size[row])
              << name << ", row " << row << ", level " << static_cast<int>(level);
      }
    }
  }
}

TEST(WrenchColumns, AreWithinAHundredthOfTheLargestFromATable) {
  HammerParameters p = test::mo100LinkageParameters();
  p.deviations = usualDeviations(p);
  const Mechanism mechanism = test::mechanismOf(p);
  for (const Level level : {Level::kRocker, Level::kLinkage}) {
    const HullModel model(mechanism, level);
    const WrenchColumns exact(model);
    WrenchColumns table(model);
    table.tabulate();
    WrenchColumns::Matrix worst = WrenchColumns::Matrix::Zero(), largest = worst;
    for (double offset = -3.14; offset < 3.14; offset += 1.3e-3) {
      const CrankMotion crank{CrankAngle::fromOffset(offset), 31.0, 400.0 * std::sin(3.0 * offset)};
      const HullMotion hull{{2.0, -9.0}, 0.0, 0.0};
      const LinksAtAngle at = linksAt(model, crank.angle);
      const WrenchColumns::Matrix truth = exact.wrench(0.7, at, crank, hull);
      worst = worst.cwiseMax((table.wrench(0.7, at, crank, hull) - truth).cwiseAbs());
      largest = largest.cwiseMax(truth.cwiseAbs());
      const HullMotion turns{hull.gravity, 0.5, 3.0};  // not covered by the table
      EXPECT_EQ(table.wrench(0.7, at, crank, turns), exact.wrench(0.7, at, crank, turns));
    }
    EXPECT_TRUE((worst.array() <= 0.01F * largest.array()).all()) << worst << "\n\n" << largest;
    EXPECT_GT(worst.sum(), 0.0);  // not exact between its points
  }
}

}  // namespace
}  // namespace hammer_loads
