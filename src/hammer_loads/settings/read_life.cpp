#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "hammer_loads/settings/readers.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

using life::LoadGrid;

constexpr double kPaPerMPa = 1e6;
constexpr NumberRule kFullScale = NumberRule::within(-1e15, 1e15);  // [N], [N m], [MPa]; no structure bears more

/// Short name in the file and the channel for which it stands.
struct NamedChannel {
  std::string name, channel;
};

/// Reads the full scale of a channel. Returns nothing after a problem.
std::optional<LoadGrid> readGrid(ParameterReader& reader, const std::string& name, const std::string& unit,
                                 std::int64_t classes) {
  const std::string ending = unit.empty() ? "" : "_" + unit, key = name + "_full_scale_least" + ending;
  const double least = reader.number(key, unit, kFullScale);
  const double greatest = reader.number(name + "_full_scale_greatest" + ending, unit, kFullScale);
  if (!std::isfinite(least) || !std::isfinite(greatest) || classes == 0) return std::nullopt;
  Checked<LoadGrid> grid = LoadGrid::make(least, greatest, classes);
  for (const std::string& problem : grid.problems) reader.addProblem(key + ": " + problem);
  return std::move(grid.value);
}

/// Returns the stress that a channel causes [MPa per unit of the channel].
double readInfluence(ParameterReader& reader, const std::string& key, const std::string& channel) {
  const std::string direct = key + "_MPa_per_unit", modulus = key + "_modulus_m3", area = key + "_area_m2";
  const int given = int{reader.given(direct)} + int{reader.given(modulus)} + int{reader.given(area)};
  double factor = 0.0;
  if (reader.given(modulus)) factor = 1.0 / (kPaPerMPa * reader.number(modulus, "m3", NumberRule::any()));
  if (reader.given(area)) factor = 1.0 / (kPaPerMPa * reader.number(area, "m2", NumberRule::positive()));
  if (reader.given(direct) || given == 0) factor = reader.number(direct, "MPa per unit", NumberRule::any());
  if (given > 1) reader.addProblem(direct + ": must be the only one beside " + modulus + " and " + area);
  if (reader.given(modulus) && life::unitOf(channel) != "N m")
    reader.addProblem(modulus + ": given for " + channel + ", must be for a moment");
  if (reader.given(area) && life::unitOf(channel) != "N")
    reader.addProblem(area + ": given for " + channel + ", must be for a force");
  if (reader.given(modulus) && std::isinf(factor)) reader.addProblem(modulus + ": 0 m3, must not be 0");
  return factor;
}

/// Reads an S-N curve. Returns nothing without a curve, or after a problem.
std::optional<life::SnCurve> readCurve(ParameterReader& reader, const std::string& name) {
  const std::string keys[] = {name + "_sn_knee_range_MPa", name + "_sn_knee_cycles", name + "_sn_slope",
                              name + "_sn_slope_below"};
  if (std::none_of(std::begin(keys), std::end(keys), [&](const std::string& key) { return reader.given(key); }))
    return {};
  const std::size_t before = reader.problems().size();
  const double range = reader.number(keys[0], "MPa", NumberRule::positive());
  const double cycles = reader.number(keys[1], "", NumberRule::positive());
  const double slope = reader.number(keys[2], "", NumberRule::positive());
  const double below = reader.number(keys[3], "", NumberRule::positive());
  if (reader.problems().size() != before) return std::nullopt;
  Checked<life::SnCurve> curve = life::SnCurve::make(range, cycles, slope, below);
  for (const std::string& problem : curve.problems) reader.addProblem(name + "_" + problem);
  return std::move(curve.value);
}

std::optional<life::FkmMeanStress> readMeanStress(ParameterReader& reader, const std::string& name) {
  constexpr std::array<Named<bool>, 2> kWays{{{"none", false}, {"fkm", true}}};
  if (!reader.choice(name + "_mean_stress", kWays)) return std::nullopt;
  return life::FkmMeanStress{reader.number(name + "_mean_stress_sensitivity", "", NumberRule::within(0.0, 1.0))};
}

