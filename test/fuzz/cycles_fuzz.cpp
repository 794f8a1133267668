// Any series, whole and in pieces: the counts agree and are possible. Any text: a state, or one line.
//
// Bytes of an input: the classes, then samples, each an operation and its arguments; what is cut off at the end counts
// as zeros. The whole input is also read as a saved state, with the checksum that it has and with the one that fits.
#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <string>

#include "fuzz/bytes.h"
#include "hammer_loads/life/count_state.h"
#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::life {
namespace {

using test::Bytes;
using test::require;

class Session {
 public:
  explicit Session(Bytes bytes)
      : bytes_(bytes),
        grid_(LoadGrid::make(-1000.0, 1000.0, 2 + bytes_.take<std::uint8_t>()).value.value()),
        whole_(grid_),
        piece_(grid_),
        sum_(grid_) {}

  void run() {
    while (!bytes_.empty()) step();
    sum_.append(piece_.take());
    exact_sum_.append(exact_piece_);
    const CycleCount whole = whole_.take();
    require(stateText(whole) == stateText(sum_) && stateText(exact_) == stateText(exact_sum_));
    check(whole);
    check(exact_);
    require(whole.residue.size() < 2 * grid_.classes());
    require(whole.tally.counted + whole.tally.skipped == samples_);
    require(exact_.tally().counted == whole.tally.counted);
  }

 private:
  void step() {
    const auto operation = bytes_.take<std::uint8_t>();
    switch (operation % 8) {
      case 0:
        return sample(bytes_.take<double>());
      case 1: {  // a plateau
        const double value = bytes_.take<std::int16_t>();
        for (int i = 0; i < operation / 8; ++i) sample(value);
        return;
      }
      case 2:
        return cut();
      case 3:
        whole_.gap();
        piece_.gap();
        exact_.gap();
        exact_piece_.gap();
        return;
      default:
        return sample(bytes_.take<std::int8_t>() * 8.0);
    }
  }

  void sample(double value) {
    ++samples_;
    whole_.add(value);
    piece_.add(value);
    exact_.add(value);
    exact_piece_.add(value);
  }

  /// A new counter, as after a restart.
  void cut() {
    sum_.append(piece_.take());
    piece_ = CycleCounter(grid_);
    exact_sum_.append(exact_piece_);
    exact_piece_ = ExactCycles();
  }

  /// Ranges and means of a series within its extremes, the largest range theirs; the state is read back.
  template <typename Kind>
  void check(const Kind& count) {
    const Count any(count);
    const Checked<Count> read = countFromState(stateText(any));
    require(read.value && stateText(*read.value) == stateText(any));
    double before = 0.0;
    for (const RangeMean& c : rangesAndMeans(count)) {
      require(std::isfinite(c.range) && std::isfinite(c.mean) && c.range > 0.0 && c.range >= before && c.count > 0.0);
      before = c.range;
    }
  }

  Bytes bytes_;
  LoadGrid grid_;
  CycleCounter whole_, piece_;
  CycleCount sum_;
  ExactCycles exact_, exact_piece_, exact_sum_;
  std::uint64_t samples_{};
};

void readAsState(const std::string& text) {
  const Checked<Count> state = countFromState(text);
  require(state.value ? state.problems.empty() : state.problems.size() == 1);
  if (state.value) require(countFromState(stateText(*state.value)).value.has_value());
}

std::string withChecksum(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return text + format("checksum %016" PRIx64 "\n", hash);
}

}  // namespace
}  // namespace hammer_loads::life

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace life = hammer_loads::life;
  life::Session(life::Bytes(data, size)).run();
  const std::string text(reinterpret_cast<const char*>(data), size);
  life::readAsState(text);
  life::readAsState(life::withChecksum(text.substr(0, text.rfind("checksum"))));
  return 0;
}
