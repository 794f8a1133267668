#include "hammer_loads/hammer/batch.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/counting_new.h"
#include "support/mo100.h"
#include "support/newton_euler.h"

namespace hammer_loads {
namespace {

using test::Real;

constexpr Gravity kGravity{2.5, -9.4};
constexpr std::size_t kColumns = 12;

/// Crank states and results in plain arrays.
struct Table {
  std::vector<double> angle, speed, acceleration;
  std::vector<std::vector<double>> out;

  void add(double phi, double w, double e) { angle.push_back(phi), speed.push_back(w), acceleration.push_back(e); }
  std::size_t size() const { return angle.size(); }
  CrankStates states(std::size_t from, std::size_t count) const {
    return {angle.data() + from, speed.data() + from, acceleration.data() + from, count};
  }
  WrenchArrays wrenches(std::size_t from) { return {at(0, from), at(1, from), at(2, from)}; }
  PinArrays pins(std::size_t from) {
    return {at(3, from), at(4, from), at(5, from),  at(6, from), at(7, from),
            at(8, from), at(9, from), at(10, from), at(11, from)};
  }
  double* at(std::size_t column, std::size_t from) { return out[column].data() + from; }
  void compute(const HullModel& model, bool with_pins) {
    out.assign(kColumns, std::vector<double>(size(), -1.0));
    if (with_pins) {
      linkLoads(model, states(0, size()), kGravity, wrenches(0), pins(0));
    } else {
      hullWrenches(model, states(0, size()), kGravity, wrenches(0));
    }
  }
};

Table randomTable(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<> angle(-40.0, 40.0), speed(-60.0, 60.0), acceleration(-2000.0, 2000.0);
  Table table;
  for (std::size_t i = 0; i < count; ++i) table.add(angle(random), speed(random), acceleration(random));
  return table;
}

std::array<double, kColumns> scalarRow(const HullModel& model, const CrankMotion& crank) {
  const HullWrench w = hullWrench(model, crank, kGravity);
  const PinReactions p = pinForces(model.mechanism(), model.level(), crank, kGravity, NearBlow(0.01));
  return {w.force_x,         w.force_z,          w.torque_y,         p.hull_on_crank.x,
          p.hull_on_crank.z, p.crank_on_rod.x,   p.crank_on_rod.z,   p.rod_on_rocker.x,
          p.rod_on_rocker.z, p.hull_on_rocker.x, p.hull_on_rocker.z, p.drive_torque};
}

TEST(Batch, EqualsTheScalarCallAtEveryLevel) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  for (Level level : {Level::kPulse, Level::kRocker, Level::kLinkage}) {
    const HullModel model(mechanism, level);
    for (bool with_pins : {false, true}) {
      if (with_pins && level == Level::kPulse) continue;
      Table table = randomTable(1001, 81);
      table.compute(model, with_pins);
      for (std::size_t i = 0; i < table.size(); ++i) {
        const CrankMotion crank{CrankAngle::fromAngle(table.angle[i]), table.speed[i], table.acceleration[i]};
        const std::array<double, kColumns> right = scalarRow(model, crank);
        for (std::size_t c = 0; c < (with_pins ? kColumns : 3); ++c) {
          // The tolerance follows the state's own forces, which may grow next to the blow.
          const double size = 1e4 + std::abs(right[c]) + (c < 3 ? 0.0 : std::abs(right[7]));
          EXPECT_NEAR(table.out[c][i], right[c], 1e-13 * size) << i << " column " << c;
        }
      }
    }
  }
}

TEST(Batch, DoesNotDependOnTheCut) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  std::mt19937 random(82);
  for (Level level : {Level::kPulse, Level::kRocker, Level::kLinkage}) {
    const HullModel model(mechanism, level);
    Table whole = randomTable(1000, 83), parts = whole;
    whole.compute(model, true);
    for (int trial = 0; trial < 20; ++trial) {
      parts.out.assign(kColumns, std::vector<double>(parts.size(), 0.0));
      for (std::size_t from = 0; from < parts.size();) {
        const std::size_t count = std::min<std::size_t>(parts.size() - from, 1 + random() % (trial < 5 ? 7 : 200));
        linkLoads(model, parts.states(from, count), kGravity, parts.wrenches(from), parts.pins(from));
        from += count;
      }
      EXPECT_EQ(parts.out, whole.out) << "bit for bit";
    }
  }
}

TEST(Batch, WritesExactlyTheGivenStates) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const HullModel model(mechanism, Level::kRocker);
  for (std::size_t count : {0u, 1u, 3u, 63u, 64u, 65u, 130u}) {
    Table table = randomTable(200, 84);
    table.out.assign(kColumns, std::vector<double>(200, -7.0));
    linkLoads(model, table.states(5, count), kGravity, table.wrenches(5), table.pins(5));
    for (const std::vector<double>& column : table.out) {
      EXPECT_EQ(column[4], -7.0);
      EXPECT_EQ(column[5 + count], -7.0);
      if (count > 0) {
        EXPECT_NE(column[5], -7.0);
        EXPECT_NE(column[4 + count], -7.0);
      }
    }
  }
}

double relativeError(double x, double z, const test::Vector& exact) {
  const test::Vector miss{Real(x) - exact.x, Real(z) - exact.y};
  return static_cast<double>(sqrt(dot(miss, miss) / dot(exact, exact)));
}

