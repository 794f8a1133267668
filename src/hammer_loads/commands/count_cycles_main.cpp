/// count_cycles: load cycles of any series, one number a line on stdin, as CSV on stdout.
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <optional>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads {
namespace {

constexpr char kNotes[] =
    "Out: range,mean,count of ASTM E1049-85 (4-point rule, residue as half cycles), by range, then by mean.\n"
    "Without a full scale every value counts as it is (--exact), and memory grows with the series.\n"
    "nan and inf are skipped; empty lines are ignored.";

/// A finite number, nan or inf, as a measurement may hold them; nothing for anything else.
std::optional<double> valueOf(const std::string& text) {
  const std::optional<double> number = decimalNumber(text);
  if (number) return std::isfinite(*number) ? number : std::nullopt;
  char* end = nullptr;
  const double word = std::strtod(text.c_str(), &end);
  const bool whole = end == text.c_str() + text.size();
  const bool is_word = whole && text.find_first_of("0123456789xX(") == std::string::npos;
  return is_word ? std::make_optional(word) : std::nullopt;
}

/// False after a line that is no number, with one line on stderr.
template <typename Counter>
bool countSeries(Counter& counter) {
  std::string line;
  for (std::uint64_t number = 1; std::getline(std::cin, line); ++number) {
    const std::string text = boost::trim_copy_if(line, boost::is_any_of(" \t\r"));
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

void warn(const life::SampleTally& tally) {
  if (tally.counted == 0) std::cerr << "warning: stdin: no number to count\n";
  if (tally.skipped > 0) std::cerr << "warning: stdin: " << tally.skipped << " skipped, not a finite load\n";
  if (tally.below + tally.above > 0)
    std::cerr << "warning: stdin: " << tally.below << " below and " << tally.above
              << " above the full scale, counted at its ends\n";
}

template <typename Count>
int print(const Count& count, const life::SampleTally& tally) {
  warn(tally);
  std::cout << "range,mean,count\n";
  for (const life::RangeMean& c : life::rangesAndMeans(count))
    std::cout << shortNumber(c.range) << ',' << shortNumber(c.mean) << ',' << shortNumber(c.count) << '\n';
  return finishOutput();
}

int run(int argc, const char* const* argv) {
  CommandLine line("Load cycles of any series: one number a line on stdin, CSV on stdout", "count_cycles", kNotes);
  bool exact = false;
  std::vector<double> full_scale;
  std::int64_t classes = 4096;
  line.add_flag("--exact", exact, "every value as it is");
  line.add_option("--full-scale", full_scale, "count on a grid from LO to HI")
      ->expected(2, 2)
      ->type_name("LO HI")
      ->check(within(-kInfinity, kInfinity, ""))
      ->excludes("--exact");
  line.add_option("--classes", classes, "of the grid")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{2}, std::int64_t{life::LoadGrid::kMostClasses}))
      ->needs("--full-scale")
      ->capture_default_str();
  if (const auto code = line.parse(argc, argv)) return *code;
  std::ios::sync_with_stdio(false);
  if (full_scale.empty()) {
    life::ExactCycles counter;
    return countSeries(counter) ? print(counter, counter.tally()) : kExitFailure;
  }
  const auto grid = life::LoadGrid::make(full_scale[0], full_scale[1], classes);
  for (const std::string& problem : grid.problems) std::cerr << "--" << problem << '\n';
  if (!grid.value) return kExitWrongUsage;
  life::CycleCounter counter(*grid.value);
  if (!countSeries(counter)) return kExitFailure;
  const life::CycleCount count = counter.take();
  return print(count, count.tally);
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
