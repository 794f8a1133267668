/// How each mode moved in the last few milliseconds: what a reading whose stamp is late belongs to.
#pragma once

#include <array>
#include <cstddef>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/boom/mode.h"

namespace hammer_loads {

/// A mode at an instant.
struct ModeThen {
  ModeState motion;
  double force, force_rate;  ///< modal, of the hammer; and by the second
};

/// The last steps of all modes, each from its begin to its end: between two of them blows and readings change what is
/// known. No allocation.
class ModeHistory {
 public:
  static constexpr std::size_t kSteps = 64;  ///< 12 ms at 5 kHz

  void clear() noexcept { count_ = 0; }
  /// A step [s] > 0 begins; set() each mode of it.
  void begin(double step) noexcept;
  void set(int mode, const ModeState& from, const ModeState& to, double force_from, double force_to) noexcept {
    steps_[newest_].modes[static_cast<std::size_t>(mode)] = {from, to, force_from, force_to, 0.0};
  }
  /// A blow at the end of the last step [m sqrt(kg)/s].
  void strike(int mode, double jump) noexcept { steps_[newest_].modes[static_cast<std::size_t>(mode)].jump += jump; }

  struct Place {
    std::size_t newer{};  ///< so many steps are newer than its own
    double ago{};         ///< [s]
    double since{};       ///< its step's begin [s]
  };
  /// So long before the present [s]. False: that is too long.
  bool find(double ago, Place& place) const noexcept;
  /// By cubics through both ends of a step, relative error (omega step)^4/384. now: what readings have shown since then
  /// counts for then as well.
  void find(int mode, const Place& place, double omega, const ModeState& now, ModeThen& then) const noexcept;

 private:
  struct OfMode {
    ModeState from, to;
    double force_from{}, force_to{}, jump{};
  };
  struct Step {
    double duration{};
    std::array<OfMode, kMaxJoints> modes;
  };
  const Step& stepWith(std::size_t newer) const noexcept { return steps_[(newest_ + kSteps - newer) % kSteps]; }

  std::array<Step, kSteps> steps_;
  std::size_t newest_{}, count_{};
};

}  // namespace hammer_loads
