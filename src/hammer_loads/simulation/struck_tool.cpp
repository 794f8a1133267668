#include "hammer_loads/simulation/struck_tool.h"

#include <algorithm>

namespace hammer_loads::simulation {
namespace {

constexpr double kYielding = 1e-5;  // time constant of the rock's yielding [s]

struct Contact {
  double force, loss;  // [N], [W]
};

/// Returns force and loss of a spring that is compressed by a depth [m] at a speed [m/s].
Contact press(double stiffness, double damping, double depth, double speed) noexcept {
  if (!(depth > 0.0)) return {0.0, 0.0};
  const double spring = stiffness * depth, force = std::max(0.0, spring * (1.0 + damping * speed));
  return {force, (force - spring) * speed};
}

double springEnergy(double stiffness, double depth) noexcept {
  return depth > 0.0 ? 0.5 * stiffness * depth * depth : 0.0;
}

constexpr double kSlowest = 1.0;   // approach speed of a blow [m/s]; some 9 at work
constexpr double kLongest = 0.02;  // duration of a blow with its later contacts [s]

}  // namespace

StruckTool::StruckTool(const MachineSettings& settings)
    : s_(settings.strike), blank_share_(settings.blow.blank_share), draws_(settings.seed ^ kBlowSeed) {
  newTurn(0.0);
}

void StruckTool::newTurn(double time) noexcept {
  const double place = draws_.uniform(), contact = draws_.uniform();
  place_ = s_.tool_late + s_.tool_spread * (2.0 * place - 1.0);
  there_ = !(contact < blank_share_) && !(time >= s_.no_tool_from && time < s_.no_tool_to);
}

double StruckTool::onTool(Striker striker, const ToolState& tool) const noexcept {
  return there_ ? striker.depth - place_ - tool.way : -1.0;
}

double StruckTool::onRock(const ToolState& tool) const noexcept { return tool.way - tool.yielded; }

StruckTool::Answer StruckTool::answer(Striker striker, const ToolState& tool, double gravity_down) const noexcept {
  Answer a;
  if (there_) {
    const Contact contact =
        press(s_.contact_stiffness, s_.contact_damping, onTool(striker, tool), striker.speed - tool.speed);
    const double over = onRock(tool) - s_.rock_strength / s_.rock_stiffness;
    a.rate.yielded = std::max(0.0, over) / kYielding;
    const double pressing = tool.speed - a.rate.yielded;
    const Contact rock = press(s_.rock_stiffness, s_.rock_damping, onRock(tool), pressing);
    a.tool = contact.force, a.contact_loss = contact.loss;
    a.rock_loss = rock.loss + rock.force * a.rate.yielded;
    a.rate.way = tool.speed;
    a.rate.speed = gravity_down + (contact.force - rock.force) / s_.tool_mass;
  }
  if (s_.retainer_stiffness > 0.0) {
    const Contact retainer =
        press(s_.retainer_stiffness, s_.retainer_damping, striker.depth - s_.retainer_gap, striker.speed);
    a.retainer = retainer.force, a.retainer_loss = retainer.loss;
  }
  return a;
}

double StruckTool::energy(Striker striker, const ToolState& tool) const noexcept {
  double energy = springEnergy(s_.retainer_stiffness, striker.depth - s_.retainer_gap);
  if (there_) {
    energy += 0.5 * s_.tool_mass * tool.speed * tool.speed + springEnergy(s_.contact_stiffness, onTool(striker, tool)) +
              springEnergy(s_.rock_stiffness, onRock(tool));
  }
  return energy;
}

int StruckTool::contacts(Striker striker, const ToolState& tool) const noexcept {
  const bool retainer = s_.retainer_stiffness > 0.0 && striker.depth > s_.retainer_gap;
  return (onTool(striker, tool) > 0.0 ? 1 : 0) + (retainer ? 2 : 0) + (onRock(tool) > 0.0 ? 4 : 0);
}

BlowTruth* BlowFollower::follow(const Instant& now) {
  const bool before = touched_;
  touched_ = now.touches;
  if (meeting_ && now.time > meeting_->truth.time + kLongest) end(now);
  BlowTruth* begun = nullptr;
  if (now.touches && !before && !meeting_ && now.approach > kSlowest) {
    meeting_.emplace();
    meeting_->begun = now;
    begun = &meeting_->truth;
    begun->time = now.time;
    begun->crank_speed = now.crank_speed;
    begun->strike.rocker_speed_before = now.rocker_speed;
  }
  if (!meeting_) return nullptr;
  BlowTruth& truth = meeting_->truth;
  if (now.touches && !before) meeting_->touched = now.time, ++truth.touches;
  if (before && !now.touches) {
    truth.contact += now.time - meeting_->touched;
    truth.strike.rocker_speed_after = now.rocker_speed;
    truth.strike.crank_speed_after = now.crank_speed;
  }
  return begun;
}

void BlowFollower::end(const Instant& now) {
  BlowTruth& truth = meeting_->truth;
  truth.strike.tool_impulse = now.tool_impulse - meeting_->begun.tool_impulse;
  truth.strike.energy = now.tool_energy - meeting_->begun.tool_energy;
  truth.retainer_impulse = now.retainer_impulse - meeting_->begun.retainer_impulse;
  blows_.push_back(truth);
  meeting_.reset();
}

}  // namespace hammer_loads::simulation
