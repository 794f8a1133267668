#include "hammer_loads/python/loads.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/hammer/evaluate.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::python {
namespace {

constexpr double kLargestAngle = 4e8;  // [rad], batch.h
constexpr std::size_t kChunk = 8192;   // states at once: what is repeated for them stays in the cache
constexpr std::array<const char*, 3> kWrenchColumns{"hull_force_x_N", "hull_force_z_N", "hull_torque_y_Nm"};
constexpr std::size_t kAllColumns = kWrenchColumns.size() + kPinColumns.size();
using Outputs = std::array<double*, kAllColumns>;

Level levelOf(const Hammer& hammer, const std::optional<std::string>& word) {
  if (!word) return hammer.level();
  std::string words;
  for (const auto& [name, level] : kRigidLevelNames) {
    if (*word == name) return level;
    words += (words.empty() ? "" : ",") + std::string(name);
  }
  raise({"level: " + onOneLine(*word) + " not in {" + words + "}"});
}

double checked(const char* name, double value, const char* unit, double least, double most) {
  const bool above = least == 0.0 ? value > 0.0 : value >= least;  // as for the commands' options
  if (above && value <= most && std::isfinite(value)) return value;
  std::string rule = least == 0.0 ? "a finite number > 0" : "a finite number >= " + numberText(least);
  if (std::isfinite(most)) rule += " and <= " + numberText(most);
  raise({std::string(name) + ": " + numberText(value) + " " + unit + ", must be " + rule});
}

Gravity gravityAt(double g, double pitch) { return {g * std::sin(pitch), -g * std::cos(pitch)}; }

double gravityOf(const Hammer& hammer, const Weight& weight) {
  if (weight.pitch.is_none()) return 0.0;
  const double g = weight.gravity.value_or(hammer.gravity());
  if (!(g >= 0.0 && std::isfinite(g))) raise({"gravity: " + numberText(g) + " m/s2, must be a finite number >= 0"});
  return g;
}

/// The pitch of all states.
double onePitch(const Weight& weight) {
  if (weight.pitch.is_none()) return 0.0;
  const double pitch = numberOf("pitch", weight.pitch);
  if (!std::isfinite(pitch)) raise({"pitch: " + numberText(pitch) + " rad, must be a finite number"});
  return pitch;
}

/// Loads of many states; no Python object is touched.
class Batch {
 public:
  Batch(const HullModel& model, bool pins, const Outputs& out) : model_(model), pins_(pins), out_(out) {}

  void compute(const CrankStates& states, Gravity gravity, std::size_t first) const {
    Outputs here = out_;
    for (double*& column : here) column = column == nullptr ? nullptr : column + first;
    call(states, gravity, here);
  }

  /// Loads are linear in gravity: those without it and those of each of its components.
  void computeByPitch(const CrankStates& states, const double* pitch, double g, std::size_t first) {
    compute(states, {}, first);
    still_.assign(states.count, 0.0);
    const CrankStates at_rest{states.angle, still_.data(), still_.data(), states.count};
    for (auto* weights : {&of_x_, &of_z_}) weights->resize(columns() * states.count);
    call(at_rest, {1.0, 0.0}, columnsOf(of_x_, states.count));
    call(at_rest, {0.0, 1.0}, columnsOf(of_z_, states.count));
    x_.resize(states.count), z_.resize(states.count);
    for (std::size_t i = 0; i < states.count; ++i) x_[i] = g * std::sin(pitch[i]), z_[i] = -g * std::cos(pitch[i]);
    for (std::size_t c = 0; c < columns(); ++c) {
      for (std::size_t i = 0; i < states.count; ++i)
        out_[c][first + i] += x_[i] * of_x_[c * states.count + i] + z_[i] * of_z_[c * states.count + i];
    }
  }

