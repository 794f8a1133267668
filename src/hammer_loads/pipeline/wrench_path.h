/// Load on the hull over the recent past, at any instant, with its impulse up to then.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Part of a step without a blow. Wrenches come from motion of links and drive relative to the hull, without weight and
/// without effects of the hull's own motion.
struct SmoothPiece {
  double duration{};    ///< [s] >= 0
  HullWrench from, to;  ///< at its ends
  HullWrench mean;      ///< over it, exact by the momentum difference
  bool ends_in_blow{};
  HullWrench blow;    ///< impulse of that blow BY links and drive ON the hull about D [N s, N s, N m s]
  double blow_std{};  ///< standard deviation of that blow's instant [s]
};

/// The pieces of one step in order of time; none after a restart, when the step before the sample is not known.
struct WrenchHistory {
  std::size_t count{};
  std::array<SmoothPiece, 5> pieces;

  double length() const noexcept {  ///< [s]
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += pieces[i].duration;
    return sum;
  }
};

/// Path of the load: force along x and z, moment about D [N, N, N m], with impulse [N s, N s, N m s].
class WrenchPath {
 public:
  /// Load that would be added to an instant on the other side of the last blow, and the probability of that.
  struct OtherSide {
    double probability{};
    Eigen::Vector3d load = Eigen::Vector3d::Zero(), blow = Eigen::Vector3d::Zero();
  };
  struct Instant {
    Eigen::Vector3d load;
    Eigen::Vector3d impulse;  ///< from the first step on, blows included
    Eigen::Vector3d lasting;  ///< integral of the impulse over that time [N s2, N s2, N m s2]
  };

  void forget() noexcept { count_ = 0, blow_.reset(); }
  bool known() const noexcept { return count_ > 0; }
  /// Adds a step that ends at `end`; steps follow in order of time. beside_from, beside_to: further loads at its ends.
  /// A step that does not begin where the last one ended restarts. No allocation.
  void add(StampNs end, const WrenchHistory& step, const HullWrench& beside_from, const HullWrench& beside_to) noexcept;
  /// Returns true if an instant lies within the stored time.
  bool covers(StampNs stamp) const noexcept { return known() && stamp >= oldest().start && stamp <= end_; }
  StampNs end() const noexcept { return end_; }
  /// Returns load and impulses. After the end the load is held; before the stored time they are those at its beginning.
  Instant at(StampNs stamp) const noexcept;
  OtherSide otherSide(StampNs stamp) const noexcept;

 private:
  struct Blow {
    StampNs stamp{};
    double deviation{};  ///< standard deviation of the instant [s]
    Eigen::Vector3d impulse;
    std::optional<Eigen::Vector3d> jump;  ///< jump of the load; none: the load after the blow is not known yet
  };
  struct Piece {
    StampNs start{};
    double duration{};                  ///< [s]
    Eigen::Vector3d from, slope, bend;  ///< load from + slope t + bend t^2/2
    Eigen::Vector3d impulse, lasting;   ///< at the start
    Eigen::Vector3d blow;               ///< impulse at the end
  };
  static constexpr std::size_t kKept = 256;  ///< a quarter of a second of samples at 1 kHz

  const Piece& back(std::size_t steps) const noexcept { return pieces_[(count_ - 1 - steps) % kKept]; }
  std::size_t kept() const noexcept { return count_ < kKept ? static_cast<std::size_t>(count_) : kKept; }
  const Piece& oldest() const noexcept { return back(kept() - 1); }
  static Instant after(const Piece& piece) noexcept;
  static Instant within(const Piece& piece, double time) noexcept;

  std::array<Piece, kKept> pieces_;
  std::optional<Blow> blow_;
  std::uint64_t count_{};
  StampNs end_{};
};

}  // namespace hammer_loads
