// Runs machine time through the pipeline without pause. Usage: pipeline_soak [SAMPLES] default: a day at 1 kHz
#include <chrono>
#include <cstdlib>
#include <numeric>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "soak/endless_session.h"
#include "soak/verdict.h"
#include "support/resident_memory.h"

namespace hammer_loads::soak {
namespace {

constexpr std::uint64_t kDay = 86400000;
constexpr std::uint64_t kMemorySamples = 400;
constexpr std::uint64_t kSettled = 10;  // pieces until the filter's own parameters have settled: 200 s

struct Errors {
  double sum{}, worst{};
  std::uint64_t count{};
  void add(double error) {
    sum += error * error;
    worst = std::max(worst, std::abs(error));
    ++count;
  }
  double rms() const { return std::sqrt(sum / static_cast<double>(count)); }
};

int run(std::uint64_t samples) {
  const auto begin = std::chrono::steady_clock::now();
  EndlessSession session(1000.0);
  Pipeline pipeline(*Mechanism::make(session.machine().hammer).value, loadFiles(configDirectory(), {}).value->pipeline);
  pipeline.boomJoints(0, {simulation::kBoomJoints.begin(), simulation::kBoomJoints.end()}, session.joints(), {});
  const double peak = session.peakForce();
  const std::uint64_t piece = session.pieceSize();
  const std::uint64_t pieces = samples / piece;
  test::MemoryRecord memory;
  Errors first, last;
  std::uint64_t turns = 0, pulses = 0, not_finite = 0;
  for (std::uint64_t i = 0; i < pieces * piece; ++i) {
    const EndlessSample sample = session.next();
    const SampleResult& loads = pipeline.crankSample(sample.stamp, sample.crank);
    turns += loads.turn_ends;
    for (std::size_t k = 0; k < loads.turn_ends; ++k) pulses += loads.ends[k].pulse.has_value();
    if (i % (samples / kMemorySamples) == 0) memory.add(test::residentMemory());
    if (loads.refusal) continue;
    const double error = (loads.wrench.force_z - session.truth(sample.place).load.force_z) / peak;
    not_finite += !std::isfinite(error);
    if (i / piece == kSettled) first.add(error);
    if (i / piece == pieces - 1) last.add(error);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const SampleCounts& counts = pipeline.counts();
  const std::uint64_t refused = std::accumulate(counts.refused.begin(), counts.refused.end(), std::uint64_t{0});

  Verdict verdict;
  verdict.tell("samples", static_cast<double>(pieces * piece));
  verdict.tell("machine_hours", static_cast<double>(pieces * piece) / 3.6e6);
  verdict.tell("turns_per_second", session.turnsPerSecond());
  verdict.tell("seconds", seconds);
  verdict.tell("accepted", static_cast<double>(counts.accepted));
  verdict.tell("refused", static_cast<double>(refused));
  verdict.tell("restarts", static_cast<double>(counts.restarts));
  verdict.tell("turns", static_cast<double>(turns));
  verdict.tell("pulses", static_cast<double>(pulses));
  verdict.tell("memory_first_quarter_MB", 1e-6 * memory.firstQuarter());
  verdict.tell("memory_last_quarter_MB", 1e-6 * memory.lastQuarter());
  verdict.tell("first_rms_error", first.rms());
  verdict.tell("last_rms_error", last.rms());
  verdict.tell("first_worst_error", first.worst);
  verdict.tell("last_worst_error", last.worst);
  verdict.demand(not_finite == 0, "every wrench finite");
  verdict.demand(counts.accepted + refused == pieces * piece, "every sample counted once");
  verdict.demand(refused <= 10, "no good sample refused once the filter has settled");
  verdict.demand(counts.restarts == 1, "no restart");
  const auto expected_turns = pieces * static_cast<std::uint64_t>(session.turnsOfPiece());
  verdict.demand(turns + 2 >= expected_turns && turns <= expected_turns, "every turn told once");
  verdict.demand(pulses + 2 >= turns, "a pulse for every turn");
  verdict.demand(std::abs(memory.growth()) <= 0.01, "memory of the last quarter within 1 % of the first");
  // The readings differ only by whole revolutions: rounding of the angle is 5e-10 rad after a day.
  verdict.demand(std::abs(last.rms() / first.rms() - 1.0) <= 0.01, "error of the last turns equals that of the first");
  return verdict.exitCode();
}

}  // namespace
}  // namespace hammer_loads::soak

int main(int argc, char** argv) {
  const std::uint64_t samples = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : hammer_loads::soak::kDay;
  if (argc > 2 || samples < 1000000) {
    std::fprintf(stderr, "usage: pipeline_soak [SAMPLES], at least 1000000\n");
    return 2;
  }
  return hammer_loads::soak::run(samples);
}
