#include "hammer_loads/boom/mode_history.h"

#include <algorithm>

namespace hammer_loads {

void ModeHistory::begin(double step) noexcept {
  newest_ = (newest_ + 1) % kSteps;
  count_ = std::min(count_ + 1, kSteps);
  steps_[newest_].duration = step;
}

bool ModeHistory::find(double ago, Place& place) const noexcept {
  double since = -ago;
  for (std::size_t newer = 0; newer < count_; ++newer) {
    since += stepWith(newer).duration;
    if (since < 0.0) continue;
    place = {newer, ago, since};
    return true;
  }
  return false;
}

}  // namespace hammer_loads