 private:
  std::size_t columns() const { return pins_ ? kAllColumns : kWrenchColumns.size(); }
  Outputs columnsOf(std::vector<double>& block, std::size_t count) const {
    Outputs out{};
    for (std::size_t c = 0; c < columns(); ++c) out[c] = block.data() + c * count;
    return out;
  }
  /// At level pulse the pins are the rocker's, the wrench its own.
  void call(const CrankStates& states, Gravity gravity, const Outputs& out) const {
    const WrenchArrays wrench{out[0], out[1], out[2]};
    if (pins_) {
      const PinArrays pins{out[4], out[5], out[6], out[7], out[8], out[9], out[10], out[11], out[3]};
      linkLoads(model_, states, gravity, wrench, pins);
      if (model_.level() != Level::kPulse) return;
    }
    hullWrenches(model_, states, gravity, wrench);
  }

  const HullModel& model_;
  bool pins_;
  Outputs out_;
  std::vector<double> still_, of_x_, of_z_, x_, z_;
};

/// False where one is beyond what an angle may be; nan is none.
bool goodAngles(const double* angle, std::size_t count) {
  bool good = true;
  for (std::size_t i = 0; i < count; ++i) good &= !(std::abs(angle[i]) > kLargestAngle);
  return good;
}

/// True unless an angle is too large.
bool computeAll(const StateArrays& states, Batch& batch, const Weight& weight, double g, double pitch) {
  std::array<std::vector<double>, 4> scratch;
  const bool by_pitch = weight.pitch.ptr() != Py_None && !states.isNumber(3) && states.count() != 1;
  for (std::size_t first = 0; first < states.count(); first += kChunk) {
    const std::size_t count = std::min(kChunk, states.count() - first);
    std::array<const double*, 4> at{};
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = states.from(i, first, count, scratch[i]);
    if (!goodAngles(at[0], count)) return false;
    const CrankStates chunk{at[0], at[1], at[2], count};
    if (by_pitch)
      batch.computeByPitch(chunk, at[3], g, first);
    else
      batch.compute(chunk, gravityAt(g, pitch), first);
  }
  return true;
}

}  // namespace

py::dict wrenches(const Hammer& hammer, const py::object& angle, const py::object& speed,
                  const py::object& acceleration, const LoadOptions& options) {
  const HullModel model(hammer.mechanism(), levelOf(hammer, options.level));
  const double g = gravityOf(hammer, options.weight);
  const py::object pitches = options.weight.pitch.is_none() ? py::float_(0.0) : options.weight.pitch;
  const StateArrays states({{"angle", angle}, {"speed", speed}, {"acceleration", acceleration}, {"pitch", pitches}});
  const bool one_pitch = states.isNumber(3) || states.count() == 1;
  std::vector<double> scratch;
  const double pitch = states.count() > 0 && one_pitch ? *states.from(3, 0, 1, scratch) : 0.0;
  ResultArrays results(states.shape(), options.pins ? kAllColumns : kWrenchColumns.size(), options.out);
  Outputs out{};
  for (std::size_t c = 0; c < kWrenchColumns.size(); ++c) out[c] = results.add(kWrenchColumns[c]);
  for (std::size_t c = 0; options.pins && c < kPinColumns.size(); ++c)
    out[kWrenchColumns.size() + c] = results.add(kPinColumns[c]);
  results.demandApartFrom(states);
  bool good = false;
  {
    const py::gil_scoped_release others_may_run;
    Batch batch(model, options.pins, out);
    good = computeAll(states, batch, options.weight, g, pitch);
  }
  if (!good) raise({"crank_angle_rad: must be a number of size <= 4e8 rad"});
  return results.take();
}

