/// Rainflow count of ASTM E1049-85 by the 4-point rule: turning points on a stack, a cycle closed as soon as it can be.
///
/// Of four turning points A, B, C, D in a row the pair (B, C) is a cycle when both lie within [A, D] or [D, A]; it is
/// taken out. Cycles that never close are the residue; counted as half cycles it makes the count that of ASTM E1049-85
/// (McInnes & Meehan, Int. J. Fatigue 30 (2008) 547-559). Only comparisons, no difference: exact for any numbers.
///
/// The newest point is the running end of the series: it moves on while the series does not turn. The residue therefore
/// always holds the first and the last value, and the residues of two pieces of a series, one after another through
/// push(), give the rest of the count of the whole: pieces add exactly.
#pragma once

#include <cstddef>
#include <vector>

namespace hammer_loads::life {

/// Point: a value with `<` and `==` (no NaN), and whatever it carries besides, such as its index or stamp.
template <typename Point>
class FourPointStack {
 public:
  /// No allocation while the residue stays below `capacity`.
  explicit FourPointStack(std::size_t capacity = 0) { points_.reserve(capacity); }

  /// Next value of the series. `closed(b, c)` is called for each cycle that it closes, b before c in time.
  template <typename Closed>
  void push(const Point& point, Closed&& closed) {
    const std::size_t size = points_.size();
    if (size > 0 && points_[size - 1] == point) return;
    const bool turns = size < 2 || (points_[size - 2] < points_[size - 1]) != (points_[size - 1] < point);
    if (turns) {
      points_.push_back(point);
    } else {
      points_[size - 1] = point;
    }
    while (points_.size() >= 4 && closeOne(closed)) {
    }
  }

  /// Turning points of which no four in a row hold a cycle, in time order.
  const std::vector<Point>& residue() const { return points_; }

 private:
  template <typename Closed>
  bool closeOne(Closed& closed) {
    const std::size_t size = points_.size();
    const Point &a = points_[size - 4], &b = points_[size - 3], &c = points_[size - 2], &d = points_[size - 1];
    const bool inside = b < c ? !(b < d) && !(a < c) : !(d < b) && !(c < a);
    if (!inside) return false;
    closed(b, c);
    points_[size - 3] = d;
    points_.resize(size - 2, d);
    return true;
  }

  std::vector<Point> points_;
};

}  // namespace hammer_loads::life
