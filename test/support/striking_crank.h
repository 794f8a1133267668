/// A crank with its rocker, struck as a test wants: brute-force integration that shares only the kinematics.
#pragma once

#include <functional>

#include "hammer_loads/linkage/link_motion.h"

namespace hammer_loads::test {

/// Level rocker without weight: (Jc + I u^2) w' = tau - I u u' w^2, u' by differences; midpoint steps of 10 us.
class StrikingCrank {
 public:
  /// What the coming blow does: factor on the crank's speed; none: no contact.
  struct Blow {
    double factor{1.0};
    bool contact{true};
    double early{};  ///< the tool stands so many radians before the dead centre
  };

  StrikingCrank(const CrankRocker& linkage, double rocker_inertia, double drive_inertia)
      : linkage_(&linkage), rocker_(rocker_inertia), drive_(drive_inertia) {}

  std::function<Blow(int)> blow = [](int) { return Blow{}; };  ///< by number
  double torque{150.0};

  void advanceTo(double time) {
    constexpr double kStep = 1e-5;
    while (time_ < time) step(std::min(kStep, time - time_));
  }
  double angle() const { return offset_ + (turns_ * kTwoPi); }  ///< unwound [rad]
  double speed() const { return speed_; }
  double acceleration() const { return rate(offset_, speed_); }
  int blows() const { return blows_; }
  double time() const { return time_; }
  double blowTime() const { return blow_time_; }

 private:
  double ratio(double offset) const {
    return motion(*linkage_, {offset, before_ ? Side::kBeforeBlow : Side::kAfterBlow}).u;
  }
  double rate(double offset, double w) const {
    constexpr double h = 1e-5;
    const double u = ratio(offset), slope = (ratio(offset + h) - ratio(offset - h)) / (2 * h);
    return (torque - rocker_ * u * slope * w * w) / (drive_ + rocker_ * u * u);
  }
  void step(double dt) {
    if (coming_ != blows_ + misses_) next_ = blow(coming_ = blows_ + misses_);
    const Blow& next = next_;
    const double was = offset_, half = offset_ + 0.5 * dt * speed_;
    const double mid = speed_ + 0.5 * dt * rate(offset_, speed_);
    speed_ += dt * rate(half, mid);
    offset_ += dt * mid;
    time_ += dt;
    if (before_ && !struck_ && next.contact && was < -next.early && offset_ >= -next.early) {
      speed_ *= next.factor;
      blow_time_ = time_;
      struck_ = true;
      ++blows_;
    }
    if (before_ && was < 0.0 && offset_ >= 0.0) {
      if (struck_) before_ = false;
      misses_ += !struck_;
      struck_ = false;
    }
    if (offset_ > 0.5 * kTwoPi) {
      offset_ -= kTwoPi;
      before_ = !before_;
      ++turns_;
    }
  }

  const CrankRocker* linkage_;
  double rocker_, drive_;
  double offset_{0.5}, speed_{20.0}, time_{}, blow_time_{};
  int turns_{}, blows_{}, misses_{};
  int coming_{-1};
  Blow next_;
  bool before_{}, struck_{};
};

}  // namespace hammer_loads::test
