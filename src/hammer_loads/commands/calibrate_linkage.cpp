#include <Eigen/Core>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/calibration/linkage_fit.h"
#include "hammer_loads/commands/calibrate.h"
#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

using calibration::LinkageUnknowns;

/// First line of its file, by which the command recognises it.
constexpr const char* kLinkageYamlBegins = "# Bucket linkage fitted by calibrate --linkage to";

struct LinkageArguments {
  std::string table, output, cylinder{"hammer_cylinder"}, urdf;
  std::vector<std::string> params;
  double tape_std{0.01};
  bool force{};
};

/// Place of the joint in the link before, and place of the link beyond relative to it.
struct Frames {
  Eigen::Vector2d origin{0.0, 0.0};
  Eigen::Matrix3d at_zero = Eigen::Matrix3d::Identity();
  double sense{1.0};
};

void addLinkageOptions(CommandLine& line, LinkageArguments& given) {
  line.add_option("--linkage", given.table, "columns stroke_m,angle_rad over the whole stroke")
      ->required()
      ->type_name("TABLE.csv");
  line.add_option("--write", given.output, "keys of the linkage, for --params after the boom file")
      ->required()
      ->type_name("FILE.yaml");
  line.add_option("--cylinder", given.cylinder, "name of the cylinder, in front of its keys")
      ->type_name("NAME")
      ->capture_default_str();
  addParamsOption(line, given.params)
      ->description("boom file: its keys of the cylinder's pins and links count as measured with a tape");
  addUrdfOption(line, given.urdf)
      ->description("robot description, for the place and the axis of the joint NAME_joint of --params");
  line.add_option("--tape-std", given.tape_std, "standard deviation of what was measured [m]")
      ->check(within(1e-5, 1.0, "m"))
      ->capture_default_str();
  line.add_flag("--force", given.force, "replaces a file that exists");
}

/// Frame of the joint in the description; the joint's origin and +y without one.
std::vector<std::string> findFrames(ParameterReader& reader, const LinkageArguments& given, Frames& frames) {
  const std::string key = given.cylinder + "_joint";
  if (given.urdf.empty()) return {};
  const Checked<std::string> text = fileText(given.urdf);
  if (!text.value) return text.problems;
  if (!reader.given(key)) return {key + ": missing, is required with --urdf"};
  ChainRequest request;
  request.massless = true;
  if (reader.given("root_link")) request.root = reader.text("root_link");
  if (reader.given("tip_link")) request.tip = reader.text("tip_link");
  const std::string name = reader.text(key);
  request.joints = {name};
  const Checked<Chain> chain = Chain::make(*text.value, request);
  if (!chain.value) return chain.problems;
  const std::optional<int> joint = chain.value->jointIndex(name);
  if (!joint) return {key + ": " + name + ", must be a joint of the chain"};
  const ChainLink& link = chain.value->link(chain.value->linkBeyond(*joint));
  if (std::abs(std::abs(link.axis.y()) - 1.0) > 1e-6) return {key + ": " + name + ", must turn about y"};
  frames = {{link.origin.x(), link.origin.z()}, link.steady + link.cosine, link.axis.y() > 0.0 ? 1.0 : -1.0};
  return {};
}

/// Pins of the link before are measured from its frame's origin.
double originOf(int unknown, const Frames& frames) {
  const bool before = unknown < LinkageUnknowns::kGuide;
  return before ? frames.origin[unknown % 2] : 0.0;
}

calibration::LinkageBasis tapeOf(ParameterReader& reader, const LinkageArguments& given, const Frames& frames) {
  calibration::LinkageBasis basis;
  basis.tape_std = given.tape_std, basis.sense = frames.sense;
  for (int i = 0; i < LinkageUnknowns::kCount; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::string key = given.cylinder + "_" + LinkageUnknowns::kKeys[at];
    if (reader.given(key))
      basis.measured[at] = reader.number(key, "m", NumberRule::within(-100.0, 100.0)) - originOf(i, frames);
  }
  auto &x = basis.measured[LinkageUnknowns::kRodX], &z = basis.measured[LinkageUnknowns::kRodZ];
  if (x && z) {
    const Eigen::Vector3d turned = frames.at_zero * Eigen::Vector3d(*x, 0.0, *z);
    x = turned.x(), z = turned.z();
  }
  return basis;
}

