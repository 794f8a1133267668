#include "hammer_loads/calibration/reading_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/boom/cylinder_flags.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kFits = 0.5;    // part of the force, rms: errors of nominal masses, friction and zeros are below it
constexpr double kBetter = 0.5;  // another reading of it is off by less than this part
constexpr double kBeyondLimit = 0.3;  // [rad]

struct PressureUnit {
  const char* name;
  double pascal;
};
constexpr std::array<PressureUnit, 5> kUnits{
    {{"Pa", 1.0}, {"bar", 1e5}, {"psi", 6894.757}, {"kPa", 1e3}, {"MPa", 1e6}}};

/// One way to read a cylinder's pressures.
struct ReadAs {
  std::size_t of{};  ///< the cylinder whose topics these truly are
  bool exchanged{};  ///< chambers
  PressureUnit unit{};
};

std::string textOf(const ReadAs& way, std::size_t cylinder, const BoomModel& model) {
  std::string text;
  if (way.of != cylinder) text += " those of " + model.given().cylinders()[way.of].parameters().name;
  if (way.exchanged) text += std::string(text.empty() ? "" : ",") + " bore and rod exchanged";
  if (way.unit.pascal != 1.0) text += std::string(text.empty() ? "" : ",") + " in " + way.unit.name;
  return text;
}

/// rms of measured less expected force, over that expected.
double misfit(const BoomModel& model, const std::vector<double>& expected, const BoomPoints& recording,
              std::size_t cylinder, const ReadAs& way) {
  const Cylinder& c = model.given().cylinders()[cylinder];
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!std::isfinite(expected[i])) continue;
    auto p = recording.points[i].pressure[way.of];
    if (way.exchanged) std::swap(p[0], p[1]);
    const double difference = way.unit.pascal * forceOf(c, {p[0], p[1]}) - expected[i];
    off += difference * difference, all += expected[i] * expected[i];
  }
  return all > 0.0 ? std::sqrt(off / all) : 0.0;
}

void checkCylinder(const BoomModel& model, const BoomPoints& recording, std::size_t cylinder,
                   std::vector<std::string>& lines) {
  Boom boom = model.given();
  std::vector<double> expected;
  for (const BoomPoint& point : recording.points) {
    model.move(boom, model.zero(), point);
    const int joint = boom.cylinders()[cylinder].joint();
    expected.push_back(
        boom.cylinders()[cylinder].load(boom.cylinderPosition(cylinder), boom.steadyTorque(joint)).force);
  }
  const double as_said = misfit(model, expected, recording, cylinder, {cylinder, false, kUnits[0]});
  if (as_said <= kFits) return;
  ReadAs best{cylinder, false, kUnits[0]};
  double least = as_said;
  for (std::size_t of = 0; of < boom.cylinders().size(); ++of) {
    for (const bool exchanged : {false, true}) {
      for (const PressureUnit& unit : kUnits) {
        const ReadAs way{of, exchanged, unit};
        const double off = misfit(model, expected, recording, cylinder, way);
        if (off < least) least = off, best = way;
      }
    }
  }
  const std::string& name = boom.cylinders()[cylinder].parameters().name;
  if (least < kBetter * as_said && least < kFits) {
    lines.push_back(format("%s: its pressures are off the boom's weight by %.0f %%, read as%s by %.0f %%", name.c_str(),
                           100.0 * as_said, textOf(best, cylinder, model).c_str(), 100.0 * least));
  } else {
    lines.push_back(
        format("%s: its pressures are off the boom's weight by %.0f %%, must be within %.0f %%: topics, "
               "units, bore, anchors or masses are otherwise than given",
               name.c_str(), 100.0 * as_said, 100.0 * kFits));
  }
}

}  // namespace

std::vector<std::string> misreadings(const BoomModel& model, const BoomPoints& recording) {
  std::vector<std::string> lines;
  const Chain& chain = model.given().chain();
  for (int j = 0; j < chain.joints(); ++j) {
    for (const BoomPoint& point : recording.points) {
      const double q = point.motion.position[j];
      if (q > chain.lower()[j] - kBeyondLimit && q < chain.upper()[j] + kBeyondLimit) continue;
      lines.push_back(
          format("%s: %.4g rad, must be within the description's limits from %.4g to %.4g: in degrees, or of "
                 "another zero",
                 chain.jointNames()[static_cast<std::size_t>(j)].c_str(), q, chain.lower()[j], chain.upper()[j]));
      break;
    }
  }
  if (!lines.empty()) return lines;
  for (std::size_t k = 0; k < model.given().cylinders().size(); ++k) checkCylinder(model, recording, k, lines);
  return lines;
}

}  // namespace hammer_loads::calibration
