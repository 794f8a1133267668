#include "hammer_loads/settings/load.h"

#include <dlfcn.h>

#include <filesystem>

#include "hammer_loads/hammer/choose_level.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/settings/version.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

#ifndef HAMMER_LOADS_CONFIG_DIR
#error "HAMMER_LOADS_CONFIG_DIR must name the source tree's config directory"
#endif

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

/// Returns the conflict between model, boom file and robot description; empty if they agree.
std::string boomConflict(BoomModel model, bool boom_file, bool description) {
  if (description && model == BoomModel::kCompliant && !boom_file)
    return "boom: compliant, must be none, rigid or auto without a boom file: its cylinders' oil is the spring";
  if (description || model == BoomModel::kNone) return {};
  if (boom_file) return "robot_description: missing, must be given (a URDF) with a boom file, or boom must be none";
  if (model == BoomModel::kAuto) return {};
  return "robot_description: missing, must be given (a URDF), or boom must be none or auto";
}

/// Returns the conflict of other keys with a boom that vibrates, or does not; empty if they agree.
std::string vibrationConflict(const PipelineSettings& pipeline, bool boom_file, bool vibrates) {
  if (vibrates && pipeline.boom_acceleration == BoomAcceleration::kDifference)
    return "boom_acceleration: difference, must be none with a boom that may be compliant: where the joints' sensors "
           "see the vibration, it would count twice";
  if (!vibrates && pipeline.boom_stiffness == BoomStiffness::kIdentified)
    return "boom_stiffness: identified, must be given without a boom on its cylinders' oil (boom: compliant or auto, "
           "and a boom file)";
  if (!boom_file && pipeline.hull_motion == HullMotionSource::kModel)
    return "hull_motion: model, must be unmeasured, fixed or imu without a boom file: its cylinders' oil is the spring";
  return {};
}

/// Reads the boom. Returns nothing if there is none or if the reader has a problem with it.
std::optional<Boom> readBoom(ParameterReader& reader, bool boom_file, const PipelineSettings& pipeline,
                             const std::optional<RobotDescription>& description, std::vector<std::string>& notes) {
  const std::size_t problems_before = reader.problems().size();
  const BoomModel model = pipeline.boom;
  const BoomParameters parameters = boom_file ? readBoomParameters(reader) : BoomParameters{};
  const std::string& tip = parameters.chain.tip;
  ChainRequest whole;
  whole.tip = pipeline.hull_frame;
  if (boom_file && whole.tip != ChainRequest{}.tip && whole.tip != tip)
    reader.addProblem("hull_frame: " + whole.tip + ", must be tip_link of the boom file, " + tip);
  const std::string conflict = boomConflict(model, boom_file, description.has_value());
  if (!conflict.empty()) reader.addProblem(conflict);
  if (!description || model == BoomModel::kNone || reader.problems().size() != problems_before) return {};
  if (!boom_file && model == BoomModel::kAuto) {
    const std::string missing = linksMissing(*description, whole);
    if (!missing.empty()) {
      notes.push_back(missing + ": no boom, the hammer's loads on its hull alone");
      return {};
    }
  }
  Checked<Boom> boom = boom_file ? Boom::make(*description, parameters) : Boom::make(*description, whole);
  for (const std::string& problem : boom.problems) reader.addProblem(problem);
  notes.insert(notes.end(), boom.notes.begin(), boom.notes.end());
  return std::move(boom.value);
}

/// Takes the weight's axes and zeros from the description if there is no boom. Contradicting signs are a problem.
void takePitchChain(ParameterReader& reader, PipelineSettings& pipeline, const std::optional<Boom>& boom,
                    const std::optional<RobotDescription>& description, std::vector<std::string>& notes) {
  const std::vector<std::string>& joints = pipeline.pitch_joints;
  if (!description || joints.empty() || !reader.problems().empty()) return;
  if (!boom) {
    const std::optional<ChainRequest> request = chainOver(*description, joints);
    if (request) pipeline.pitch_chain = Chain::make(*description, *request).value;
    if (pipeline.pitch_chain)
      notes.push_back("weight by the robot description's axes and zeros, from " + request->root + " to " +
                      request->tip);
  }
  const std::optional<Chain> chain = boom ? boom->chain() : pipeline.pitch_chain;
  if (!chain || pipeline.pitch_signs.empty()) return;
  const PitchOfChain described = pitchOf(*chain, joints);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (described.joints != joints || described.signs[i] == pipeline.pitch_signs[i]) continue;
    reader.addProblem(format("pitch_signs: %d for %s, must be %d as its axis in the robot description, or []",
                             pipeline.pitch_signs[i], joints[i].c_str(), described.signs[i]));
  }
}

std::string withoutDriveInertia(std::string yaml) {
  const std::size_t begin = yaml.find("drive_inertia_kg_m2:");
  if (begin != std::string::npos) yaml.erase(begin, yaml.find('\n', begin) - begin + 1);
  return yaml;
}

/// Returns the keys of the known topics, one a line.
std::string yamlOf(const InputTopics& topics) {
  std::string yaml;
  for (const InputName& input : kInputs) {
    const std::string& topic = topics.*input.topic;
    if (!topic.empty()) yaml += std::string(input.key) + ": " + quotedText(topic) + "\n";
  }
  return yaml;
}

