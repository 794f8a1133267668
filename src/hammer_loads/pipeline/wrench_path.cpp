#include "hammer_loads/pipeline/wrench_path.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {

void WrenchPath::add(StampNs end, const WrenchHistory& step, const HullWrench& beside_from,
                     const HullWrench& beside_to) noexcept {
  const double length = step.length();
  StampNs start = end - static_cast<StampNs>(std::llround(length / kSecondsPerNs));
  if (known() && std::abs(start - end_) > 1) forget();
  double passed = 0.0;
  Eigen::Vector3d impulse = known() ? back(0).after : Eigen::Vector3d::Zero();
  const Eigen::Vector3d first = vectorOf(beside_from), change = vectorOf(beside_to) - first;
  for (std::size_t i = 0; i < step.count; ++i) {
    const SmoothPiece& given = step.pieces[i];
    const double h = given.duration, per_time = h > 0.0 ? 1.0 / h : 0.0, per_length = length > 0.0 ? 1.0 / length : 0.0;
    const Eigen::Vector3d from = vectorOf(given.from) + passed * per_length * change + first;
    const Eigen::Vector3d to = vectorOf(given.to) + (passed + h) * per_length * change + first;
    const Eigen::Vector3d mean = vectorOf(given.mean) + (passed + 0.5 * h) * per_length * change + first;
    const Eigen::Vector3d bump = 6.0 * (mean - 0.5 * (from + to));
    Piece& piece = pieces_[count_++ % kKept];
    piece = {start, h, from, per_time * (to - from + bump), -2.0 * per_time * per_time * bump, impulse,
             impulse + h * mean};
    if (given.ends_in_blow) piece.after += vectorOf(given.blow);
    impulse = piece.after;
    passed += h;
    start = end - static_cast<StampNs>(std::llround((length - passed) / kSecondsPerNs));
  }
  end_ = end;
}

WrenchPath::Instant WrenchPath::within(const Piece& p, double t) noexcept {
  return {p.from + t * p.slope + 0.5 * t * t * p.bend,
          p.impulse + t * (p.from + t * (0.5 * p.slope + t / 6.0 * p.bend))};
}

WrenchPath::Instant WrenchPath::at(StampNs stamp) const noexcept {
  const Piece& last = back(0);
  if (stamp >= end_) {
    Instant now = within(last, last.duration);
    now.impulse = last.after + seconds(stamp - end_) * now.load;
    return now;
  }
  std::size_t k = 0;
  while (k + 1 < kept() && back(k).start > stamp) ++k;
  const Piece& piece = back(k);
  return within(piece, std::clamp(seconds(stamp - piece.start), 0.0, piece.duration));
}

}  // namespace hammer_loads
