// Hostile input: whatever comes, loads are finite or refused and counted, and one turn after it all is well again.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/constants.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using simulation::CrankReading;
using simulation::Session;
using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
constexpr double kUndisturbedFrom = 3.0, kAttack = 4.0, kSoundFrom = 4.1, kUntil = 5.0;  // [s] of the session
constexpr double kOneTurn = 0.25;           // [s]: the machine makes some 4.6 in a second
constexpr double kUndisturbedError = 0.02;  // of Fz over its peak: undisturbed sessions stay within 0.012
using test::kCrank;
const Names kBoom{"boom_joint", "arm_joint", "hammer_joint"};
const Numbers kBoomAngles{-0.35, 1.20, -0.85};

const simulation::MachineSettings& attackedMachine() {
  static const simulation::MachineSettings settings = [] {
    simulation::MachineSettings s = simulation::workingMo100();
    s.duration = kUntil;
    for (simulation::JointMotion& joint : s.boom) joint.amplitude = 0.0;
    return s;
  }();
  return settings;
}

const Session& attacked() {
  static const Session recorded = simulation::recordSession(attackedMachine());
  return recorded;
}

/// A pipeline at work and what it gives.
class Victim {
 public:
  explicit Victim(const PipelineSettings& settings) : pipeline_(test::mechanismOf(attackedMachine().hammer), settings) {
    for (const auto& truth : attacked().truth) peak_ = std::max(peak_, std::abs(truth.load.force_z));
  }

  /// Good samples of [from, to) [s].
  void work(double from, double to, const std::function<void(const CrankReading&)>& instead = {}) {
    boom(kBoom, kBoomAngles);
    for (std::size_t i = 0; i < attacked().crank.size(); ++i) {
      const CrankReading& reading = attacked().crank[i];
      const double time = attacked().truth[i].time;
      if (time < from || time >= to) continue;
      if (instead) {
        instead(reading);
        continue;
      }
      const SampleResult& loads = crank(reading.stamp, kCrank, {reading.angle}, {*reading.speed});
      if (loads.refusal || loads.beside_blow) continue;
      if (first_accepted_ < from) first_accepted_ = time;
      worst_ = std::max(worst_, std::abs(loads.wrench.force_z - attacked().truth[i].load.force_z) / peak_);
    }
  }
  const SampleResult& good(const CrankReading& r) { return crank(r.stamp, kCrank, {r.angle}, {*r.speed}); }
  const SampleResult& crank(StampNs stamp, const Names& names, const Numbers& position, const Numbers& velocity) {
    const SampleResult& loads = pipeline_.crankJoint(stamp, names, position, velocity);
    if (!loads.refusal) {
      for (const double value : {loads.wrench.force_x, loads.wrench.force_z, loads.wrench.torque_y, loads.crank.speed,
                                 loads.crank.acceleration, loads.crank.position.angle.offset}) {
        finite_ = finite_ && std::isfinite(value);
      }
    }
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      finite_ = finite_ && std::isfinite(end.blow.energy) && std::isfinite(end.blow.tool_impulse_z);
      if (end.pulse)
        finite_ = finite_ && std::isfinite(end.pulse->amplitude) && std::isfinite(end.pulse->turn_impulse_z);
    }
    return loads;
  }
  bool boom(const Names& names, const Numbers& position) { return pipeline_.boomJoints(0, names, position, {}); }

  void forgetErrors() { worst_ = 0.0; }
  bool finite() const { return finite_; }
  double firstAccepted() const { return first_accepted_; }  ///< of the last work() [s]
  double worst() const { return worst_; }                   ///< error of Fz over the peak [-]
  std::uint64_t refused(Refusal reason) const { return pipeline_.counts().refused[static_cast<std::size_t>(reason)]; }
  std::uint64_t accepted() const { return pipeline_.counts().accepted; }
  const Pipeline& pipeline() const { return pipeline_; }

 private:
  Pipeline pipeline_;
  double peak_{}, worst_{}, first_accepted_{};
  bool finite_{true};
};

struct Attack {
  const char* name;
  std::optional<Refusal> refusal;  ///< of every hostile message; none: it may be taken
  std::function<void(Victim&, const CrankReading&)> strike;
};

Attack onPosition(const char* name, std::optional<Refusal> refusal, double value) {
  return {name, refusal, [value](Victim& v, const CrankReading& r) { v.crank(r.stamp, kCrank, {value}, {*r.speed}); }};
}
Attack onSpeed(const char* name, std::optional<Refusal> refusal, double value) {
  return {name, refusal, [value](Victim& v, const CrankReading& r) { v.crank(r.stamp, kCrank, {r.angle}, {value}); }};
}

