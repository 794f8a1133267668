#include "hammer_loads/tables/turn_traces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hammer_loads {
namespace {

constexpr std::size_t kMostOfTurn = 4096;
constexpr std::size_t kMostCandidates = 32;

}  // namespace

void TurnTraces::turnEnded(std::uint64_t turn, std::int64_t stamp, double period_s, double amplitude) {
  const bool is_worst = !worst_ || amplitude > worst_->amplitude;
  const bool is_candidate = turns_++ % every_ == 0;
  if (!is_worst && !is_candidate) return;
  TurnTrace trace = traceOf(turn, stamp, period_s, amplitude);
  if (trace.samples.empty()) return;
  if (is_worst) worst_ = trace;
  if (is_candidate) keepCandidate(std::move(trace));
}

TurnTrace TurnTraces::traceOf(std::uint64_t turn, std::int64_t stamp, double period_s, double amplitude) const {
  TurnTrace trace{turn, stamp - std::llround(period_s * 1e9), amplitude, {}};
  const auto from = std::find_if(latest_.begin(), latest_.end(),
                                 [&](const TraceSample& sample) { return sample.stamp > trace.start; });
  const auto to = std::find_if(from, latest_.end(), [&](const TraceSample& sample) { return sample.stamp > stamp; });
  const auto count = static_cast<std::size_t>(to - from);
  const bool whole = from != latest_.begin() || !latest_.full();
  if (whole && count <= kMostOfTurn) trace.samples.assign(from, to);
  return trace;
}

void TurnTraces::keepCandidate(TurnTrace trace) {
  candidates_.push_back(std::move(trace));
  if (candidates_.size() <= kMostCandidates) return;
  every_ *= 2;
  for (std::size_t i = 0; 2 * i < candidates_.size(); ++i)
    if (i > 0) candidates_[i] = std::move(candidates_[2 * i]);
  candidates_.resize((candidates_.size() + 1) / 2);
}

const TurnTrace* TurnTraces::typical() const {
  if (candidates_.empty()) return nullptr;
  std::vector<const TurnTrace*> sorted;
  for (const TurnTrace& candidate : candidates_) sorted.push_back(&candidate);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.end(), [](const TurnTrace* a, const TurnTrace* b) {
    return std::make_pair(a->amplitude, a->turn) < std::make_pair(b->amplitude, b->turn);
  });
  return *middle;
}

}  // namespace hammer_loads
