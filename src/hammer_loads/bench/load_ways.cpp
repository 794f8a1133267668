#include "hammer_loads/bench/load_ways.h"

#include <array>
#include <memory>
#include <stdexcept>

#include "hammer_loads/bench/printed_formulas.h"
#include "hammer_loads/bench/timing.h"
#include "hammer_loads/hammer/batch.h"

namespace hammer_loads::accuracy {
namespace {

const NearBlow kNearBlow(0.01);

Mechanism mechanismOf(const HardCase& hard_case) {
  const Checked<Mechanism> made = Mechanism::make(hard_case.hammer);
  if (!made.value) throw std::invalid_argument(made.problems.front());
  return *made.value;
}

/// A way that takes one state after the other: make(hard case) gives what computes the loads of an angle of it.
template <typename Make>
LoadWay oneByOne(const char* group, const char* name, Level level, Parts parts, const Make& make) {
  LoadWay way{group, name, level, parts, {}, {}};
  way.loads = [make](const HardCase& hard_case) {
    const auto compute = make(hard_case);
    std::vector<LinkLoads> loads;
    for (std::size_t i = 0; i < hard_case.angles.size(); ++i) loads.push_back(compute(i));
    return loads;
  };
  way.pass = [make](const HardCase& hard_case) {
    const auto compute = make(hard_case);
    const std::size_t count = hard_case.angles.size();
    return [compute, count] {
      for (std::size_t i = 0; i < count; ++i) keep(compute(i));
    };
  };
  return way;
}

LoadWay printed(const char* name, Positions positions) {
  return oneByOne("printed", name, Level::kRocker, Parts::kPrinted, [positions](const HardCase& c) {
    return [formulas = PrintedFormulas(c.hammer, positions), c](std::size_t i) {
      return formulas(c.angles[i], c.speed, c.acceleration, c.gravity);
    };
  });
}

/// Mechanism, model and states of a case as the calls want them.
struct Prepared {
  Prepared(const HardCase& c, Level level) : mechanism(mechanismOf(c)), model(mechanism, level), gravity(c.gravity) {
    for (const double angle : c.angles) cranks.push_back({CrankAngle::fromAngle(angle), c.speed, c.acceleration});
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
  Mechanism mechanism;
  HullModel model;
  Gravity gravity;
  std::vector<CrankMotion> cranks;
};

LoadWay scalarWrench(const char* name, Level level) {
  return oneByOne("scalar", name, level, level == Level::kPulse ? Parts::kForceZ : Parts::kWrench,
                  [level](const HardCase& c) {
                    return [p = std::make_shared<const Prepared>(c, level)](std::size_t i) {
                      return LinkLoads{hullWrench(p->model, p->cranks[i], p->gravity), {}};
                    };
                  });
}

LoadWay scalarPins(const char* name, Level level) {
  return oneByOne("scalar", name, level, Parts::kPins, [level](const HardCase& c) {
    return [p = std::make_shared<const Prepared>(c, level), level](std::size_t i) {
      return linkLoads(p->mechanism, level, p->cranks[i], p->gravity, kNearBlow);
    };
  });
}

/// Arrays of a case for the batch calls.
struct BatchCase {
  BatchCase(const HardCase& c, Level level)
      : prepared(c, level),
        angles(c.angles),
        speeds(c.angles.size(), c.speed),
        accelerations(c.angles.size(), c.acceleration) {
    for (std::vector<double>& column : out) column.resize(angles.size());
  }
  void compute(bool with_pins) {
    const CrankStates states{angles.data(), speeds.data(), accelerations.data(), angles.size()};
    const auto at = [this](std::size_t column) { return out[column].data(); };
    const WrenchArrays wrenches{at(0), at(1), at(2)};
    if (!with_pins) return hullWrenches(prepared.model, states, prepared.gravity, wrenches);
    const PinArrays pins{at(3), at(4), at(5), at(6), at(7), at(8), at(9), at(10), at(11)};
    linkLoads(prepared.model, states, prepared.gravity, wrenches, pins);
  }
  LinkLoads result(std::size_t i) const {
    const auto& o = out;
    return {{o[0][i], o[1][i], o[2][i]},
            {{o[3][i], o[4][i]}, {o[5][i], o[6][i]}, {o[7][i], o[8][i]}, {o[9][i], o[10][i]}, o[11][i], false}};
  }
  Prepared prepared;
  std::vector<double> angles, speeds, accelerations;
  std::array<std::vector<double>, 12> out;
};

LoadWay batch(const char* name, Level level, bool with_pins) {
  LoadWay way{"batch", name, level, with_pins ? Parts::kPins : Parts::kWrench, {}, {}};
  way.loads = [=](const HardCase& c) {
    BatchCase arrays(c, level);
    arrays.compute(with_pins);
    std::vector<LinkLoads> loads;
    for (std::size_t i = 0; i < c.angles.size(); ++i) loads.push_back(arrays.result(i));
    return loads;
  };
  way.pass = [=](const HardCase& c) {
    return [=, arrays = std::make_shared<BatchCase>(c, level)] { arrays->compute(with_pins); };
  };
  return way;
}

}  // namespace

std::vector<LoadWay> loadWays() {
  return {printed("P0 with inverse trigonometry", Positions::kInverseTrigonometry),
          printed("P0 with sines and cosines", Positions::kTrigonometry),
          scalarWrench("pulse", Level::kPulse),
          scalarWrench("rocker", Level::kRocker),
          scalarWrench("linkage", Level::kLinkage),
          scalarPins("rocker with pins", Level::kRocker),
          scalarPins("linkage with pins", Level::kLinkage),
          batch("rocker", Level::kRocker, false),
          batch("linkage", Level::kLinkage, false),
          batch("rocker with pins", Level::kRocker, true),
          batch("linkage with pins", Level::kLinkage, true)};
}

}  // namespace hammer_loads::accuracy
