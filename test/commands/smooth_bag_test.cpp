// process_bag --smooth: what it marks, what it refuses, run by run.
#include <hammer_loads/Blow.h>
#include <hammer_loads/HullLoads.h>

#include "commands/bag_files.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

using test::contentOf;
using test::contentOfBag;
using test::kSession;

class SmoothBag : public test::BagFiles {
 protected:
  std::string smoothed(const std::string& in, const std::string& name, const std::string& more = {}) const {
    const test::Outcome outcome = run(in + " " + path(name) + " --smooth " + more);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("by later samples as well"), std::string::npos) << outcome.err;
    return path(name);
  }
};

template <typename Message>
std::vector<Message> messagesIn(const std::string& path) {
  std::vector<Message> messages;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    if (const auto message = item.instantiate<Message>()) messages.push_back(*message);
  }
  return messages;
}

TEST_F(SmoothBag, GivesOtherValuesAtTheSameInstantsAndSaysSo) {
  const std::string live = path("live.bag");
  ASSERT_EQ(run(kSession + " " + live).exit_code, 0);
  const std::string out = smoothed(kSession, "out.bag");
  const auto was = messagesIn<HullLoads>(live), is = messagesIn<HullLoads>(out);
  ASSERT_EQ(was.size(), is.size());
  std::size_t others = 0, surer = 0;
  for (std::size_t i = 0; i < is.size(); ++i) {
    EXPECT_EQ(is[i].header.stamp, was[i].header.stamp);
    others += is[i].force_z_N != was[i].force_z_N;
    surer += is[i].force_z_deviation_N < was[i].force_z_deviation_N;
  }
  EXPECT_GT(others, is.size() * 9 / 10);
  EXPECT_GT(surer, is.size() / 2);
  EXPECT_EQ(messagesIn<Blow>(live).size(), messagesIn<Blow>(out).size());
  const auto infos = messagesIn<RunInfo>(out), live_infos = messagesIn<RunInfo>(live);
  ASSERT_EQ(infos.size(), 1U);
  ASSERT_EQ(infos[0].notes.size(), live_infos.at(0).notes.size() + 1);
  EXPECT_EQ(infos[0].notes.back().rfind("smooth: ", 0), 0U);
}

TEST_F(SmoothBag, ASecondRunGivesTheSameBytes) {
  EXPECT_TRUE(contentOf(smoothed(kSession, "one.bag")) == contentOf(smoothed(kSession, "two.bag")));
}

TEST_F(SmoothBag, RunsOfARecordingAreSmoothedEachByItself) {
  const ros::Time start(1700000000.0), middle(1700000015.0), end(1700000100.0);
  const std::string yaml = loadFiles(configDirectory(), {}).value->yaml;
  const auto write = [&](const std::string& name, const ros::Time& from, const ros::Time& to, bool marked) {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    RunInfo info;
    info.parameters_yaml = yaml;
    for (const ros::Time& time : {start, middle}) {
      info.header.stamp = time;
      if (marked && time >= from && time < to) bag.write("/hammer_loads/run_info", time, info);
    }
    test::forEachOfSession([&](const rosbag::MessageInstance& item) {
      if (item.getTime() >= from && item.getTime() < to) bag.write(item.getTopic(), item.getTime(), item);
    });
    return path(name);
  };
  std::vector<std::string> parts = contentOfBag(smoothed(write("a.bag", start, middle, true), "a_out.bag"));
  const std::vector<std::string> second = contentOfBag(smoothed(write("b.bag", middle, end, true), "b_out.bag"));
  EXPECT_GT(second.size(), 1000U);
  const std::vector<std::string> whole = contentOfBag(smoothed(write("whole.bag", start, end, true), "whole_out.bag"));
  EXPECT_EQ(messagesIn<RunInfo>(path("whole_out.bag")).size(), 2U);
  EXPECT_EQ(whole.size(), parts.size() + second.size());
}

TEST_F(SmoothBag, WhatItWouldMixIsRefused) {
  EXPECT_EQ(run(kSession + " " + path("out.bag") + " --smooth --ledger " + path("machine.sqlite")).exit_code, 2);
  EXPECT_EQ(names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace hammer_loads
