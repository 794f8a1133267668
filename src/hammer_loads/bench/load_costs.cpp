#include "hammer_loads/bench/load_costs.h"

#include <map>

#include "hammer_loads/bench/load_ways.h"

namespace hammer_loads::accuracy {
namespace {

constexpr std::size_t kTimedAngles = 1024;  // all arrays of a batch stay in the second-level cache

/// A regular turn with every term at work.
HardCase timedCase(const HardCase& regular) {
  HardCase timed = regular;
  timed.acceleration = 50.0;
  timed.angles = turnAngles(kTimedAngles);
  return timed;
}

/// Level pulse is an approximation of level rocker.
Level exactLevelOf(const LoadWay& way) { return way.level == Level::kLinkage ? Level::kLinkage : Level::kRocker; }

}  // namespace

std::vector<CostRow> loadCosts(const Mechanism& mechanism) {
  const std::vector<LoadWay> ways = loadWays();
  const std::vector<HardCase> cases = hardCases(mechanism.parameters());
  std::vector<CostRow> rows;
  for (const LoadWay& way : ways)
    rows.push_back({way.group, way.name, costOf(kTimedAngles, way.pass(timedCase(cases.front()))), {}, {}});
  for (const HardCase& hard_case : cases) {
    const std::map<Level, ExactCase> exact{{Level::kRocker, {hard_case, Level::kRocker}},
                                           {Level::kLinkage, {hard_case, Level::kLinkage}}};
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const std::vector<LinkLoads> loads = ways[i].loads(hard_case);
      rows[i].errors.push_back({hard_case.name, errorOf(loads, exact.at(exactLevelOf(ways[i])), ways[i].parts)});
      if (&hard_case == cases.data())
        rows[i].left_out = errorOf(loads, exact.at(Level::kLinkage), Parts::kForceZ).of_peak;
    }
  }
  return rows;
}

}  // namespace hammer_loads::accuracy
