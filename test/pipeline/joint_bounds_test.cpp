// How far a boom's joint may jump and an encoder's count be off, within a factor of 1.25 of what is said.
#include <gtest/gtest.h>

#include "boom/booms.h"
#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/pipeline/joint_buffer.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;

/// Of the first joint, over a step [ms].
bool jumps(double way, StampNs step) {
  const Chain chain = *Chain::make(test::shippedUrdf(), {}).value;
  JointBuffer joints(chain, PipelineSettings{});
  const std::vector<std::string> names{chain.jointNames().front()};
  joints.update(kMs, names, {0.0}, {0.0});
  joints.update(kMs + step * kMs, names, {way}, {0.0});
  return joints.refusals().jumps > 0;
}

TEST(JointBounds, OfJumps) {
  EXPECT_FALSE(jumps(0.8 * 0.103, 1));
  EXPECT_TRUE(jumps(1.25 * 0.103, 1));
  EXPECT_FALSE(jumps(0.8 * 3.1, 1000));
  EXPECT_TRUE(jumps(1.25 * 3.1, 1000));
}

/// After so many steps of one count or two.
Encoder encoderAfter(int differences, double given = 0.0) {
  constexpr double kCount = kTwoPi / 1024.0;
  Encoder encoder(given);
  double reading = 0.0;
  encoder.angle(reading);
  for (int i = 0; i < differences; ++i) {
    reading += kCount * (1.0 + i % 2);
    encoder.angle(reading);
  }
  return encoder;
}

TEST(JointBounds, OfAnEncodersCount) {
  EXPECT_FALSE(encoderAfter(19).isKnown());
  EXPECT_TRUE(encoderAfter(30).isKnown());
  EXPECT_FALSE(encoderAfter(60, (1.0 + 0.8e-3) * kTwoPi / 1024.0).contradictsGiven());
  EXPECT_TRUE(encoderAfter(60, (1.0 + 1.25e-3) * kTwoPi / 1024.0).contradictsGiven());
}

}  // namespace
}  // namespace hammer_loads