std::vector<Attack> valueAttacks() {
  std::vector<Attack> attacks{onPosition("angle NaN", Refusal::kNotFinite, kNan),
                              onPosition("angle inf", Refusal::kNotFinite, kInf),
                              onPosition("angle -inf", Refusal::kNotFinite, -kInf),
                              onPosition("angle 1e308", Refusal::kImplausible, 1e308),
                              onPosition("angle -1e308", Refusal::kImplausible, -1e308),
                              onPosition("angle 1e10", Refusal::kImplausible, 1e10),
                              onPosition("angle 1e9", std::nullopt, 1e9),
                              onPosition("angle denormal", std::nullopt, 5e-324),
                              onPosition("angle -denormal", std::nullopt, -5e-324),
                              onPosition("angle -0", std::nullopt, -0.0),
                              onSpeed("speed NaN", Refusal::kNotFinite, kNan),
                              onSpeed("speed inf", Refusal::kNotFinite, kInf),
                              onSpeed("speed -inf", Refusal::kNotFinite, -kInf),
                              onSpeed("speed 1e308", Refusal::kImplausible, 1e308),
                              onSpeed("speed 301", Refusal::kImplausible, -301.0),
                              onSpeed("speed 299", std::nullopt, 299.0),
                              onSpeed("speed denormal", std::nullopt, 5e-324)};
  const auto add = [&](const char* name, std::optional<Refusal> refusal, auto strike) {
    attacks.push_back({name, refusal, strike});
  };
  add("angle jumps by 1", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, kCrank, {r.angle + (r.stamp / 1000000 % 2 == 0 ? 1.0 : -1.0)}, {*r.speed});
  });
  add("angle jumps by 1000", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, kCrank, {r.angle + 1000.0 * static_cast<double>(r.stamp % 7)}, {*r.speed});
  });
  add("direction reversed", std::nullopt,
      [](Victim& v, const CrankReading& r) { v.crank(r.stamp, kCrank, {-r.angle}, {-*r.speed}); });
  add("direction of speed flips", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, kCrank, {r.angle}, {r.stamp / 1000000 % 2 == 0 ? *r.speed : -*r.speed});
  });
  add("degrees", Refusal::kImplausible, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, kCrank, {r.angle * 57.2957795}, {*r.speed * 57.2957795});
  });
  add("angle in degrees", std::nullopt,
      [](Victim& v, const CrankReading& r) { v.crank(r.stamp, kCrank, {r.angle * 57.2957795}, {*r.speed}); });
  return attacks;
}

std::vector<Attack> shapeAttacks() {
  static const Names million = [] {
    Names names(1000000, "joint");
    names.front() = "hammer_crank_joint";
    return names;
  }();
  std::vector<Attack> attacks;
  const auto add = [&](const char* name, std::optional<Refusal> refusal, auto strike) {
    attacks.push_back({name, refusal, strike});
  };
  add("empty message", Refusal::kMissingJoint, [](Victim& v, const CrankReading& r) { v.crank(r.stamp, {}, {}, {}); });
  add("no names", Refusal::kMissingJoint,
      [](Victim& v, const CrankReading& r) { v.crank(r.stamp, {}, {r.angle}, {*r.speed}); });
  add("empty name", Refusal::kMissingJoint,
      [](Victim& v, const CrankReading& r) { v.crank(r.stamp, {""}, {r.angle}, {*r.speed}); });
  add("other name", Refusal::kMissingJoint,
      [](Victim& v, const CrankReading& r) { v.crank(r.stamp, {"hammer_crank_join"}, {r.angle}, {*r.speed}); });
  add("no position", Refusal::kShortArray,
      [](Victim& v, const CrankReading& r) { v.crank(r.stamp, kCrank, {}, {*r.speed}); });
  add("short positions", Refusal::kShortArray, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, {"swing_joint", "hammer_crank_joint"}, {r.angle}, {*r.speed, *r.speed});
  });
  add("short speeds", Refusal::kShortArray, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, {"swing_joint", "hammer_crank_joint"}, {0.0, r.angle}, {*r.speed});
  });
  add("a million names, few positions", Refusal::kShortArray, [](Victim& v, const CrankReading& r) {
    if (r.stamp % 10 == 0) v.crank(r.stamp, million, {}, {});
    v.crank(r.stamp, million, {}, {*r.speed});
  });
  add("position NaN beside a good one", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, {"swing_joint", "hammer_crank_joint"}, {kNan, r.angle}, {kInf, *r.speed});
  });
  add("joint given twice", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, {"hammer_crank_joint", "hammer_crank_joint"}, {r.angle, kNan}, {*r.speed, kNan});
  });
  add("speeds come and go", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp, kCrank, {r.angle}, r.stamp / 1000000 % 3 == 0 ? Numbers{} : Numbers{*r.speed});
  });
  return attacks;
}

