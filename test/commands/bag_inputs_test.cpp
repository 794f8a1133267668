/// Inputs of process_bag: split bags count as one run, and unusable bags are reported.
#include "commands/bag_files.h"

namespace hammer_loads {
namespace {

using test::contentOfBag;
using test::kSession;

class BagInputFiles : public test::BagFiles {
 protected:
  /// Returns the session split into `count` bags, cut between messages.
  std::vector<std::string> split(int count) const {
    constexpr int kMessages = 4479;
    std::vector<std::string> files;
    std::vector<std::unique_ptr<rosbag::Bag>> bags;
    for (int i = 0; i < count; ++i) {
      files.push_back(path("split_" + std::to_string(i) + ".bag"));
      bags.push_back(std::make_unique<rosbag::Bag>(files.back(), rosbag::bagmode::Write));
    }
    int i = 0;
    test::forEachOfSession([&](const rosbag::MessageInstance& item) {
      bags[static_cast<std::size_t>(i++ * count / kMessages)]->write(item.getTopic(), item.getTime(), item);
    });
    return files;
  }
  /// Writes a bag of one message.
  template <typename Message>
  std::string write(const std::string& name, const std::string& topic, const Message& message) const {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    bag.write(topic, ros::Time(1.0), message);
    return path(name);
  }
};

TEST_F(BagInputFiles, SplitsOfARecordingAreOneRun) {
  ASSERT_EQ(run(kSession + " " + path("whole.bag")).exit_code, 0);
  const std::vector<std::string> whole = contentOfBag(path("whole.bag"));
  ASSERT_GT(whole.size(), 8000U);
  const std::vector<std::string> f = split(3);
  const std::string in_order = f[0] + " " + f[1] + " " + f[2], another = f[2] + " " + f[0] + " " + f[1];
  int number = 0;
  for (const std::string& files : {in_order, another}) {
    const std::string out = path("out_" + std::to_string(number++) + ".bag");
    const test::Outcome outcome = run(files + " " + out);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(contentOfBag(out) == whole) << files;
    EXPECT_EQ(test::linesOf(outcome.out).size(), 1U);
    for (const char* word : {"2979 crank samples", " wrenches", "122 turns", out.c_str()})
      EXPECT_NE(outcome.out.find(word), std::string::npos) << outcome.out;
  }
  // A single part starts without the state from the parts before it.
  ASSERT_EQ(run(f[1] + " " + path("part.bag")).exit_code, 0);
  EXPECT_LT(contentOfBag(path("part.bag")).size(), whole.size() / 2);
}

TEST_F(BagInputFiles, ABagGivenTwiceIsRefused) {
  std::filesystem::create_symlink(kSession, path("again.bag"));
  expectRefused(run(kSession + " " + path("again.bag") + " " + path("out.bag")), {path("again.bag"), "twice"});
  EXPECT_EQ(names().size(), 1U);
}

TEST_F(BagInputFiles, AnUnindexedBagNamesReindex) {
  // After kill -9 the file header states that there is no index.
  std::string bytes = test::contentOf(kSession);
  const std::size_t index = bytes.find("index_pos=");
  ASSERT_LT(index, 200U);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(index + 10), 8, '\0');
  std::ofstream(path("killed.bag"), std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  expectRefused(run(path("killed.bag") + " " + path("out.bag")), {"rosbag reindex " + path("killed.bag")});
  std::ofstream(path("cut.bag"), std::ios::binary) << test::contentOf(kSession).substr(0, 100000);
  expectRefused(run(path("cut.bag") + " " + path("out.bag")), {"rosbag reindex " + path("cut.bag")});
  EXPECT_EQ(names().size(), 2U);
}

/// Chunks in the middle are overwritten: the index is intact, but the data it refers to are not.
TEST_F(BagInputFiles, ADamagedBagIsBlamedNotTheOutput) {
  std::string bytes = test::contentOf(kSession);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 3), 20000, '\x5a');
  std::ofstream(path("damaged.bag"), std::ios::binary) << bytes;
  const test::Outcome outcome = run(path("damaged.bag") + " " + path("out.bag"));
  expectRefused(outcome, {path("damaged.bag") + ": cannot be read"});
  EXPECT_EQ(names().size(), 1U);
}

