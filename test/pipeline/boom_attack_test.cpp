// Hostile angles of the boom: the crank's loads go on, and good angles count at once.
#include "pipeline/input_attack.h"

namespace hammer_loads::test {
namespace {

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

}  // namespace
}  // namespace hammer_loads::test
