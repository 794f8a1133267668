#include "hammer_loads/life/count_state.h"

#include <cerrno>
#include <cinttypes>
#include <cstdlib>

#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::life {
namespace {

constexpr char kTitle[] = "hammer_loads cycle count 1";

/// FNV-1a, 64 bit: against a truncated or edited file, not against intent.
std::uint64_t checksum(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

std::string headText(const SampleTally& tally, const Extremes& extremes) {
  std::string line = "tally";
  for (const std::uint64_t value :
       {tally.counted, tally.skipped, tally.below, tally.above, tally.gaps, tally.deviations, tally.deviation_sum})
    line += format(" %" PRIu64, value);
  return line + '\n' + format("extremes %.17g %.17g\n", extremes.least, extremes.greatest);
}

std::string bodyText(const CycleCount& count) {
  std::string text = format("grid %.17g %.17g %u\n", count.grid.least(), count.grid.greatest(), count.grid.classes());
  text += headText(count.tally, count.extremes);
  text += format("cycles %zu\n", count.closed.size());
  for (const ClosedCycles& c : count.closed) text += format("%u %u %" PRIu64 "\n", c.steps, c.low, c.count);
  text += format("residue %zu\n", count.residue.size());
  for (const std::uint32_t point : count.residue) text += format("%u\n", point);
  return text;
}

std::string bodyText(const ExactCycles& count) {
  std::string text = "exact\n" + headText(count.tally(), count.extremes());
  text += format("cycles %zu\n", count.closed().size());
  for (const auto& [pair, cycles] : count.closed())
    text += format("%.17g %.17g %" PRIu64 "\n", pair.first, pair.second, cycles);
  text += format("residue %zu\n", count.residue().size());
  for (const double point : count.residue()) text += format("%.17g\n", point);
  return text;
}

/// Words of a text, one after another; once one is wrong, all that follow are.
class Words {
 public:
  explicit Words(const std::string& text) : at_(text.c_str()), end_(at_ + text.size()) {}

  bool good() const { return good_; }
  bool finished() const { return good_ && at_ == end_; }
  void expect(const char* word) {
    if (take() != word) fail();
  }
  std::uint64_t integer(std::uint64_t most = UINT64_MAX) {
    const std::string text = take();
    if (text.empty() || text.size() > 20 || text.find_first_not_of("0123456789") != std::string::npos) return fail();
    errno = 0;
    const std::uint64_t value = std::strtoull(text.c_str(), nullptr, 10);
    return errno == 0 && value <= most ? value : fail();
  }
  std::uint32_t index() { return static_cast<std::uint32_t>(integer(LoadGrid::kMostClasses)); }
  double number() {
    const std::string text = take();
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') fail();
    return value;
  }

  /// Up to the next space or line break, which is taken too.
  std::string take() {
    const char* begin = at_;
    while (at_ != end_ && *at_ != ' ' && *at_ != '\n') ++at_;
    std::string word(begin, at_);
    if (at_ == end_) {
      fail();
    } else {
      ++at_;
    }
    return word;
  }

 private:
  std::uint64_t fail() {
    good_ = false;
    return 0;
  }

  const char *at_, *end_;
  bool good_{true};
};

void readHead(Words& words, SampleTally& tally, Extremes& extremes) {
  words.expect("tally");
  for (std::uint64_t* value : {&tally.counted, &tally.skipped, &tally.below, &tally.above, &tally.gaps,
                               &tally.deviations, &tally.deviation_sum}) {
    *value = words.integer();
  }
  words.expect("extremes");
  extremes.least = words.number();
  extremes.greatest = words.number();
}

std::optional<Count> readGrid(Words& words) {
  const double least = words.number(), greatest = words.number();
  const Checked<LoadGrid> grid = LoadGrid::make(least, greatest, words.index());
  if (!words.good() || !grid.value) return std::nullopt;
  CycleCount count(*grid.value);
  readHead(words, count.tally, count.extremes);
  words.expect("cycles");
  for (std::uint64_t left = words.integer(); left > 0 && words.good(); --left) {
    const std::uint32_t steps = words.index(), low = words.index();
    count.closed.push_back({steps, low, words.integer()});
  }
  words.expect("residue");
  for (std::uint64_t left = words.integer(); left > 0 && words.good(); --left) count.residue.push_back(words.index());
  if (!words.good() || !isPossible(count)) return std::nullopt;
  return count;
}

std::optional<Count> readExact(Words& words) {
  SampleTally tally;
  Extremes extremes;
  readHead(words, tally, extremes);
  words.expect("cycles");
  ExactCycles::Closed closed;
  for (std::uint64_t left = words.integer(); left > 0 && words.good(); --left) {
    const double low = words.number(), high = words.number();
    if (!CycleCounter::isLoad(low) || !CycleCounter::isLoad(high)) return std::nullopt;
    closed[{low, high}] = words.integer();
  }
  words.expect("residue");
  std::vector<double> residue;
  for (std::uint64_t left = words.integer(); left > 0 && words.good(); --left) residue.push_back(words.number());
  if (!words.good()) return std::nullopt;
  std::optional<ExactCycles> count = ExactCycles::restore(std::move(closed), residue, tally, extremes);
  if (!count) return std::nullopt;
  return *std::move(count);
}

}  // namespace

bool isPossible(const CycleCount& count) {
  const std::uint32_t classes = count.grid.classes();
  const ClosedCycles* before = nullptr;
  for (const ClosedCycles& cycles : count.closed) {
    if (cycles.steps == 0 || cycles.steps >= classes || cycles.low >= classes - cycles.steps) return false;
    if (cycles.count == 0 || (before != nullptr && !(*before < cycles))) return false;
    before = &cycles;
  }
  for (const std::uint32_t point : count.residue) {
    if (point >= classes) return false;
  }
  std::vector<std::uint32_t> joined;
  std::vector<ClosedCycles> closed;
  joinResidues(joined, count.residue, closed);
  return joined == count.residue;
}

std::string stateText(const Count& count) {
  std::string text = std::string(kTitle) + '\n' + std::visit([](const auto& c) { return bodyText(c); }, count);
  return text + format("checksum %016" PRIx64 "\n", checksum(text));
}

Checked<Count> countFromState(const std::string& text) {
  constexpr std::size_t kLastLine = sizeof("checksum 0123456789abcdef\n") - 1;
  Checked<Count> result;
  if (text.rfind(kTitle, 0) != 0) {
    result.problems.push_back(std::string("must begin with the line \"") + kTitle + '"');
    return result;
  }
  const std::size_t size = text.size() > kLastLine ? text.size() - kLastLine : 0;
  const std::string body = text.substr(0, size);
  if (text.substr(size) != format("checksum %016" PRIx64 "\n", checksum(body))) {
    result.problems.emplace_back("damaged: its checksum does not fit");
    return result;
  }
  Words words(body);
  for (const char* word : {"hammer_loads", "cycle", "count", "1"}) words.expect(word);
  const std::string kind = words.take();
  if (kind == "exact") result.value = readExact(words);
  if (kind == "grid") result.value = readGrid(words);
  if (!result.value || !words.finished()) {
    result.value.reset();
    result.problems.emplace_back("no series gives what it says");
  }
  return result;
}

}  // namespace hammer_loads::life
