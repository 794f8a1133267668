// Descriptions designed to break the reader: size, depth, loops, numbers.
#include <gtest/gtest.h>

#include "boom/booms.h"
#include "hammer_loads/boom/robot_description.h"

namespace hammer_loads {
namespace {

std::string repeated(const std::string& piece, int times) {
  std::string text;
  text.reserve(piece.size() * static_cast<std::size_t>(times));
  for (int i = 0; i < times; ++i) text += piece;
  return text;
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child) {
  return "<joint name=\"" + name + "\" type=\"continuous\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><axis xyz=\"0 1 0\"/></joint>";
}
std::string plainLink(const std::string& name) {
  return "<link name=\"" + name +
         "\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>"
         "</inertial></link>";
}

/// Returns a description whose links from base_link to hammer_hull form one chain.
std::string row(int links) {
  std::string text = "<robot name=\"r\">" + plainLink("base_link");
  std::string parent = "base_link";
  for (int i = 1; i < links; ++i) {
    const std::string child = i + 1 == links ? "hammer_hull" : format("l%d", i);
    text += plainLink(child) + joint(format("j%d", i), parent, child);
    parent = child;
  }
  return text + "</robot>";
}

void expectOne(const std::string& urdf, const std::string& line) {
  const Checked<Boom> made = Boom::make(urdf);
  EXPECT_FALSE(made.value);
  ASSERT_EQ(made.problems.size(), 1U) << line << (made.problems.empty() ? "" : ": " + made.problems.back());
  EXPECT_EQ(made.problems[0], "robot_description: " + line);
  EXPECT_EQ(linksMissing(urdf, {}), "");
}

TEST(HostileUrdf, RefusesTooManyLinks) {
  expectOne(row(10000), "more than 1000 links, must be at most 1000");
  // The parsers accept a description at the limit. The chain then reports its own problem.
  const Checked<Boom> made = Boom::make(row(1000));
  ASSERT_EQ(made.problems.size(), 1U);
  EXPECT_EQ(made.problems[0].rfind("robot_description: 999 moving joints and 1000 links", 0), 0U) << made.problems[0];
}

TEST(HostileUrdf, RefusesTooManyJoints) {
  std::string text = "<robot name=\"r\">" + plainLink("base_link") + plainLink("hammer_hull");
  for (int i = 0; i < 1001; ++i) text += joint(format("j%d", i), "base_link", "hammer_hull");
  expectOne(text + "</robot>", "more than 1000 joints, must be at most 1000");
}

TEST(HostileUrdf, RefusesTooManyNestedTags) {
  const std::string line = "more than 64 tags within tags, must be at most 64";
  for (const char* tag : {"<a>", "<link>", "<robot name='r'>", "<_ b='/>'>", "<\xc3\xa4>"}) {
    expectOne(repeated(tag, 1000000), line);
    expectOne("<!-- > --><?xml version=\"1.0\"?>" + repeated(tag, 65), line);
  }
  expectOne(repeated("<a>", 65) + repeated("</a>", 65), line);
  // Closing tags without an open one do not reduce the depth. Neither do comments, quotes and character data.
  expectOne(repeated("</a>", 2000) + repeated("<a>", 2000), line);
  expectOne(repeated("<a><!-- </a> -->", 2000), line);
  expectOne(repeated("<a><![CDATA[</a>]]>", 2000), line);
  expectOne(repeated("<a b='</a>'>", 2000), "cannot be read: a tag that does not end");
  expectOne(repeated("<a><?xml version='></a>'?>", 2000), "cannot be read: a tag that does not end");
}

TEST(HostileUrdf, RefusesAHugeText) {
  const std::string text = test::shippedUrdf();
  expectOne(text + std::string(UrdfLimits::kBytes, ' '),
            format("%zu bytes, must be at most 16777216", text.size() + UrdfLimits::kBytes));
}

/// Random well-formed text of known depth and number of links, with content that may confuse a counter.
class RandomXml {
 public:
  explicit RandomXml(unsigned seed) : random_(seed) {}
  std::string text(int depth, int links) {
    std::string inside = repeated("<link name='a>b'/>", links) + "<other>" + nested(depth - 2) + "</other>";
    return "<?xml version=\"1.0\"?><!DOCTYPE robot><robot name=\"/>\" >" + noise() + inside + "</robot >";
  }

 private:
  std::string nested(int depth) {
    if (depth == 0) return noise();
    const std::string beside = noise() + "<link/>" + noise() + "<joint></joint>";
    return beside + "<a\tb = \"'>\" c='\">/'>" + nested(depth - 1) + "</a\n>" + (depth > 1 ? beside : noise());
  }
  std::string noise() {
    constexpr const char* kNoise[] = {"",
                                      " text / > \" ' ",
                                      "<!-- <a><a> </a -- > ' -->",
                                      "<![CDATA[ <a> ]] > </a> ]]>",
                                      "<empty/>",
                                      "<empty x=\"\" />",
                                      "&lt;a&gt;"};
    return kNoise[std::uniform_int_distribution<std::size_t>(0, 6)(random_)];
  }
  std::mt19937 random_;
};

TEST(HostileUrdf, CountsExactlyWhatIsThere) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomXml xml(seed);
    // The innermost tags are one level deeper than the argument: a depth of 63 has tags in level 64.
    EXPECT_EQ(urdfLimitPassed(xml.text(62, 1000)), "");
    EXPECT_NE(urdfLimitPassed(xml.text(65, 10)).find("64 tags"), std::string::npos);
    EXPECT_NE(urdfLimitPassed(xml.text(10, 1001)).find("1000 links"), std::string::npos);
  }
  EXPECT_EQ(urdfLimitPassed(repeated("<a>", 64) + repeated("</a>", 64)), "");
  EXPECT_EQ(urdfLimitPassed(test::shippedUrdf()), "");
  EXPECT_EQ(urdfLimitPassed(""), "");
}