void readHotSpot(ParameterReader& reader, const std::string& name, const std::vector<NamedChannel>& channels,
                 std::int64_t classes, std::vector<life::CountedChannel>& counted) {
  std::vector<life::Influence> influences;
  const std::string loads = name + "_loads";
  for (const std::string& load : reader.names(loads)) {
    const auto found =
        std::find_if(channels.begin(), channels.end(), [&](const NamedChannel& c) { return c.name == load; });
    if (found == channels.end()) {
      reader.addProblem(loads + ": " + quotedText(load) + ", must be among life_channels");
      continue;
    }
    influences.push_back({found->channel, readInfluence(reader, name + "_" + load, found->channel)});
  }
  if (influences.empty()) reader.addProblem(loads + ": [], must name at least one of life_channels");
  const std::optional<LoadGrid> grid = readGrid(reader, name, "MPa", classes);
  std::optional<life::SnCurve> curve = readCurve(reader, name);
  std::optional<life::FkmMeanStress> mean;
  if (curve) mean = readMeanStress(reader, name);
  if (grid) counted.push_back({"stress/" + name, *grid, name, std::move(influences), curve, mean});
}

/// Returns the names of a list; none if it is no list.
std::vector<std::string> namesIn(const ParameterMap& parameters, const char* key) {
  const auto found = parameters.find(key);
  if (found == parameters.end()) return {};
  return asTexts(found->second.value).value_or(std::vector<std::string>{});
}

}  // namespace

void checkChannels(const life::LifeSettings& settings, const std::vector<std::string>& of_machine,
                   ParameterReader& reader) {
  for (const life::CountedChannel& channel : settings.channels) {
    const bool is_hot_spot = !channel.influences.empty();
    if (is_hot_spot || std::count(of_machine.begin(), of_machine.end(), channel.name) != 0) continue;
    reader.addProblem(channel.key + "_channel: " + quotedText(channel.name) +
                      ", must be a load of this machine: " + joined(of_machine));
  }
}

void leaveOutUnwantedChannels(const ParameterMap& given, ParameterMap& shipped) {
  if (given.count("life_channels") == 0) return;
  const std::vector<std::string> wanted = namesIn(given, "life_channels");
  for (const std::string& name : namesIn(shipped, "life_channels")) {
    if (std::count(wanted.begin(), wanted.end(), name) != 0) continue;
    for (const char* key : {"_channel", "_full_scale_least", "_full_scale_greatest"}) shipped.erase(name + key);
  }
}

life::LifeSettings readLifeSettings(ParameterReader& reader) {
  life::LifeSettings s;
  const std::int64_t classes = reader.integer("life_classes", "", 2, LoadGrid::kMostClasses);
  std::vector<NamedChannel> channels;
  for (const std::string& name : reader.names("life_channels")) {
    const std::string key = name + "_channel", channel = reader.text(key);
    const bool twice =
        std::any_of(channels.begin(), channels.end(), [&](const auto& c) { return c.channel == channel; });
    if (twice) reader.addProblem(key + ": " + quotedText(channel) + ", must be given once");
    channels.push_back({name, channel});
    const std::optional<LoadGrid> grid = readGrid(reader, name, "", classes);
    if (grid) s.channels.push_back({channel, *grid, name});
  }
  for (const std::string& name : reader.names("hot_spots")) readHotSpot(reader, name, channels, classes, s.channels);
  constexpr double kNsPerSecond = 1e9;
  const double period = reader.number("life_period_s", "s", NumberRule::within(0.1, 86400.0));
  if (std::isfinite(period)) s.period = std::llround(kNsPerSecond * period);
  s.equivalent_cycles_per_hour = reader.number("life_equivalent_cycles_per_hour", "1/h", NumberRule::within(1e-3, 1e9));
  s.bandwidth = reader.number("life_bandwidth_Hz", "Hz", NumberRule::within(0.0, 1e4));
  const std::string ledger = reader.text("life_ledger");
  if (!ledger.empty() && ledger != "none" && ledger.front() != '/')
    reader.addProblem("life_ledger: " + quotedText(ledger) + ", must be an absolute path, or none");
  if (ledger != "none") s.ledger = ledger;
  return s;
}

std::vector<std::string> channelNames(const Boom* boom) {
  std::vector<std::string> names{"hull_wrench/force_x", "hull_wrench/force_z", "hull_wrench/torque_y"};
  if (boom == nullptr) return names;
  for (const std::string& joint : boom->chain().jointNames()) names.push_back("joint_loads/" + joint + "/total_torque");
  for (const Cylinder& cylinder : boom->cylinders())
    names.push_back("joint_loads/" + cylinder.parameters().name + "/force");
  for (const Section& section : boom->sections()) {
    for (const char* field : {"force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"})
      names.push_back("section_loads/" + section.name() + "/" + field);
  }
  return names;
}

}  // namespace hammer_loads
