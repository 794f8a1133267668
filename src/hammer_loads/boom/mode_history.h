/// Motion of each mode in the last few milliseconds, for readings with late stamps; forces of the hammer that a filter
/// delayed to the time of its sensors has not reached yet, and the forces about a reading.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/mode.h"

namespace hammer_loads {

/// One entry a mode; zero for unused modes.
using ModeVector = Eigen::Matrix<double, kMaxJoints, 1>;

/// Modal forces of the hammer at an instant, and the change of the modal velocities by blows between the present and
/// that instant, negative for an instant in the past [m sqrt(kg)/s].
struct Driven {
  ModeVector force = ModeVector::Zero(), jump = force;
};

/// Last steps of all modes, each with the states at its begin and its end. Blows and readings change the state between
/// two steps. No allocation.
class ModeHistory {
 public:
  static constexpr std::size_t kSteps = 64;  ///< 12 ms at 5 kHz

  void clear() noexcept { count_ = 0; }
  /// A step [s] > 0 begins; set() each mode of it.
  void begin(double step) noexcept;
  void set(int mode, const ModeState& from, const ModeState& to, double force_from, double force_to) noexcept {
    Step& step = steps_[newest_];
    step.from_x[mode] = from.x, step.from_v[mode] = from.v, step.to_x[mode] = to.x, step.to_v[mode] = to.v;
    step.force_from[mode] = force_from, step.force_to[mode] = force_to, step.jump[mode] = 0.0;
  }
  /// A blow at the end of the last step [m sqrt(kg)/s].
  void strike(int mode, double jump) noexcept { steps_[newest_].jump[mode] += jump; }

  /// Forces at a time before the present [s] >= 0; before the history begins, its oldest.
  Driven drivenAt(double ago) const noexcept;

  /// Returns true if the history, or its extrapolation over one more step, goes back this far [s].
  bool reaches(double ago) const noexcept;

  struct Place {
    std::size_t newer{};  ///< number of steps newer than its own
    double ago{};         ///< [s]
    double since{};       ///< time since its step's begin [s]
  };
  /// Finds the place at a time before the present [s]. Returns false if the history does not reach it.
  bool find(double ago, Place& place) const noexcept;
  /// A mode at an instant, with the force of the hammer, modal, and that by the second.
  struct Moment {
    ModeState state;
    double force{}, force_rate{};
  };
  /// Motion of a mode at that place, by cubics through both ends of a step, relative error (omega step)^4/384. now: the
  /// state with all corrections since then, which are carried back.
  Moment at(const Place& place, int mode, double omega, const ModeState& now) const noexcept;

 private:
  struct Step {
    double duration{};                                                                      ///< [s]
    ModeVector from_x = ModeVector::Zero(), from_v = from_x, to_x = from_x, to_v = from_x;  ///< both ends
    ModeVector force_from = from_x, force_to = from_x;                                      ///< modal, of the hammer
    ModeVector jump = from_x;  ///< jump of the velocity by a blow at the end [m sqrt(kg)/s]
  };

  /// The last but `newer`.
  const Step& stepWith(std::size_t newer) const noexcept { return steps_[(newest_ + kSteps - newer) % kSteps]; }

  std::array<Step, kSteps> steps_;
  std::size_t newest_{}, count_{};
};

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
  std::size_t size() const noexcept { return count_; }
  Piece& operator[](std::size_t i) noexcept { return pieces_[(front_ + i) % kMost]; }  ///< from the front on
  const Piece& operator[](std::size_t i) const noexcept { return pieces_[(front_ + i) % kMost]; }

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
