/// Motion of each mode in the last few milliseconds, for readings with late stamps.
#pragma once

#include <array>
#include <cstddef>

#include "hammer_loads/boom/chain.h"
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

}  // namespace hammer_loads
