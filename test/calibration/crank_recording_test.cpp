#include "hammer_loads/calibration/crank_recording.h"

#include <gtest/gtest.h>

#include "calibration/recorded.h"

namespace hammer_loads::calibration {
namespace {

using test::atWork;
using test::recorded;

TEST(CrankRecording, CountIsReadOff) {
  for (const int counts : {360, 10000}) {
    simulation::MachineSettings s = atWork(4.0, 1000.0);
    s.crank.counts = counts;
    s.crank.zero = 0.123;
    EXPECT_NEAR(trackOf(recorded(s), 1.0).facts.count, kTwoPi / counts, 1e-9 / counts) << counts;
  }
  simulation::MachineSettings fine = atWork(4.0, 1000.0);
  fine.crank.counts = 0;
  EXPECT_EQ(trackOf(recorded(fine), 1.0).facts.count, 0.0);
}

TEST(CrankRecording, SingleValuesRoundedToFloatKeepTheirCount) {
  std::vector<RecordedSample> samples = recorded(atWork(4.0, 1000.0));
  for (RecordedSample& s : samples) s.reading = static_cast<double>(static_cast<float>(s.reading));
  EXPECT_NEAR(trackOf(samples, 1.0).facts.count, kTwoPi / 4096, 1e-9);
}

TEST(CrankRecording, ExactStampsStayAndDisorderedOnesAreRetimed) {
  simulation::MachineSettings s = atWork(6.0, 1000.0);
  const std::vector<RecordedSample> exact = recorded(s);
  const CrankTrack plain = trackOf(exact, 1.0);
  EXPECT_FALSE(plain.facts.retimed);
  ASSERT_EQ(plain.points.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) ASSERT_EQ(plain.points[i].time, exact[i].time);

  for (const int way : {0, 1, 2}) {
    simulation::MachineSettings flawed = s;
    if (way == 0) flawed.crank.stamp_noise = 1e-3;
    if (way == 1) flawed.crank.stamp_step = 1e-3;
    if (way == 2) flawed.crank.burst = 10;
    const CrankTrack track = trackOf(recorded(flawed), 1.0);
    EXPECT_TRUE(track.facts.retimed);
    // The times differ from the true ones by a constant within 0.15 ms rms, of which 0.03 ms is the sampling's.
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (std::size_t i = 1000; i + 1000 < track.points.size() && i < exact.size(); ++i) {
      const double shift = track.points[i].time - exact[i].time;
      sum += shift, squares += shift * shift, n += 1.0;
    }
    EXPECT_LT(std::sqrt(squares / n - sum * sum / n / n), 1.5e-4) << way;
  }
}

TEST(CrankRecording, GapsStayGaps) {
  simulation::MachineSettings s = atWork(6.0, 1000.0);
  s.crank.drop_outs = {{3.0, 3.1}, {4.0, 4.05}};
  const CrankTrack track = trackOf(recorded(s), 1.0);
  std::vector<double> starts;
  for (const CrankPoint& point : track.points)
    if (point.starts) starts.push_back(point.time);
  ASSERT_EQ(starts.size(), 3U);
  EXPECT_NEAR(starts[1], 3.1, 2e-3);
  for (const BlowSegment& segment : cutAtBlows(track, 0.0)) {
    for (std::size_t i = 1; i < segment.points.size(); ++i)
      ASSERT_LT(segment.points[i].time - segment.points[i - 1].time, 4.6e-3);
  }
}

TEST(CrankRecording, NothingUsableIsNoTrouble) {
  EXPECT_TRUE(trackOf({}, 1.0).points.empty());
  std::vector<RecordedSample> odd{{0.0, std::nan(""), {}, {}}, {0.1, 1.0, {}, {}}, {0.1, 1.0, {}, {}}};
  EXPECT_TRUE(trackOf(odd, 1.0).points.empty());
}

}  // namespace
}  // namespace hammer_loads::calibration
