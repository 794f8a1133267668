#include "hammer_loads/ros/bag_tables.h"

#include <cstring>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/boom_health.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/ros/version.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/tables/digest.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

struct Kind {
  double (*read)(const std::uint8_t* bytes);
  std::size_t size;
  bool is_integer;
};

template <typename T>
constexpr Kind kindOf() {
  return {[](const std::uint8_t* bytes) {
            T value;
            std::memcpy(&value, bytes, sizeof value);
            return static_cast<double>(value);
          },
          sizeof(T), std::is_integral_v<T>};
}

const std::map<std::string, Kind>& kinds() {
  static const std::map<std::string, Kind> kinds{
      {"float64", kindOf<double>()},       {"float32", kindOf<float>()},       {"bool", kindOf<std::uint8_t>()},
      {"int8", kindOf<std::int8_t>()},     {"uint8", kindOf<std::uint8_t>()},  {"int16", kindOf<std::int16_t>()},
      {"uint16", kindOf<std::uint16_t>()}, {"int32", kindOf<std::int32_t>()},  {"uint32", kindOf<std::uint32_t>()},
      {"int64", kindOf<std::int64_t>()},   {"uint64", kindOf<std::uint64_t>()}};
  return kinds;
}

/// Removes the log's parameters and the ledger's path, which are no property of the machine. yaml: one key per line.
std::string withoutPaths(const std::string& yaml) {
  std::istringstream lines(yaml);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    const std::string key = line.substr(0, line.find(':'));
    if (key.rfind("log_", 0) != 0 && key != "life_ledger") kept += line + '\n';
  }
  return kept;
}

}  // namespace

NumberFields::NumberFields(const std::string& definition) {
  // A field's comment is "# [unit] description"; further lines of the description begin with spaces.
  static const std::regex kComment(R"([^#]*#\s*(?:\[([^\]]*)\]\s*)?(.*))"), kFurther(R"(\s+#.*)");
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line) && line.rfind("====", 0) != 0;) {
    if (!fields_.empty() && std::regex_match(line, kFurther))
      fields_.back().column.description += ' ' + line.substr(line.find('#') + 2);
    const std::string code = line.substr(0, line.find('#'));
    std::istringstream words(code);
    std::string type, name;
    if (!(words >> type >> name) || name == "header" || code.find('=') != std::string::npos) continue;  // =: a constant
    const auto kind = kinds().find(type);
    if (kind == kinds().end()) throw std::invalid_argument("field " + name + " of type " + type + " is no number");
    TableColumn column{name, kind->second.is_integer, "-", {}};
    if (std::smatch found; std::regex_match(line, found, kComment)) {
      if (found[1].matched) column.unit = found[1];
      column.description = found[2];
    }
    fields_.push_back({column, kind->second.read, kind->second.size});
  }
  values_.resize(fields_.size());
}

std::vector<TableColumn> NumberFields::columns() const {
  std::vector<TableColumn> columns;
  for (const Field& field : fields_) columns.push_back(field.column);
  return columns;
}

void NumberFields::read(std::size_t header_size) {
  const std::uint8_t* at = bytes_.data() + header_size;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    values_[i] = fields_[i].read(at);
    at += fields_[i].size;
  }
}

BagTables::BagTables(const std::string& file, const std::vector<std::string>& inputs)
    : input_sha256_(sha256OfFiles(inputs)),
      pulse_(numberFieldsOf<Pulse>()),
      blow_(numberFieldsOf<Blow>()),
      writer_(file, pulse_.columns(), blow_.columns()) {}

void BagTables::begin(HammerBridge& bridge) {
  ++run_;
  published_ = {};
  traces_ = {};
  longest_step_ = bridge.settings().pipeline.stale_after;
  life_.begin(bridge, run_);
  HammerOutputs& outputs = bridge.outputs();
  outputs.hull_loads.attach([this](const HullLoads& message, const ros::Time&) { takeSample(message); });
  outputs.pulse.attach(
      [this, &bridge](const Pulse& message, const ros::Time&) { takePulse(message, bridge.pipeline()); });
  outputs.blow.attach([this](const Blow& message, const ros::Time&) {
    writer_.addTurn("blows", run_, stampOf(message.header.stamp), blow_.valuesOf(message));
  });
}

void BagTables::takeSample(const HullLoads& message) {
  const StampNs stamp = stampOf(message.header.stamp);
  if (!published_.first) published_.first = stamp;
  const double step = published_.last ? seconds(stamp - *published_.last) : 0.0;
  if (step > 0.0 && step <= longest_step_) published_.duration += step;
  published_.last = stamp;
  traces_.add({stamp, message.force_x, message.force_z, message.torque_y, message.force_z_std, message.crank_angle});
}

