#include "hammer_loads/pipeline/hull_pitch.h"

#include <gtest/gtest.h>

#include <limits>

namespace hammer_loads {
namespace {

TEST(HullPitch, IsTheSumOnceEveryJointWasReceived) {
  HullPitch pitch({"boom", "arm", "hammer"}, 0.7);
  EXPECT_TRUE(pitch.update({"arm", "swing"}, {0.2, 9.0}));
  EXPECT_EQ(pitch.pitch(), 0.7);
  EXPECT_EQ(pitch.unheard(), (std::vector<std::string>{"boom", "hammer"}));
  EXPECT_TRUE(pitch.update({"hammer", "boom"}, {-0.5, 0.1}));
  EXPECT_TRUE(pitch.known());
  EXPECT_DOUBLE_EQ(pitch.pitch(), 0.2 - 0.5 + 0.1);
}

TEST(HullPitch, SignsAndOffsetCountOnceItIsKnown) {
  HullPitch pitch({"boom", "arm"}, {1, -1}, 0.5, 0.7);
  EXPECT_TRUE(pitch.update({"arm"}, {0.2}));
  EXPECT_EQ(pitch.pitch(), 0.7);
  EXPECT_TRUE(pitch.update({"boom"}, {0.1}));
  EXPECT_DOUBLE_EQ(pitch.pitch(), 0.5 + 0.1 - 0.2);
}

TEST(HullPitch, ForeignJointsChangeNothing) {
  HullPitch pitch({"boom"}, 0.0);
  EXPECT_FALSE(pitch.update({"wheel"}, {1.0}));
  EXPECT_FALSE(pitch.known());
}

TEST(HullPitch, RefusesAnglesThatAreNoNumbersOrMissing) {
  HullPitch pitch({"boom"}, 0.0);
  EXPECT_TRUE(pitch.update({"boom"}, {0.3}));
  EXPECT_FALSE(pitch.update({"boom"}, {std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(pitch.update({"x", "boom"}, {1.0}));
  EXPECT_EQ(pitch.refused(), 2u);
  EXPECT_EQ(pitch.pitch(), 0.3);
}

TEST(HullPitch, NoJointsKeepThePitch) {
  const HullPitch pitch({}, 0.4);
  EXPECT_TRUE(pitch.known());
  EXPECT_EQ(pitch.pitch(), 0.4);
}

}  // namespace
}  // namespace hammer_loads