TEST(HostileUrdf, RefusesLoopsAndSharedChildren) {
  const std::string three = "<robot name=\"r\">" + plainLink("base_link") + plainLink("hammer_hull") + plainLink("c");
  // One loop is beside the root, the other is connected to it.
  expectOne(three + joint("j", "hammer_hull", "c") + joint("k", "c", "hammer_hull") + "</robot>",
            "link c: hangs on itself, must hang on the root");
  expectOne(three + joint("i", "base_link", "hammer_hull") + joint("j", "hammer_hull", "c") +
                joint("k", "c", "hammer_hull") + "</robot>",
            "link hammer_hull: child of more than one joint, must be of one");
  // A ladder with two joints at each step has 2^400 paths.
  std::string ladder = "<robot name=\"r\">" + plainLink("base_link");
  std::string parent = "base_link";
  for (int i = 0; i < 400; ++i) {
    const std::string child = i == 399 ? "hammer_hull" : format("l%d", i);
    ladder += plainLink(child) + joint(format("a%d", i), parent, child) + joint(format("b%d", i), parent, child);
    parent = child;
  }
  const Checked<Boom> made = Boom::make(ladder + "</robot>");
  ASSERT_EQ(made.problems.size(), 400U);
  EXPECT_NE(made.problems[0].find("child of more than one joint"), std::string::npos);
}

TEST(HostileUrdf, RefusesNumbersOfNoMachine) {
  const std::string good = test::shippedUrdf();
  const auto expectAbout = [&](const std::string& from, const std::string& to, const std::string& named) {
    const Checked<Boom> made = Boom::make(test::withFirstReplaced(good, from, to));
    EXPECT_FALSE(made.value) << to;
    ASSERT_FALSE(made.problems.empty()) << to;
    EXPECT_NE(made.problems[0].find(named), std::string::npos) << made.problems[0];
    EXPECT_EQ(made.problems[0].find('\n'), std::string::npos);
    EXPECT_EQ(made.problems[0].rfind("robot_description: ", 0), 0U);
  };
  const std::string mass = "<mass value=\"230\"/>";
  for (const char* value : {"nan", "inf", "-inf", "1e999", "x", "", "0x10"})
    expectAbout(mass, format("<mass value=\"%s\"/>", value), "Could not parse inertial element for Link [arm_link]: ");
  expectAbout(mass, "", "Could not parse inertial element for Link [arm_link]: ");
  for (const char* value : {"1e308", "-1e308", "-1e-300", "1.1e9"})
    expectAbout(mass, format("<mass value=\"%s\"/>", value), "mass of link arm_link: ");
  expectAbout("xyz=\"0.70 0 0.06\"", "xyz=\"1e308 0 0\"", "centre of mass of link arm_link");
  expectAbout("xyz=\"1.70 0 0\"", "xyz=\"0 -1e308 0\"", "origin of joint hammer_joint");
  expectAbout("xyz=\"1.70 0 0\"", "xyz=\"nan 0 0\"", "cannot be read");
  expectAbout("iyy=\"86.03\"", "iyy=\"1e308\"", "inertia of link arm_link");
  expectAbout("iyy=\"86.03\"", "iyy=\"-86.03\"", "inertia of link arm_link");
  for (const char* axis : {"0 0 0", "1e308 0 0", "0 1e-300 0"})
    expectAbout("<axis xyz=\"0 0 1\"/>", format("<axis xyz=\"%s\"/>", axis), "joint swing_joint");
  // Massless links are allowed as long as something beyond each joint is heavy.
  EXPECT_TRUE(Boom::make(test::withFirstReplaced(good, mass, "<mass value=\"0\"/>")).value);
}

TEST(HostileUrdf, InertiaBeyondACylinderIsRequired) {
  // Everything beyond the last joint is a point mass on its axis.
  std::string urdf = test::shippedUrdf();
  const std::string none = "<inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"/>";
  urdf = test::withFirstReplaced(
      urdf, "<inertia ixx=\"0.5208\" ixy=\"0\" ixz=\"0\" iyy=\"1.104\" iyz=\"0\" izz=\"1.104\"/>", none);
  urdf = test::withFirstReplaced(urdf, "<origin xyz=\"0.03 0 -0.06\" rpy=\"0 0 0\"/>", "");
  urdf = test::withFirstReplaced(urdf, "<mass value=\"350\"/>", "<mass value=\"0\"/>");
  urdf = test::withFirstReplaced(
      urdf, "<inertia ixx=\"24.65\" ixy=\"0\" ixz=\"0\" iyy=\"29.9\" iyz=\"0\" izz=\"12.4\"/>", none);
  const Checked<Boom> made = Boom::make(urdf, test::shippedBoomParameters());
  ASSERT_EQ(made.problems.size(), 1U);
  EXPECT_EQ(made.problems[0],
            "robot_description: inertia beyond joint hammer_joint about its axis: 0 kg m2, must be > 0");
  EXPECT_TRUE(Boom::make(urdf).value);  // a rigid boom needs none
}

}  // namespace
}  // namespace hammer_loads
