/// Entry of a test executable.
#pragma once

#include <gtest/gtest.h>

#define HAMMER_LOADS_TEST_MAIN            \
  int main(int argc, char** argv) {       \
    testing::InitGoogleTest(&argc, argv); \
    return RUN_ALL_TESTS();               \
  }
