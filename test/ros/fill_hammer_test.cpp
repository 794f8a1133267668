#include <gtest/gtest.h>

#include "hammer_loads/ros/fill_messages.h"

namespace hammer_loads {
namespace {

TEST(FillHammer, FlagsAreThoseOfThisSampleAndThisBlow) {
  HullLoads loads;
  Blow blow;
  SampleResult result;
  result.pitch_known = true;
  TurnEnd end;
  for (const bool flagged : {false, true, false}) {  // the messages are reused
    result.inconsistent = end.blow.impossible = flagged;
    fillHullLoads(result, WrenchOutput{}, loads);
    fillBlow(end, blow);
    EXPECT_EQ(loads.flags, flagged ? std::uint16_t{HullLoads::FLAG_INCONSISTENT} : 0);
    EXPECT_EQ(blow.flags, flagged ? std::uint16_t{Blow::FLAG_IMPOSSIBLE} : 0);
  }
}

}  // namespace
}  // namespace hammer_loads
