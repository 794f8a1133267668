#include "hammer_loads/util/format.h"

#include <gtest/gtest.h>

namespace hammer_loads {
namespace {

/// A path of 4095 characters is a legal one, and the message must name it.
TEST(Format, ALineIsAsLongAsItsParts) {
  const std::string path(4095, 'x');
  EXPECT_EQ(format("%s: %d, must be %.1f", path.c_str(), 7, 0.5), path + ": 7, must be 0.5");
  EXPECT_EQ(format("%s", ""), "");
}

}  // namespace
}  // namespace hammer_loads