void BagTables::takeHealth(std::uint64_t turn, const BoomFollower& boom) {
  const std::optional<BoomHealth> health = boomHealth(boom);
  if (!health) return;
  for (int i = 0; i < health->count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const BoomHealth::OfCylinder& c = health->cylinder[at];
    const BoomHealth::OfMode& m = health->mode[at];
    writer_.add("boom_cylinders", run_, turn, boom.boom().cylinders()[at].parameters().name, c.joint_angle, c.stiffness,
                c.deviation, !health->oil_explains);
    writer_.add("boom_modes", run_, turn, i + 1, m.frequency, m.deviation, m.damping, m.damping_std);
  }
}

void BagTables::takePulse(const Pulse& message, const Pipeline& pipeline) {
  const StampNs stamp = stampOf(message.header.stamp);
  writer_.addTurn("turns", run_, stamp, pulse_.valuesOf(message));
  traces_.turnEnded(message.turn, stamp, message.period, message.amplitude);
  if (pipeline.boom()) takeHealth(message.turn, *pipeline.boom());
}

void BagTables::addParameters(const Settings& settings, const std::string& yaml) {
  std::set<std::string> given;
  for (const ParameterText& parameter : parameterTexts(configDirectory(), yaml)) {
    given.insert(parameter.key);
    writer_.add("parameters", run_, parameter.key, parameter.value, parameter.shipped);
  }
  // A test report states the uncertainty of every input, including standard deviations that no file gives.
  for (const auto& [key, deviation] : deviationsInForce(settings.mechanism.parameters())) {
    const std::string value = format("%.3g", deviation);
    if (deviation > 0.0 && given.count(key) == 0) writer_.add("parameters", run_, key, value, value);
  }
}

void BagTables::addRefusals(const SampleCounts& counts) {
  const auto add = [this](const std::string& reason, std::uint64_t count) {
    if (count > 0) writer_.add("refusals", run_, reason, count);
  };
  for (std::size_t i = 0; i < counts.refused.size(); ++i) add(kRefusalNames[i], counts.refused[i]);
  add("beside the blow", counts.beside_blow);
  add("uncertain", counts.uncertain);
}

void BagTables::addTrace(const char* kind, const TurnTrace& trace) {
  std::int64_t place = 0;
  for (const TraceSample& s : trace.samples)
    writer_.add("traces", run_, kind, trace.turn, place++, seconds(s.stamp - trace.start), s.force_x, s.force_z,
                s.torque_y, s.force_z_std, s.crank_angle);
}

void BagTables::end(const HammerBridge& bridge, std::uint64_t samples) {
  const Settings& settings = bridge.settings();
  const Pipeline& pipeline = bridge.pipeline();
  const SampleCounts& counts = pipeline.counts();
  const CrankFilter& filter = pipeline.crank().tracker();
  const HammerOutputs& outputs = bridge.outputs();
  const std::string yaml = withoutPaths(settings.yaml);
  const std::string parameters = sha256Of({yaml, settings.robot_description});
  const std::string key = sha256Of({input_sha256_, parameters, packageVersion(), std::to_string(run_)});
  writer_.add("runs", run_, key, input_sha256_, parameters, digestOf(settings.machine), packageVersion(),
              packageRevision(), yaml, published_.first, published_.last, published_.duration,
              nameOf(settings.pipeline.level), samples, outputs.hull_loads.sent(), counts.restarts,
              outputs.pulse.sent(), outputs.blow.sent(), counts.backward_passes, filter.consistency(),
              filter.timingNoise(), filter.speedNoise(), filter.angleResolution(), filter.driveInertia(),
              filter.blowFactor().inertia_std, settings.life.equivalent_cycles_per_hour, counts.misuse.blank_firings,
              counts.misuse.judged_blows, counts.misuse.withoutHoldDown(), counts.misuse.still(),
              pipeline.hull().pitch().pitch());
  addParameters(settings, yaml);
  addRefusals(counts);
  if (const TurnTrace* typical = traces_.typical()) addTrace("typical", *typical);
  if (traces_.worst()) addTrace("worst", *traces_.worst());
  life_.end(bridge);
}

void BagTables::finish(const std::vector<BagWarning>& warnings) {
  for (std::int64_t run = 1; run <= run_; ++run) {
    std::int64_t place = 0;
    for (const BagWarning& warning : warnings)
      if (warning.run == 0 || warning.run == run) writer_.add("warnings", run, place++, warning.key, warning.text);
  }
  writer_.finish();
}

}  // namespace hammer_loads