Checked<Settings> settingsFrom(ParameterMap parameters, const std::string& robot_description, bool hammer_given) {
  Checked<Settings> result;
  const bool boom_file = hasBoomKey(parameters);
  ParameterReader reader(std::move(parameters));
  const std::optional<Mechanism> mechanism = readMechanism(reader, result.notes);
  const std::string hammer_yaml = reader.yaml();
  PipelineSettings pipeline = readPipelineSettings(reader);
  const LogSettings log = readLogSettings(reader);
  const std::size_t before_boom = reader.yaml().size();
  std::optional<RobotDescription> description;
  if (!robot_description.empty()) description.emplace(robot_description);
  std::optional<Boom> boom = readBoom(reader, boom_file, pipeline, description, result.notes);
  const std::string boom_yaml = reader.yaml().substr(before_boom);
  const bool vibrates = boom_file && pipeline.boom != BoomModel::kNone && pipeline.boom != BoomModel::kRigid;
  const std::string conflict = vibrationConflict(pipeline, boom_file, vibrates);
  if (!conflict.empty()) reader.addProblem(conflict);
  takePitchChain(reader, pipeline, boom, description, result.notes);
  life::LifeSettings life = readLifeSettings(reader);
  // Channels can be checked only if the boom is known.
  if (reader.problems().empty()) checkChannels(life, channelNames(boom ? &*boom : nullptr), reader);
  std::vector<Limit> limits = readLimits(reader, life);
  const InputTopics topics = readInputTopics(reader);  // last, so that they are the end of the YAML
  reader.reportUnknownKeys();
  result.problems = reader.problems();
  if (!mechanism || !result.problems.empty()) return result;
  if (pipeline.choose_level) {
    const bool means = pipeline.output == OutputKind::kMean && pipeline.output_rate > 0.0;
    const double interval = means ? 1.0 / pipeline.output_rate : 1e-3;
    const LevelChoice choice =
        chooseLevel(*mechanism, pipeline.tolerance, pipeline.turn_rate, pipeline.gravity, interval);
    pipeline.level = choice.level;
    result.notes.push_back(describe(choice));
  }
  result.value = Settings{*mechanism,
                          pipeline,
                          log,
                          std::move(life),
                          std::move(limits),
                          std::move(boom),
                          hammer_given,
                          robot_description,
                          reader.yaml(),
                          withoutDriveInertia(hammer_yaml) + boom_yaml + robot_description,
                          {},
                          topics};
  return result;
}

}  // namespace

Checked<Settings> load(const std::string& config_directory, ParameterMap given, const std::string& robot_description) {
  std::vector<std::string> problems;
  addLimitsFile(given, problems);
  const bool hammer_given = hasHammerKey(given);
  std::vector<std::string> shipped{config_directory + "/pipeline.yaml", config_directory + "/log.yaml",
                                   config_directory + "/life.yaml"};
  if (!hammer_given) shipped.push_back(config_directory + "/hammer_mo100.yaml");
  Checked<Settings> result = loadFrom(shipped, [&](ParameterMap parameters) {
    leaveOutUnwantedChannels(given, parameters);
    merge(given, parameters);
    return settingsFrom(std::move(parameters), robot_description, hammer_given);
  });
  if (result.value) result.value->notes = result.notes;
  return behind(problems, std::move(result));
}

Checked<Settings> loadFiles(const std::string& config_directory, const std::vector<std::string>& files,
                            const std::string& robot_description) {
  return loadFrom(files,
                  [&](ParameterMap given) { return load(config_directory, std::move(given), robot_description); });
}

Checked<Settings> withChanges(const Settings& settings, const std::vector<std::pair<std::string, double>>& changes) {
  std::vector<std::string> problems;
  ParameterMap parameters = parameterMap(YAML::Load(settings.yaml), {}, problems).value();
  for (const auto& [key, value] : changes) parameters.at(key).value = YAML::Node(numberText(value));
  Checked<Settings> changed = settingsFrom(std::move(parameters), settings.robot_description, settings.hammer_given);
  if (changed.value) changed.value->notes = std::move(changed.notes);
  return changed;
}

Settings withInputTopics(Settings settings, const InputTopics& topics) {
  settings.yaml.erase(settings.yaml.size() - yamlOf(settings.input_topics).size());
  settings.yaml += yamlOf(topics);
  settings.input_topics = topics;
  return settings;
}

const char* packageVersion() { return HAMMER_LOADS_VERSION; }

std::string configDirectory() {
  std::error_code error;
  std::vector<fs::path> candidates;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);  // PREFIX/lib/hammer_loads/PROGRAM
  if (!error) candidates.push_back(program.parent_path() / "../../share/hammer_loads/config");
  // PREFIX/lib/LIBRARY or, in Debian, PREFIX/lib/ARCHITECTURE/LIBRARY: nodelets and Python run in other programs.
  Dl_info library{};
  if (dladdr(reinterpret_cast<void*>(&configDirectory), &library) != 0 && library.dli_fname != nullptr) {
    for (const char* share : {"../share/hammer_loads/config", "../../share/hammer_loads/config"})
      candidates.push_back(fs::path(library.dli_fname).parent_path() / share);
  }
  for (const fs::path& candidate : candidates) {
    // Debian's /lib is a link to /usr/lib: the target's parent is not the parent in the path.
    if (fs::exists(candidate / "pipeline.yaml", error)) return fs::canonical(candidate).string();
  }
  return HAMMER_LOADS_CONFIG_DIR;
}

}  // namespace hammer_loads
