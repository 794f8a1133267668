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
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  Instant begin = known() ? after(back(0)) : Instant{none, none, none};
  const Eigen::Vector3d first = vectorOf(beside_from), change = vectorOf(beside_to) - first;
  for (std::size_t i = 0; i < step.count; ++i) {
    const SmoothPiece& given = step.pieces[i];
    const double h = given.duration, per_time = h > 0.0 ? 1.0 / h : 0.0, per_length = length > 0.0 ? 1.0 / length : 0.0;
    const Eigen::Vector3d from = vectorOf(given.from) + passed * per_length * change + first;
    const Eigen::Vector3d to = vectorOf(given.to) + (passed + h) * per_length * change + first;
    const Eigen::Vector3d mean = vectorOf(given.mean) + (passed + 0.5 * h) * per_length * change + first;
    const Eigen::Vector3d bump = 6.0 * (mean - 0.5 * (from + to));
    if (blow_ && !blow_->jump) blow_->jump = from - begin.load;
    Piece& piece = pieces_[count_++ % kKept];
    piece = {start,
             h,
             from,
             per_time * (to - from + bump),
             -2.0 * per_time * per_time * bump,
             begin.impulse,
             begin.lasting,
             given.ends_in_blow ? vectorOf(given.blow) : none};
    begin = after(piece);
    passed += h;
    start = end - static_cast<StampNs>(std::llround((length - passed) / kSecondsPerNs));
    if (given.ends_in_blow) blow_ = Blow{start, given.blow_std, piece.blow, std::nullopt};
  }
  end_ = end;
}

WrenchPath::Instant WrenchPath::within(const Piece& p, double t) noexcept {
  const double tt = t * t;
  return {p.from + t * p.slope + 0.5 * tt * p.bend, p.impulse + t * p.from + 0.5 * tt * p.slope + tt * t / 6.0 * p.bend,
          p.lasting + t * p.impulse + 0.5 * tt * p.from + tt * t / 6.0 * p.slope + tt * tt / 24.0 * p.bend};
}

/// Returns the instant at the end of a piece, after its blow.
WrenchPath::Instant WrenchPath::after(const Piece& p) noexcept {
  Instant end = within(p, p.duration);
  end.impulse += p.blow;
  return end;
}

WrenchPath::Instant WrenchPath::at(StampNs stamp) const noexcept {
  const Piece& last = back(0);
  if (stamp >= end_) {
    Instant now = after(last);
    const double time = seconds(stamp - end_);
    now.lasting += time * now.impulse + 0.5 * time * time * now.load;
    now.impulse += time * now.load;
    return now;
  }
  std::size_t k = 0;
  while (k + 1 < kept() && back(k).start > stamp) ++k;
  const Piece& piece = back(k);
  return within(piece, std::clamp(seconds(stamp - piece.start), 0.0, piece.duration));
}

WrenchPath::OtherSide WrenchPath::otherSide(StampNs stamp) const noexcept {
  if (!blow_ || !blow_->jump || !(blow_->deviation > 0.0)) return {};
  const double after = seconds(stamp - blow_->stamp), sign = after < 0.0 ? 1.0 : -1.0;
  return {0.5 * std::erfc(std::abs(after) / (std::sqrt(2.0) * blow_->deviation)), sign * *blow_->jump,
          sign * blow_->impulse};
}

}  // namespace hammer_loads
