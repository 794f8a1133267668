/// count_cycles: load cycles of any series, one number a line on stdin, as CSV on stdout.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/replace_file.h"
#include "hammer_loads/life/count_csv.h"
#include "hammer_loads/life/count_state.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr char kNotes[] =
    "Out: range,mean,count of ASTM E1049-85 (4-point rule, residue as half cycles), by range, then by mean.\n"
    "Without a full scale every value counts as it is (--exact), and memory grows with the series.\n"
    "With --state the series goes on where FILE ends, the output is the count of all so far, and FILE is replaced.\n"
    "nan and inf are skipped; empty lines are ignored.";

struct Options {
  bool exact{false};
  std::vector<double> full_scale;
  std::int64_t classes{4096};
  std::string state;
};

/// A number, nan or inf, as a measurement may hold them; nothing for anything else.
std::optional<double> valueOf(const std::string& text) {
  const bool plain = text.find_first_not_of("0123456789+-.eE") == std::string::npos;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole = end == text.c_str() + text.size();
  if (plain) return whole && std::isfinite(value) ? std::make_optional(value) : std::nullopt;
  const bool word = text.find_first_of("0123456789xX(") == std::string::npos;
  return whole && word ? std::make_optional(value) : std::nullopt;
}

/// Without spaces at both ends, so that an empty line is empty.
std::string trimmed(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// False after a line that is no number, with one line on stderr.
template <typename Counter>
bool countSeries(Counter& counter) {
  std::string line;
  for (std::uint64_t number = 1; std::getline(std::cin, line); ++number) {
    const std::string text = trimmed(line);
    if (text.empty()) continue;
    const std::optional<double> value = valueOf(text);
    if (!value) {
      std::cerr << "stdin: line " << number << ": " << describe(YAML::Node(onOneLine(text)))
                << ", must be a finite number, nan or inf\n";
      return false;
    }
    counter.add(*value);
  }
  if (!std::cin.bad()) return true;
  std::cerr << "stdin: cannot be read\n";
  return false;
}

/// Count of stdin, of the same kind as `before`.
std::optional<life::Count> counted(const life::Count& before) {
  if (const auto* on_grid = std::get_if<life::CycleCount>(&before)) {
    life::CycleCounter counter(on_grid->grid);
    if (!countSeries(counter)) return std::nullopt;
    return counter.take();
  }
  life::ExactCycles exact;
  if (!countSeries(exact)) return std::nullopt;
  return exact;
}

/// A count of nothing, as the options ask for.
Checked<life::Count> emptyCount(const Options& options) {
  Checked<life::Count> result;
  if (options.full_scale.empty()) {
    result.value = life::ExactCycles{};
    return result;
  }
  const auto grid = life::LoadGrid::make(options.full_scale[0], options.full_scale[1], options.classes);
  for (const std::string& problem : grid.problems) result.problems.push_back("--" + problem);
  if (grid.value) result.value = life::CycleCount(*grid.value);
  return result;
}

std::string kindText(const life::Count& count) {
  if (const auto* on_grid = std::get_if<life::CycleCount>(&count))
    return "full scale " + life::shortNumber(on_grid->grid.least()) + " to " +
           life::shortNumber(on_grid->grid.greatest()) + ", " + std::to_string(on_grid->grid.classes()) + " classes";
  return "exact";
}

/// The count to go on with: the saved one, else one of nothing. Nothing after one line on stderr.
std::optional<life::Count> savedCount(const Options& options, const life::Count& empty) {
  if (options.state.empty()) return empty;
  std::string problem;
  const std::optional<std::string> text = readToReplace(options.state, problem);
  if (!text) {
    std::cerr << problem << '\n';
    return std::nullopt;
  }
  std::error_code error;
  if (text->empty() && !std::filesystem::exists(options.state, error)) return empty;
  Checked<life::Count> saved = life::countFromState(*text);
  if (!saved.value) {
    std::cerr << options.state << ": is no state of count_cycles: " << saved.problems.front() << '\n';
    return std::nullopt;
  }
  const bool free = !options.exact && options.full_scale.empty();
  if (!free && kindText(*saved.value) != kindText(empty)) {
    std::cerr << options.state << ": " << kindText(*saved.value) << ", must be as asked for: " << kindText(empty)
              << '\n';
    return std::nullopt;
  }
  return std::move(saved.value);
}

void warn(const life::SampleTally& tally) {
  if (tally.counted == 0) std::cerr << "warning: stdin: no number to count\n";
  if (tally.skipped > 0) std::cerr << "warning: stdin: " << tally.skipped << " skipped, not a finite load\n";
  if (tally.below + tally.above > 0)
    std::cerr << "warning: stdin: " << tally.below << " below and " << tally.above
              << " above the full scale, counted at its ends\n";
}

int countAll(const Options& options) {
  const Checked<life::Count> empty = emptyCount(options);
  for (const std::string& problem : empty.problems) std::cerr << problem << '\n';
  if (!empty.value) return kExitWrongUsage;
  std::optional<life::Count> sum = savedCount(options, *empty.value);
  if (!sum) return kExitFailure;
  const std::optional<life::Count> piece = counted(*sum);
  if (!piece) return kExitFailure;
  std::optional<ReplaceLock> lock;
  if (!options.state.empty()) {  // while the series came another run may have gone on from the file
    lock.emplace(options.state);
    if (!lock->problem().empty()) std::cerr << lock->problem() << '\n';
    if (!lock->problem().empty()) return kExitFailure;
    const std::string kind = kindText(*sum);
    sum = savedCount(options, *empty.value);
    if (sum && kindText(*sum) != kind) std::cerr << options.state << ": has become another kind of count meanwhile\n";
    if (!sum || kindText(*sum) != kind) return kExitFailure;
  }

  life::SampleTally tally;
  if (auto* on_grid = std::get_if<life::CycleCount>(&*sum)) {
    tally = std::get<life::CycleCount>(*piece).tally;
    on_grid->append(std::get<life::CycleCount>(*piece));
  } else {
    tally = std::get<life::ExactCycles>(*piece).tally();
    std::get<life::ExactCycles>(*sum).append(std::get<life::ExactCycles>(*piece));
  }
  warn(tally);
  std::cout << life::csvText(std::visit([](const auto& count) { return life::rangesAndMeans(count); }, *sum));
  if (const int failure = finishOutput()) return failure;
  if (options.state.empty()) return 0;
  // Last: a run that failed can be repeated.
  const std::optional<std::string> problem = replaceFile(options.state, life::stateText(*sum));
  if (problem) std::cerr << *problem << '\n';
  return problem ? kExitFailure : 0;
}

int run(int argc, const char* const* argv) {
  CommandLine line("Load cycles of any series: one number a line on stdin, CSV on stdout", "count_cycles", kNotes);
  Options options;
  line.flag("--exact", options.exact, "every value as it is");
  line.option("--full-scale", options.full_scale, "count on a grid from LO to HI")
      .values(2, 2)
      .type("LO HI")
      .within(-kInfinity, kInfinity, "")
      .excludes({"--exact"});
  line.option("--classes", options.classes, "of the grid")
      .type("N")
      .withinIntegers(2, life::LoadGrid::kMostClasses)
      .needs("--full-scale")
      .showDefault();
  line.option("--state", options.state, "go on from this file and replace it").type("FILE");
  if (const auto code = line.parse(argc, argv)) return *code;
  std::ios::sync_with_stdio(false);
  return countAll(options);
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