py::dict turn(const Hammer& hammer, double speed, double step, const LoadOptions& options) {
  checked("speed", speed, "rad/s", 0.0, HUGE_VAL);
  checked("step_deg", step, "deg", 1e-6, 360.0);
  const Gravity gravity = gravityAt(gravityOf(hammer, options.weight), onePitch(options.weight));
  const TurnTable table{HullModel(hammer.mechanism(), levelOf(hammer, options.level)), speed, gravity, step,
                        options.pins};
  const std::size_t count = rowCount(table);
  const std::array<const char*, 5> names{"crank_angle_deg", "time_s", "force_x_N", "force_z_N", "torque_y_Nm"};
  ResultArrays results({static_cast<py::ssize_t>(count)}, names.size() + (options.pins ? kPinColumns.size() : 0));
  std::vector<double*> out;
  for (const char* name : names) out.push_back(results.add(name));
  for (std::size_t c = 0; options.pins && c < kPinColumns.size(); ++c) out.push_back(results.add(kPinColumns[c]));
  {
    const py::gil_scoped_release others_may_run;
    for (std::size_t first = 0; first < count; first += kChunk) {
      const std::vector<TurnRow> rows = turnRows(table, first, kChunk);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const TurnRow& row = rows[i];
        const std::array<double, 5> values{row.crank_angle, row.time, row.wrench.force_x, row.wrench.force_z,
                                           row.wrench.torque_y};
        for (std::size_t c = 0; c < values.size(); ++c) out[c][first + i] = values[c] + 0.0;
        if (!options.pins) continue;
        const auto pins = pinValues(row.pins);
        for (std::size_t c = 0; c < pins.size(); ++c) out[values.size() + c][first + i] = pins[c] + 0.0;
      }
    }
  }
  return results.take();
}

py::dict pulse(const Hammer& hammer, double speed, const LoadOptions& options) {
  checked("speed", speed, "rad/s", 0.0, HUGE_VAL);
  const Gravity gravity = gravityAt(gravityOf(hammer, options.weight), onePitch(options.weight));
  const HullModel model(hammer.mechanism(), levelOf(hammer, options.level));
  const ConstantSpeedPulse result = pulseOfTurn({model, speed, gravity, 1.0, false});
  py::dict values;
  values["amplitude_N"] = result.pulse.amplitude;
  values["peak_angle_deg"] = result.peak_angle / kDegree;
  values["impulse_Ns"] = result.pulse.impulse;
  values["frequency_rad_s"] = result.pulse.frequency;
  values["start_s"] = result.pulse.start;
  values["turn_impulse_x_Ns"] = result.pulse.turn_impulse_x + 0.0;
  values["turn_impulse_z_Ns"] = result.pulse.turn_impulse_z + 0.0;
  return values;
}

py::dict blow(const Hammer& hammer, double before, std::optional<double> after,
              const std::optional<std::string>& level) {
  checked("crank_speed", before, "rad/s", 0.0, HUGE_VAL);
  if (after && !std::isfinite(*after))
    raise({"crank_speed_after: " + numberText(*after) + " rad/s, must be a finite number"});
  const Level at = levelOf(hammer, level);
  const RockerBlow result = after ? blowAtCrankSpeeds(hammer.mechanism(), at, before, *after)
                                  : blowAtCrankSpeed(hammer.mechanism(), at, before);
  py::dict values;
  values["crank_speed_before_rad_s"] = before;
  values["crank_speed_after_rad_s"] = after.value_or(before);
  values["rocker_speed_before_rad_s"] = result.rocker_speed_before;
  values["rocker_speed_after_rad_s"] = result.rocker_speed_after;
  values["restitution"] = result.restitution;
  values["energy_J"] = result.energy;
  values["tool_impulse_x_Ns"] = result.tool_impulse_x;
  values["tool_impulse_z_Ns"] = result.tool_impulse_z;
  values["support_impulse_x_Ns"] = result.support_impulse_x;
  values["support_impulse_z_Ns"] = result.support_impulse_z;
  return values;
}

void bareBatch(const Hammer& hammer, const Array& angle, const Array& speed, const Array& acceleration,
               const std::string& level) {
  const auto count = static_cast<std::size_t>(angle.size());
  if (speed.size() != angle.size() || acceleration.size() != angle.size()) raise({"arrays must have one length"});
  static std::vector<double> out;
  out.resize(3 * count);
  const HullModel model(hammer.mechanism(), levelOf(hammer, level));
  hullWrenches(model, {angle.data(), speed.data(), acceleration.data(), count}, {},
               {out.data(), out.data() + count, out.data() + 2 * count});
}

}  // namespace hammer_loads::python
