#include "hammer_loads/pipeline/hull_pitch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "hammer_loads/pipeline/unit_check.h"

namespace hammer_loads {

HullPitch::HullPitch(std::vector<std::string> joints, std::vector<int> signs, double offset, double initial)
    : joints_(std::move(joints)),
      signs_(std::move(signs)),
      offset_(offset),
      angles_(joints_.size(), 0.0),
      heard_(joints_.size(), false),
      unheard_(joints_.size()),
      pitch_(initial) {
  signs_.resize(joints_.size(), 1);
}

bool HullPitch::update(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
  bool any = false;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto found = std::find(names.begin(), names.end(), joints_[j]);
    if (found == names.end()) continue;
    const auto i = static_cast<std::size_t>(found - names.begin());
    if (i >= positions.size() || !(std::abs(positions[i]) <= kMostAngle)) {
      ++refused_;
      continue;
    }
    angles_[j] = positions[i];
    if (!heard_[j]) --unheard_;
    heard_[j] = true;
    any = true;
  }
  if (any && known()) pitch_ = std::inner_product(angles_.begin(), angles_.end(), signs_.begin(), offset_);
  return any;
}

bool HullPitch::looksLikeDegrees() const noexcept {
  return std::any_of(angles_.begin(), angles_.end(), jointLooksLikeDegrees);
}

std::vector<std::string> HullPitch::unheard() const {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!heard_[j]) names.push_back(joints_[j]);
  }
  return names;
}

}  // namespace hammer_loads