std::string wordsOf(const calibration::LinkageFit& fit) {
  std::string text = format(
      "%zu rows: strokes left %.3f mm rms, %.3f mm at worst; lever %.4f m/rad rms, known to %.2f %% (limit 1 %%)%s\n",
      fit.rows, 1e3 * fit.left, 1e3 * fit.worst, fit.arm, 100.0 * fit.arm_std / fit.arm,
      fit.determined() ? "" : ": NOT DETERMINED, nothing is written");
  for (const calibration::Estimate& e : fit.estimates)
    text += format("%-44s %.4f m +- %.2g; %s\n", e.key.c_str(), e.value, e.deviation, e.meaning.c_str());
  return text + notesOf(fit);
}

std::string yamlOf(const calibration::LinkageFit& fit, const LinkageArguments& given, const Frames& frames) {
  const std::string name = given.cylinder + "_";
  std::string text = std::string(kLinkageYamlBegins) + " " +
                     onOneLine(std::filesystem::path(given.table).filename().string()) + ":\n" +
                     format("# strokes left %.3f mm rms, lever known to %.2f %%. Values belong together.\n",
                            1e3 * fit.left, 100.0 * fit.arm_std / fit.arm) +
                     name + "linkage: bucket\n" + name + "linkage_branch: " + (fit.branch > 0.0 ? "1" : "-1") + "\n";
  LinkageUnknowns::Vector value = fit.value;
  const Eigen::Vector3d rod =
      frames.at_zero.transpose() * Eigen::Vector3d(value[LinkageUnknowns::kRodX], 0.0, value[LinkageUnknowns::kRodZ]);
  value[LinkageUnknowns::kRodX] = rod.x(), value[LinkageUnknowns::kRodZ] = rod.z();
  for (int i = 0; i < LinkageUnknowns::kCount; ++i)
    text += name + LinkageUnknowns::kKeys[static_cast<std::size_t>(i)] + ": " +
            numberText(value[i] + originOf(i, frames)) + "\n";
  return text;
}

}  // namespace

std::optional<int> calibrateLinkage(int argc, const char* const* argv) {
  const auto asks = [](const char* word) { return std::string(word).rfind("--linkage", 0) == 0; };
  if (std::none_of(argv, argv + argc, asks)) return {};
  CommandLine line("Lengths of a cylinder's bucket linkage from a table of stroke and angle", "calibrate");
  LinkageArguments given;
  addLinkageOptions(line, given);
  if (const auto code = line.parse(argc, argv)) return code;
  endCleanlyOnSignals();
  std::vector<std::string> inputs = given.params;
  inputs.push_back(given.table);
  const auto keep = keepUnlessItBegins({kLinkageYamlBegins}, "it holds no linkage that was fitted");
  Checked<OutputFile> file = OutputFile::make({given.output, inputs, given.force, keep});
  if (!file.value) return fail(file.problems);
  std::vector<OutputFile> files;
  files.push_back(*std::move(file.value));
  ParameterMap parameters;
  std::vector<std::string> problems;
  if (!addFiles(given.params, parameters, problems) || !problems.empty()) return fail(problems);
  ParameterReader reader(std::move(parameters));
  Frames frames;
  problems = findFrames(reader, given, frames);
  const calibration::LinkageBasis basis = tapeOf(reader, given, frames);
  problems.insert(problems.end(), reader.problems().begin(), reader.problems().end());
  const Checked<std::string> text = fileText(given.table);
  problems.insert(problems.end(), text.problems.begin(), text.problems.end());
  if (!problems.empty()) return fail(problems);
  std::string problem;
  const std::optional<calibration::StrokeTable> table = calibration::readStrokeTable(*text.value, problem);
  if (!table) return fail({given.table + ": " + problem});
  ProgressBar bar;
  const calibration::LinkageFit fit = calibration::fitLinkage(*table, basis, given.cylinder, std::ref(bar));
  if (!fit.problem.empty()) return fail({given.table + ": " + fit.problem});
  return finishCalibration({{}, wordsOf(fit), fit.determined() ? yamlOf(fit, given, frames) : "", {}}, files);
}

}  // namespace hammer_loads