/// Equal stamps are duplicates where header stamps hold, else a burst, whose angles must then fit.
std::vector<Attack> timeAttacks(CrankStamps stamps) {
  std::vector<Attack> attacks;
  const Refusal same_stamp = stamps == CrankStamps::kHeader ? Refusal::kDuplicate : Refusal::kImplausible;
  const auto add = [&](const char* name, std::optional<Refusal> refusal, auto strike) {
    attacks.push_back({name, refusal, strike});
  };
  add("same stamp", same_stamp, [](Victim& v, const CrankReading& r) {
    v.good(r);
    v.crank(r.stamp, kCrank, {r.angle + 1.0}, {*r.speed});
  });
  add("late", Refusal::kOutOfOrder, [](Victim& v, const CrankReading& r) {
    v.good(r);
    v.crank(r.stamp - 500000000, kCrank, {r.angle + 1.0}, {*r.speed});
  });
  add("stamp zero", Refusal::kOutOfOrder, [](Victim& v, const CrankReading& r) {
    v.good(r);
    v.crank(0, kCrank, {r.angle}, {*r.speed});
  });
  add("stamp far ahead", std::nullopt,
      [](Victim& v, const CrankReading& r) { v.crank(r.stamp + 2000000000000000000, kCrank, {r.angle}, {*r.speed}); });
  add("largest and smallest stamp in turn", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.crank(r.stamp % 2 == 0 ? 4294967295999999999 : 0, kCrank, {r.angle}, {*r.speed});
  });
  add("stamps 1 ns apart", std::nullopt, [](Victim& v, const CrankReading& r) {
    for (int i = 0; i < 20; ++i) v.crank(r.stamp + i, kCrank, {r.angle + 1e-3 * i}, {*r.speed});
  });
  add("burst at 20 kHz", std::nullopt, [](Victim& v, const CrankReading& r) {
    for (int i = 0; i < 19; ++i) {
      v.crank(r.stamp + i * 50000, kCrank, {r.angle + *r.speed * 5e-5 * i}, {*r.speed});
    }
  });
  add("0.5 Hz", std::nullopt, [n = 0](Victim& v, const CrankReading& r) mutable {
    v.crank(1600000000000000000 + 2000000000LL * ++n, kCrank, {r.angle}, {*r.speed});
  });
  add("two publishers, same stamps", same_stamp, [](Victim& v, const CrankReading& r) {
    v.good(r);
    v.crank(r.stamp, kCrank, {r.angle + 2.0}, {*r.speed});
  });
  add("two publishers, a radian apart", Refusal::kImplausible, [](Victim& v, const CrankReading& r) {
    v.good(r);
    v.crank(r.stamp + 200000, kCrank, {r.angle + 1.0}, {*r.speed});
  });
  add("two publishers, one stands still", std::nullopt, [](Victim& v, const CrankReading& r) {
    v.good(r);
    v.crank(r.stamp + 200000, kCrank, {1.0}, {0.0});
  });
  return attacks;
}

std::vector<PipelineSettings> allSettings() {
  std::vector<PipelineSettings> all;
  const PipelineSettings shipped = loadFiles(configDirectory(), {}).value->pipeline;
  for (const auto& [name, level] : kRigidLevelNames) {
    all.push_back(shipped);
    all.back().level = level;
  }
  return all;
}

/// Good, attack, good.
void expectSurvival(const Attack& attack, const PipelineSettings& settings) {
  SCOPED_TRACE(testing::Message() << attack.name << ", level " << static_cast<int>(settings.level));
  Victim victim(settings);
  victim.work(kUndisturbedFrom, kAttack);
  ASSERT_GT(victim.accepted(), 900u) << "the channel must work before";
  std::uint64_t hostile = 0;
  const std::uint64_t refused = attack.refusal ? victim.refused(*attack.refusal) : 0;
  victim.work(kAttack, kSoundFrom, [&](const CrankReading& r) { attack.strike(victim, r), ++hostile; });
  ASSERT_GT(hostile, 90u);
  if (attack.refusal) {
    EXPECT_GE(victim.refused(*attack.refusal), refused + hostile);
  }
  const std::uint64_t accepted = victim.accepted();
  victim.work(kSoundFrom, kSoundFrom + kOneTurn);
  EXPECT_GE(victim.firstAccepted(), kSoundFrom) << "output must come back";
  EXPECT_LT(victim.firstAccepted(), kSoundFrom + kOneTurn);
  victim.forgetErrors();
  victim.work(kSoundFrom + kOneTurn, kUntil);
  EXPECT_TRUE(victim.finite());
  // 900 samples; what contradicted the model is withheld until a whole half turn before the blow agrees (CrankTrust).
  EXPECT_GT(victim.accepted(), accepted + 500u);
  if (settings.level == Level::kRocker) {  // once the attack is a turn ago
    EXPECT_LE(victim.worst(), kUndisturbedError);
  }
}

