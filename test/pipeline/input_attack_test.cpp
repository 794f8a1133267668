// Hostile input of the crank. Loads are always finite, or refused and counted. One revolution after the attack they are
// correct again.
#include "pipeline/input_attack.h"

namespace hammer_loads::test {
namespace {

struct Attack {
  const char* name;
  std::optional<Refusal> refusal;  ///< of every hostile message; none: it may be accepted
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

/// Equal stamps are duplicates where header stamps are used. Otherwise they are a burst, whose angles must then fit.
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

/// Plays good readings, the attack, and good readings again.
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
  // Of 900 samples, those after a contradiction are withheld until a half revolution before a blow agrees (CrankTrust).
  EXPECT_GT(victim.accepted(), accepted + 500u);
  if (settings.level == Level::kRocker) {  // one revolution after the attack
    EXPECT_LE(victim.worst(), kUndisturbedError);
  }
}

TEST(InputAttack, SurvivesAnyValuesOfTheCrank) {
  for (const PipelineSettings& settings : allSettings()) {
    for (const Attack& attack : valueAttacks()) expectSurvival(attack, settings);
  }
}

TEST(InputAttack, SurvivesAnyShapeOfTheCrankMessage) {
  for (const PipelineSettings& settings : allSettings()) {
    for (const Attack& attack : shapeAttacks()) expectSurvival(attack, settings);
  }
}

TEST(InputAttack, SurvivesAnyStampsAndPublishersOfTheCrank) {
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

TEST(InputAttack, SurvivesAnyAnglesOfTheBoom) {
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
      EXPECT_TRUE(std::isfinite(victim.pipeline().hull().pitch().pitch()));
      victim.work(kAttack, kSoundFrom, [&](const CrankReading& r) { victim.good(r); });
      EXPECT_GT(victim.accepted(), accepted + 90u) << "the crank goes on";
      victim.forgetErrors();
      victim.work(kSoundFrom, kUntil);
      EXPECT_TRUE(victim.finite());
      if (settings.level == Level::kRocker) {
        EXPECT_LE(victim.worst(), kUndisturbedError) << "good angles count at once";
      }
    }
  }
}

}  // namespace
}  // namespace hammer_loads::test
