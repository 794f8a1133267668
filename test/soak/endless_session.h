/// A working machine of unlimited duration: some revolutions of steady work, repeated endlessly.
#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads::soak {

/// Returns a machine without slow variations. Its revolutions repeat, so that the piece's end fits its beginning.
inline simulation::MachineSettings steadyMachine(double rate) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.drive.flow *= 1.15;  // 5 revolutions a second
  machine.drive.relief_pressure *= 1.15;
  machine.drive.flow_variation = machine.drive.ripple = 0.0;
  machine.drive.stop_time = 1e9;
  machine.duration = 30.0;
  machine.crank.rate = rate;
  for (simulation::JointMotion& joint : machine.boom) joint.amplitude = 0.0;
  return machine;
}

struct EndlessSample {
  StampNs stamp{};
  CrankSample crank;
  std::size_t place{};  ///< index in the repeated piece
};

/// Crank angles keep increasing; encoder counts, noise and jitter repeat with the piece.
class EndlessSession {
 public:
  explicit EndlessSession(double rate, std::size_t turns = 100) : machine_(steadyMachine(rate)) {
    const simulation::Session session = simulation::recordSession(machine_);
    const std::size_t first = session.blows.size() - turns - 3;
    if (session.blows.size() < turns + 10) throw std::runtime_error("the machine makes too few turns");
    const double from = session.blows[first].time, to = session.blows[first + turns].time;
    turns_ = static_cast<std::int64_t>(turns);
    period_ = std::llround((to - from) * 1e9);
    const std::int64_t first_turn = session.truth.front().turn;
    for (std::size_t i = 0; i < session.crank.size(); ++i) {
      const double time = session.truth[i].time;
      if (time <= from || time > to) continue;
      if (readings_.empty()) start_turn_ = session.truth[i].turn - first_turn;
      readings_.push_back(session.crank[i]);
      truth_.push_back(session.truth[i]);
      turn_.push_back(session.truth[i].turn - first_turn - start_turn_);
    }
    for (const simulation::JointMotion& joint : machine_.boom) joints_.push_back(joint.mean);
  }

  EndlessSample next() {
    const simulation::CrankReading& reading = readings_[place_];
    EndlessSample sample;
    sample.place = place_;
    sample.stamp = reading.stamp + round_ * period_;
    // The angle is a whole number of counts, as from a multi-turn encoder.
    const double count = 6.283185307179586232 / machine_.crank.counts;
    const double counts = std::nearbyint(reading.angle / count) +
                          static_cast<double>((turn_[place_] + round_ * turns_) * machine_.crank.counts);
    sample.crank = {counts * count, reading.speed};
    if (++place_ == readings_.size()) place_ = 0, ++round_;
    return sample;
  }

  /// Returns the true motion of the machine at a sample.
  const simulation::CrankTruth& truth(std::size_t place) const { return truth_[place]; }
  std::size_t pieceSize() const { return readings_.size(); }  ///< samples
  double turnsPerSecond() const { return 1e9 * static_cast<double>(turns_) / static_cast<double>(period_); }
  std::int64_t turnsOfPiece() const { return turns_; }
  const std::vector<double>& joints() const { return joints_; }  ///< order of kBoomJoints [rad]
  const simulation::MachineSettings& machine() const { return machine_; }
  double peakForce() const {
    double peak = 0.0;
    for (const simulation::CrankTruth& t : truth_) peak = std::max(peak, std::abs(t.load.force_z));
    return peak;
  }

 private:
  simulation::MachineSettings machine_;
  std::vector<simulation::CrankReading> readings_;
  std::vector<simulation::CrankTruth> truth_;
  std::vector<std::int64_t> turn_;  ///< since the beginning of the piece
  std::vector<double> joints_;
  std::int64_t turns_{}, period_{}, start_turn_{}, round_{};
  std::size_t place_{};
};

}  // namespace hammer_loads::soak
