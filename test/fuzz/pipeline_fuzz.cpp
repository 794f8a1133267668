// For any sequence of input messages the loads are finite or refused, and every message is counted once.
//
// The bytes of an input are the level and the estimator, then messages, each an operation and its arguments. Bytes
// missing at the end count as zeros. The common operation is a plausible sample, so that the filter is at work when the
// others come. Operation 254 restarts with other settings: any that the reader accepts.
#include <cmath>
#include <cstdint>
#include <numeric>

#include "fuzz/bytes.h"
#include "fuzz/drawn_settings.h"
#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/pipeline/crank_checks.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/readers.h"
#include "support/count_text.h"

namespace hammer_loads {
namespace {

constexpr std::uint64_t kLastStamp = 4294967295999999999;  // of ros::Time [ns]

using test::Bytes;
using test::require;

PipelineSettings settingsOf(Bytes& bytes) {
  PipelineSettings settings = test::shippedSettings().pipeline;
  const auto choice = bytes.take<std::uint8_t>();
  settings.level = choice % 16 == 0 ? Level::kPulse : choice % 2 == 0 ? Level::kLinkage : Level::kRocker;
  return settings;
}

life::LifeSettings counted() {
  life::LifeSettings settings;
  const life::LoadGrid grid = life::LoadGrid::make(-20000.0, 20000.0, 64).value.value();
  for (const std::string& channel : channelNames(nullptr)) settings.channels.push_back({channel, grid});
  settings.period = 1000000000;
  settings.equivalent_cycles_per_hour = 3600.0;
  return settings;
}

class Session {
 public:
  explicit Session(Bytes bytes)
      : bytes_(bytes), mechanism_(test::shippedSettings().mechanism), settings_(settingsOf(bytes_)) {
    pipeline_.emplace(mechanism_, settings_);
    life_.emplace(*pipeline_, counted());
  }

  void run() {
    while (!bytes_.empty()) step();
    const SampleCounts& counts = pipeline_->counts();
    require(std::accumulate(counts.refused.begin(), counts.refused.end(), counts.accepted) == messages_);
  }

 private:
  void step() {
    const auto operation = bytes_.take<std::uint8_t>();
    if (operation >= 254 && begun_ < kMostBegun) return beginAnew(operation == 254);
    switch (operation % 8) {
      case 4:
        return stampedSample();
      case 5:
        return rawSample();
      case 6:
        return boom();
      case 7:
        return shapes();
      default:
        return plausibleSample();
    }
  }

  void beginAnew(bool elsewhere) {
    ++begun_;
    const std::optional<Settings> drawn = elsewhere ? test::drawnSettings(bytes_) : std::nullopt;
    if (drawn) {
      mechanism_ = drawn->mechanism;
      settings_ = drawn->pipeline;
    }
    const SampleCounts counts = pipeline_->counts();
    pipeline_.emplace(mechanism_, settings_, std::nullopt, counts);
    life_.emplace(*pipeline_, counted());
  }

  void plausibleSample() {
    stamp_ += std::uint64_t{1000} * bytes_.take<std::uint16_t>();
    const double angle = bytes_.take<std::uint16_t>() * kTwoPi / 4096.0;
    crank({"hammer_crank_joint"}, {angle}, {0.01 * bytes_.take<std::int16_t>()});
  }

  void stampedSample() {
    stamp_ = bytes_.take<std::uint64_t>();
    const auto angle = bytes_.take<double>();
    crank({"hammer_crank_joint"}, {angle}, {bytes_.take<double>()});
  }

  void rawSample() {
    stamp_ += bytes_.take<std::uint32_t>();
    const auto angle = bytes_.take<double>();
    crank({"hammer_crank_joint"}, {angle}, {});
  }

  void boom() {
    const auto angle = bytes_.take<double>();
    pipeline_->boomJoints(0, {"arm_joint", "boom_joint", "hammer_joint"}, {0.1, angle, -0.2}, {});
    require(std::isfinite(pipeline_->hull().pitch().pitch()));
  }

  void shapes() {
    const auto names = bytes_.take<std::uint8_t>(), positions = bytes_.take<std::uint8_t>();
    const auto velocities = bytes_.take<std::uint8_t>(), place = bytes_.take<std::uint8_t>();
    std::vector<std::string> joints(names % 8, "joint");
    if (place < joints.size()) joints[place] = "hammer_crank_joint";
    std::vector<double> angles(positions % 8), speeds(velocities % 8);
    for (double& angle : angles) angle = bytes_.take<float>();
    for (double& speed : speeds) speed = bytes_.take<float>();
    pipeline_->boomJoints(static_cast<StampNs>(stamp_), joints, angles, speeds);
    stamp_ += 1000000;
    crank(joints, angles, speeds);
  }

  void crank(const std::vector<std::string>& names, const std::vector<double>& angles,
             const std::vector<double>& speeds) {
    stamp_ %= kLastStamp + 1;
    ++messages_;
    const SampleResult& loads = pipeline_->crankJoint(static_cast<StampNs>(stamp_), names, angles, speeds);
    if (!angles.empty()) check_.add(1e-3, angles[0], speeds.empty() ? std::nullopt : std::make_optional(speeds[0]));
    require(loads.turn_ends <= loads.ends.size());
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      // An energy outside the possible range is NaN, whether or not its standard deviation explains it.
      require(std::isnan(end.blow.energy) || (std::isfinite(end.blow.energy) && !end.blow.impossible));
      require(std::isfinite(end.blow.support_impulse_z));
      if (end.pulse) require(std::isfinite(end.pulse->amplitude) && std::isfinite(end.pulse->half_sine_rms_error));
    }
    count(loads);
    if (loads.refusal) return;
    require(std::isfinite(loads.wrench.force_x) && std::isfinite(loads.wrench.force_z) &&
            std::isfinite(loads.wrench.torque_y) && std::isfinite(loads.crank.speed) &&
            std::isfinite(loads.crank.acceleration));
    require(std::abs(loads.crank.position.angle.offset) < 3.2);
  }

  void count(const SampleResult& loads) {
    if (life_->due()) {
      for (const life::CycleCount& count : life_->take().counts) require(life::isPossible(count));
    }
    life_->follow();
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const life::TurnLoads* turn = life_->turnLoads(loads.ends[i]);
      if (turn == nullptr) continue;
      require(turn->start <= turn->end);
      for (const life::ChannelTurn& c : turn->channels) require(!(c.minimum.value > c.maximum.value));
    }
  }

  /// With instrumentation, the nominal revolution of a hammer near a dead centre takes a second, once per column.
  static constexpr int kMostBegun = 4;

  Bytes bytes_;
  int begun_{};
  Mechanism mechanism_;
  PipelineSettings settings_;
  std::optional<Pipeline> pipeline_;
  std::optional<LifeFollower> life_;
  UnitCheck check_{300.0};
  std::uint64_t stamp_{1700000000000000000}, messages_{};
};

}  // namespace
}  // namespace hammer_loads

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hammer_loads::Session(hammer_loads::Bytes(data, size)).run();
  return 0;
}