TEST(Batch, LosesDigitsOnlyAsThePivotsComeNearTheCranksLength) {
  for (const auto& [pivot_distance, batch_bound] :
       {std::pair{1.5, 2e-14}, std::pair{1.1, 5e-14}, std::pair{1.02, 2e-13}}) {
    HammerParameters p = test::mo100LinkageParameters();
    p.lengths = {0.048, 0.048 * (pivot_distance + 1.5), 0.120, 0.048 * pivot_distance};
    const Mechanism mechanism = test::mechanismOf(p);
    const HullModel model(mechanism, Level::kLinkage);
    const test::NewtonEuler exact(p, Level::kLinkage);
    Table table;
    for (int decade = 1; decade <= 12; ++decade) {
      for (double sign : {-1.3, 1.3}) table.add(sign * std::pow(10.0, -decade), 30.0, 0.0);
    }
    table.compute(model, false);
    for (std::size_t k = 0; k < table.size(); ++k) {
      const CrankMotion crank{CrankAngle::fromAngle(table.angle[k]), 30.0, 0.0};
      const test::Reference right = exact.at(crank.angle, 30.0, 0.0, kGravity);
      const HullWrench scalar = hullWrench(model, crank, kGravity);
      EXPECT_LE(relativeError(table.out[0][k], table.out[1][k], right.hull_force), batch_bound) << pivot_distance;
      EXPECT_LE(relativeError(scalar.force_x, scalar.force_z, right.hull_force), 1e-14) << pivot_distance;
    }
  }
}

TEST(Batch, TakesAnyWinding) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const HullModel model(mechanism, Level::kRocker);
  Table table;
  for (double turns : {-1e7, -1e3, -3.0, -1.0, 0.0, 1.0, 2.0, 1e3, 1e7}) {
    for (double offset : {-3.0, -0.3, -1e-9, 1e-9, 0.2, 3.1}) table.add(turns * 2.0 * kPi + offset, 25.0, 100.0);
  }
  table.compute(model, false);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const HullWrench right = hullWrench(model, {CrankAngle::fromAngle(table.angle[i]), 25.0, 100.0}, kGravity);
    EXPECT_NEAR(table.out[0][i], right.force_x, 1e-13 * 4e4) << table.angle[i];
    EXPECT_NEAR(table.out[1][i], right.force_z, 1e-13 * 4e4) << table.angle[i];
  }
}

TEST(Batch, CountsTheBlowItselfAsAfterIt) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const HullModel model(mechanism, Level::kRocker);
  Table table;
  table.add(0.0, 30.0, 0.0);
  table.add(-0.0, 30.0, 0.0);
  table.add(-1e-300, 30.0, 0.0);
  table.compute(model, false);
  const double after = hullWrench(model, {{0.0, Side::kAfterBlow}, 30.0, 0.0}, kGravity).force_x;
  const double before = hullWrench(model, {{0.0, Side::kBeforeBlow}, 30.0, 0.0}, kGravity).force_x;
  EXPECT_NEAR(table.out[0][0], after, 1e-13 * std::abs(before));
  EXPECT_EQ(table.out[0][0], table.out[0][1]);
  EXPECT_NEAR(table.out[0][2], before, 1e-13 * std::abs(before));
  EXPECT_GT(std::abs(after - before), 1000.0);
}

TEST(Batch, HasTheFinitePinForcesOfAnUnacceleratedCrankAtTheBlowItself) {
  HammerParameters p = test::mo100LinkageParameters();
  p.rod_com_across = 0.0;  // a centre of mass off the rod's line requires an unbounded force
  const Mechanism mechanism = test::mechanismOf(p);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    Table table;
    table.add(0.0, 30.0, 0.0);
    table.out.assign(kColumns, std::vector<double>(1));
    linkLoads(HullModel(mechanism, level), table.states(0, 1), {}, table.wrenches(0), table.pins(0));
    const PinReactions right = pinForces(mechanism, level, {{0.0, Side::kAfterBlow}, 30.0, 0.0}, {}, NearBlow(0.01));
    const double size = std::hypot(right.rod_on_rocker.x, right.rod_on_rocker.z);
    EXPECT_GT(size, 100.0);
    EXPECT_NEAR(table.out[7][0], right.rod_on_rocker.x, 1e-13 * size);
    EXPECT_NEAR(table.out[8][0], right.rod_on_rocker.z, 1e-13 * size);
    EXPECT_NEAR(table.out[11][0], right.drive_torque, 1e-13 * size);
  }
}

TEST(Batch, HasNoPinForcesOfAnAcceleratedCrankAtTheBlowItself) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    Table table;
    for (const double angle : {1e-9, 0.0, 1e-17, -1e-300}) table.add(angle, 30.0, 500.0);
    table.out.assign(kColumns, std::vector<double>(4));
    linkLoads(HullModel(mechanism, level), table.states(0, 4), {}, table.wrenches(0), table.pins(0));
    EXPECT_TRUE(std::isfinite(table.out[7][0]));
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_TRUE(std::isnan(table.out[7][i])) << i;
      EXPECT_TRUE(std::isfinite(table.out[0][i] + table.out[11][i])) << i;
    }
  }
}

TEST(Batch, NeverAllocates) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const HullModel model(mechanism, Level::kLinkage);
  Table table = randomTable(777, 86);
  table.compute(model, true);
  const std::size_t before = test::allocations;
  linkLoads(model, table.states(0, 777), kGravity, table.wrenches(0), table.pins(0));
  hullWrenches(model, table.states(0, 777), kGravity, table.wrenches(0));
  EXPECT_EQ(test::allocations, before);
  const std::vector<double> proof(10);
  EXPECT_GT(test::allocations, before) << "the counter works";
}

}  // namespace
}  // namespace hammer_loads
