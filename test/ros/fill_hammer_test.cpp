#include "hammer_loads/ros/fill_hammer.h"

#include <gtest/gtest.h>

namespace hammer_loads {
namespace {

constexpr std::uint16_t kInconsistent = HullLoads::FLAG_INCONSISTENT, kImpossible = Blow::FLAG_IMPOSSIBLE;

TEST(FillHammer, FlagsOfHullLoadsAreThoseOfThisSample) {
  HullLoads message;
  SampleResult result;
  result.pitch_known = true;
  const WrenchOutput output{};
  fillHullLoads(result, output, message);
  EXPECT_EQ(message.flags, 0);
  result.inconsistent = true;
  fillHullLoads(result, output, message);
  EXPECT_EQ(message.flags, kInconsistent);
  result.inconsistent = false;
  fillHullLoads(result, output, message);
  EXPECT_EQ(message.flags, 0) << "the message is used again";
}

TEST(FillHammer, FlagsOfABlowAreItsOwn) {
  Blow message;
  TurnEnd end;
  fillBlow(end, message);
  EXPECT_EQ(message.flags, 0);
  end.blow.impossible = true;
  fillBlow(end, message);
  EXPECT_EQ(message.flags, kImpossible);
  end.blow.impossible = false;
  fillBlow(end, message);
  EXPECT_EQ(message.flags, 0) << "the message is used again";
}

}  // namespace
}  // namespace hammer_loads
