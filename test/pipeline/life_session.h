/// Sessions played into a pipeline and into a counter of its loads.
#pragma once

#include "hammer_loads/pipeline/life_follower.h"
#include "support/session_player.h"

namespace hammer_loads::test {

constexpr double kPeak = 8.6e3;  // [N]; approximate peak of the session's revolutions

inline simulation::Session sessionAt(double rate,
                                     const std::vector<simulation::CrankSensorSettings::Interval>& drop_outs = {}) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = kSessionEnd;
  machine.crank.rate = rate;
  machine.crank.drop_outs = drop_outs;
  return simulation::recordSession(machine);
}

/// Plays a session into pipeline and follower, with each(result, follower) after every sample. Returns the total count.
template <typename Each>
life::LifePiece run(const Settings& settings, const simulation::Session& session, const Each& each) {
  Player player(settings, true, session);
  LifeFollower follower(player.pipeline, settings.life);
  player.playTo(1e9, [&](double, const SampleResult& result) {
    if (follower.due()) follower.take();
    follower.follow();
    each(result, follower);
  });
  follower.take();
  return follower.total().value();
}

inline const auto kNothing = [](const SampleResult&, const LifeFollower&) {};

}  // namespace hammer_loads::test
