// Counts any series as a whole and in pieces: the counts agree and are possible.
//
// The bytes of an input are the classes, then samples, each an operation and its arguments. Bytes missing at the end
// count as zeros.
#include <cmath>
#include <cstdint>

#include "fuzz/bytes.h"
#include "hammer_loads/life/cycle_counter.h"
#include "support/count_text.h"

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
    append(piece_.take(), sum_);
    const CycleCount whole = whole_.take();
    require(textOf(whole) == textOf(sum_));
    require(isPossible(whole));
    check(rangesAndMeans(whole));
    check(rangesAndMeans(exact_));
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
  }

  /// Replaces the counter by a new one, as after a restart.
  void cut() {
    append(piece_.take(), sum_);
    piece_ = CycleCounter(grid_);
  }

  /// Checks that ranges and means are finite and sorted by range.
  static void check(const std::vector<RangeMean>& cycles) {
    double before = 0.0;
    for (const RangeMean& c : cycles) {
      require(std::isfinite(c.range) && std::isfinite(c.mean) && c.range > 0.0 && c.range >= before && c.count > 0.0);
      before = c.range;
    }
  }

  Bytes bytes_;
  LoadGrid grid_;
  CycleCounter whole_, piece_;
  CycleCount sum_;
  ExactCycles exact_;
  std::uint64_t samples_{};
};

}  // namespace
}  // namespace hammer_loads::life

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace life = hammer_loads::life;
  life::Session(life::Bytes(data, size)).run();
  return 0;
}
