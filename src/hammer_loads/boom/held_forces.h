/// Forces of the hammer that a filter delayed to the time of its sensors has not reached yet, and the forces about a
/// reading.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/mode_history.h"

namespace hammer_loads {

/// Queue of pieces of the modal forces. The crank appends them at the end; the filter takes them from the front. No
/// allocation.
class HeldForces {
 public:
  /// Linear between its ends but for the mean, as TorqueStep; a blow may end it.
  struct Piece {
    double duration{};  ///< [s]
    ModeVector from = ModeVector::Zero(), to = from, mean = from;
    bool strikes{};
    ModeVector jump = ModeVector::Zero();  ///< jump of the velocities by that blow [m sqrt(kg)/s]
  };

  bool empty() const noexcept { return count_ == 0; }
  double length() const noexcept;  ///< [s]
  void clear() noexcept { count_ = 0; }
  void push(double step, const TorqueStep& modal) noexcept;
  /// At the end of what was pushed last; not where nothing is held.
  void strike(const ModeVector& jump) noexcept;
  /// Takes at most this much of the front [s] as one piece, less where a blow ends it. At least one must be held.
  Piece take(double most) noexcept;
  /// Forces at a time after the front [s] >= 0, and the jumps of the velocities by blows until then. After the last
  /// known force that one is returned; `present` if the queue is empty.
  Driven drivenAt(double ahead, const ModeVector& present) const noexcept;
  /// each(piece), from the front on.
  template <typename Each>
  void forEach(const Each& each) const {
    for (std::size_t i = 0; i < count_; ++i) each(pieces_[(front_ + i) % kMost]);
  }
  template <typename Each>
  void forEach(const Each& each) {
    for (std::size_t i = 0; i < count_; ++i) each(pieces_[(front_ + i) % kMost]);
  }

 private:
  static constexpr std::size_t kMost = ModeHistory::kSteps;

  void pop() noexcept { front_ = (front_ + 1) % kMost, --count_; }

  std::array<Piece, kMost> pieces_;
  std::size_t front_{}, count_{};
};

/// Errors of the hammer's force and of the velocities at a reading whose instant has a standard deviation: the slopes
/// over that deviation to both sides, and the rest that a line does not describe. A blow is a jump that has been or has
/// not.
struct DrivenAround {
  ModeVector force_rate, velocity_rate, force_bend, velocity_bend;
};

/// About an instant this long after the present, or before it [s]; present: forces where nothing is held. None for a
/// deviation [s] of zero.
std::optional<DrivenAround> drivenAround(const ModeHistory& past, const HeldForces& coming, const ModeVector& present,
                                         double ahead, double deviation) noexcept;

}  // namespace hammer_loads
