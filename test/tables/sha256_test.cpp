// SHA-256 against the examples of FIPS 180-2; tables_test.cpp compares with sha256sum.
#include <gtest/gtest.h>

#include "hammer_loads/tables/digest.h"
#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

TEST(Sha256, GivesThePublishedExamples) {
  const test::TemporaryFile abc("abc"), a("a"), bc("bc"), empty("");
  const std::string published = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  EXPECT_EQ(sha256OfFiles({abc.path()}), published);
  EXPECT_EQ(sha256OfFiles({a.path(), empty.path(), bc.path()}), published);
  EXPECT_EQ(sha256OfFiles({empty.path()}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256, DistinguishesWhereATextEnds) {
  EXPECT_NE(sha256Of({"ab", "c"}), sha256Of({"a", "bc"}));
  EXPECT_NE(sha256Of({"abc"}), sha256Of({"abc", ""}));
  EXPECT_EQ(sha256Of({"ab", "c"}), sha256Of({"ab", "c"}));
}

}  // namespace
}  // namespace hammer_loads
