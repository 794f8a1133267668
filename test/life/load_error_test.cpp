// The range of a turn's extremes and how far it may be off.
#include "hammer_loads/life/load_error.h"

#include <gtest/gtest.h>

namespace hammer_loads::life {
namespace {

TEST(TurnExtremes, ASampleThatIsHardlyKnownMayBeTheExtreme) {
  TurnExtremes known, hardly;
  for (TurnExtremes* turn : {&known, &hardly}) {
    turn->add(10.0, {1.0, 0.1});
    turn->add(0.0, {2.0, 0.2});
  }
  known.add(4.0, {3.0, 9.0});    // 1 to 7: within
  hardly.add(4.0, {12.0, 9.0});  // -8 to 16
  EXPECT_EQ(known.range(), 10.0);
  EXPECT_EQ(hardly.range(), 10.0);
  EXPECT_DOUBLE_EQ(known.ofRange().own, std::hypot(1.0, 2.0));
  EXPECT_DOUBLE_EQ(hardly.ofRange().own, std::hypot(6.0, 8.0));
  EXPECT_DOUBLE_EQ(hardly.ofRange().common, 0.3);
}

TEST(TurnExtremes, HaveNoDeviationWithoutThoseOfSamples) {
  TurnExtremes turn;
  turn.add(1.0, {});
  turn.add(3.0, {});
  EXPECT_EQ(turn.range(), 2.0);
  EXPECT_TRUE(std::isnan(turn.ofRange().own));
}

}  // namespace
}  // namespace hammer_loads::life