/// A file of some kB claims 1 GB of unpacked data or a record of that length. No such memory is allocated.
TEST_F(BagInputFiles, ABagThatClaimsTooMuchIsRefused) {
  const std::string in = write("in.bag", "/hammer/crank", sensor_msgs::JointState()), good = test::contentOf(in);
  ASSERT_LT(good.size(), 10000U);
  // The chunk's index entry holds its position, at which the length of the chunk's header is stored.
  std::uint64_t chunk_at = 0;
  std::memcpy(&chunk_at, good.data() + good.find("chunk_pos=") + 10, sizeof chunk_at);
  const std::size_t field = good.find("size=", chunk_at);
  ASSERT_LT(field, chunk_at + 100);
  const auto with = [&](std::size_t place, std::uint32_t value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + place, &value, sizeof value);
    std::ofstream(path("bad.bag"), std::ios::binary) << bytes;
    const test::Outcome outcome = run(path("bad.bag") + " " + path("out.bag"));
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(test::linesOf(outcome.err).size(), 1U) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(with(field + 5, 0x3fffffffU).find("claims to hold 1073741823, must be at most"), std::string::npos);
  EXPECT_NE(with(chunk_at, 0xfffffff0U).find("a record reaches beyond the file's end"), std::string::npos);
}

TEST_F(BagInputFiles, NamesAFileThatIsNoBag) {
  std::ofstream(path("text.bag")) << "no bag at all\n";
  expectRefused(run(path("text.bag") + " " + path("out.bag")), {path("text.bag") + ": cannot be read as a bag"});
  expectRefused(run(path("none.bag") + " " + path("out.bag")), {path("none.bag"), "No such file or directory"});
  expectRefused(run(directory_.string() + " " + path("out.bag")), {"no regular file"});
  const test::Outcome both = run(path("none.bag") + " " + path("text.bag") + " " + path("out.bag"));
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_EQ(test::linesOf(both.err).size(), 2U) << both.err;
  EXPECT_EQ(run(path("none.bag")).exit_code, 2) << "no output given";
  EXPECT_EQ(names().size(), 1U);
}

TEST_F(BagInputFiles, AMissingTopicListsWhatIsThere) {
  const std::string in = write("in.bag", "/machine/speed", sensor_msgs::JointState());
  expectRefused(run(in + " " + path("out.bag")),
                {in, "/hammer/crank, is required", "/machine/speed (sensor_msgs/JointState)"});
  expectRefused(run(in + " " + path("out.bag") + " --crank-topic /x"), {"no topic /x"});
  { rosbag::Bag(path("nothing.bag"), rosbag::bagmode::Write); }
  expectRefused(run(path("nothing.bag") + " " + path("out.bag")), {"topics there: none"});
}

TEST_F(BagInputFiles, ATopicOfAnotherTypeIsNamed) {
  const std::string in = write("in.bag", "/hammer/crank", sensor_msgs::Imu());
  expectRefused(run(in + " " + path("out.bag")),
                {"/hammer/crank is of type sensor_msgs/Imu, must be sensor_msgs/JointState"});
}

TEST_F(BagInputFiles, SamplesThatAreAllRefusedNameTheReasonAndTheJointsThere) {
  const auto writeSamples = [&](const char* name, const std::vector<std::string>& joints, double position) {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    sensor_msgs::JointState m;
    m.name = joints;
    m.position.assign(joints.size(), position);
    for (int i = 1; i < 50; ++i) bag.write("/hammer/crank", m.header.stamp = ros::Time(1.0 + 0.01 * i), m);
  };
  writeSamples("in.bag", {"crank", "flywheel"}, 0.0);
  writeSamples("nan.bag", {"hammer_crank_joint"}, std::nan(""));
  expectRefused(run(path("in.bag") + " " + path("out.bag")),
                {"no wrench from 49 messages on /hammer/crank", "hammer_crank_joint", "crank, flywheel"});
  expectRefused(run(path("nan.bag") + " " + path("out.bag")), {"no wrench", "not finite 49"});
  const test::TemporaryFile right("crank_joint: crank\n");
  EXPECT_EQ(run(path("in.bag") + " " + path("out.bag") + " --params " + right.path()).exit_code, 0);
  EXPECT_EQ(names().size(), 3U);
}

}  // namespace
}  // namespace hammer_loads