TEST(InputAttack, ValuesOfTheCrank) {
  for (const PipelineSettings& settings : allSettings()) {
    for (const Attack& attack : valueAttacks()) expectSurvival(attack, settings);
  }
}

TEST(InputAttack, ShapesOfTheCrankMessage) {
  for (const PipelineSettings& settings : allSettings()) {
    for (const Attack& attack : shapeAttacks()) expectSurvival(attack, settings);
  }
}

TEST(InputAttack, StampsAndPublishersOfTheCrank) {
  for (PipelineSettings settings : allSettings()) {
    for (const CrankStamps stamps : {CrankStamps::kAuto, CrankStamps::kHeader}) {
      settings.crank_stamps = stamps;
      for (const Attack& attack : timeAttacks(stamps)) expectSurvival(attack, settings);
    }
  }
}

struct BoomAttack {
  const char* name;
  Names names;
  Numbers angles;
};

TEST(InputAttack, TheBoomsAngles) {
  const Names million(1000000, "joint");
  const BoomAttack attacks[] = {
      {"NaN", kBoom, {kNan, kNan, kNan}},
      {"infinite", kBoom, {kInf, -kInf, kInf}},
      {"1e308", kBoom, {1e308, 1e308, 1e308}},
      {"1e308 and its opposite", kBoom, {1e308, -1e308, 1e308}},
      {"denormal", kBoom, {5e-324, -5e-324, 5e-324}},
      {"no angles", kBoom, {}},
      {"too few angles", kBoom, {-0.35}},
      {"no names", {}, kBoomAngles},
      {"empty names", {"", "", ""}, kBoomAngles},
      {"a joint missing", {"boom_joint", "hammer_joint"}, {-0.35, -0.85}},
      {"permuted", {"hammer_joint", "swing_joint", "arm_joint", "boom_joint"}, {-0.85, kNan, 1.2, -0.35}},
      {"given twice", {"boom_joint", "boom_joint", "arm_joint"}, {-0.35, kNan, 1.2}},
      {"degrees", kBoom, {-20.0, 68.8, -48.7}},
      {"a million names", million, {}},
      {"a million angles", kBoom, Numbers(1000000, kNan)}};
  for (const BoomAttack& attack : attacks) {
    for (const PipelineSettings& settings : allSettings()) {
      SCOPED_TRACE(attack.name);
      Victim victim(settings);
      victim.work(kUndisturbedFrom, kAttack);
      const std::uint64_t accepted = victim.accepted();
      ASSERT_GT(accepted, 900u);
      victim.boom(attack.names, attack.angles);
      victim.work(kAttack, kSoundFrom, [&](const CrankReading& r) { victim.good(r); });
      EXPECT_GT(victim.accepted(), accepted + 90u) << "the crank goes on";
      EXPECT_TRUE(std::isfinite(victim.pipeline().hull().pitch().pitch()));
      victim.forgetErrors();
      victim.work(kSoundFrom, kUntil);
      EXPECT_TRUE(victim.finite());
      if (settings.level == Level::kRocker) {
        EXPECT_LE(victim.worst(), kUndisturbedError) << "good angles count at once";
      }
    }
  }
}

TEST(InputAttack, AnglesOfTheBoomThatCannotBeAreCounted) {
  HullPitch pitch(kBoom, 0.1);
  EXPECT_TRUE(pitch.update(kBoom, kBoomAngles));
  EXPECT_DOUBLE_EQ(pitch.pitch(), 0.0);
  std::uint64_t refused = 0;
  for (const double bad : {kNan, kInf, -kInf, 1e308, -1e308, 1e5}) {
    EXPECT_FALSE(pitch.update({"boom_joint"}, {bad})) << bad;
    EXPECT_EQ(pitch.refused(), ++refused) << bad;
    EXPECT_DOUBLE_EQ(pitch.pitch(), 0.0) << bad;
  }
  EXPECT_FALSE(pitch.update(kBoom, {}));
  EXPECT_EQ(pitch.refused(), refused + 3);
  EXPECT_FALSE(pitch.looksLikeDegrees());
  EXPECT_TRUE(pitch.update(kBoom, {-20.0, 68.8, -48.7}));
  EXPECT_TRUE(pitch.looksLikeDegrees());
  EXPECT_TRUE(pitch.update(kBoom, kBoomAngles));
  EXPECT_FALSE(pitch.looksLikeDegrees());
}

}  // namespace
}  // namespace hammer_loads
