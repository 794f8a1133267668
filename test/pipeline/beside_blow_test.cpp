// Checks samples and outputs that are closer to the blow than the crank's angle is known, against the simulated truth.
#include <gtest/gtest.h>

#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/functions.h"
#include "pipeline/shipped_machine.h"
#include "support/held_hull.h"

namespace hammer_loads {
namespace {

/// Counts from 4 s, when the readings of six revolutions have determined the zero, to 11 s, before the machine stops.
struct Published {
  std::size_t samples{}, outputs{}, beside{};
  std::size_t wrong_withheld{};   ///< samples beside the blow whose likelier side is not the true one
  std::size_t wrong_published{};  ///< outputs on the wrong side of the blow at their stamp
};

bool isAfter(double truth_angle) { return truth_angle < 0.5 * kTwoPi; }
bool isNear(const CrankEstimate& crank) { return std::abs(crank.position.angle.offset) < 0.1; }
bool isAfter(const CrankEstimate& crank) { return crank.position.angle.side == Side::kAfterBlow; }

/// Plays a machine at work at 1 kHz. Its stamps have a standard deviation [s] and its encoder's zero an error [rad].
Published published(double stamp_noise, OutputKind kind, double output_rate, std::uint64_t seed, double zero = 0.0) {
  const Settings shipped = test::heldHull(*load(configDirectory(), {}).value);
  simulation::MachineSettings machine = test::shippedMachine(shipped, 12.0, seed);
  machine.crank.stamp_noise = stamp_noise;
  machine.crank.zero = zero;
  const simulation::Session session = simulation::recordSession(machine);
  PipelineSettings settings = shipped.pipeline;
  settings.output = kind;
  settings.output_rate = output_rate;
  Pipeline pipeline(shipped.mechanism, settings);
  Published result;
  std::vector<double> times;
  std::vector<CrankEstimate> estimates;
  std::vector<bool> sent;
  for (const auto& reading : session.crank) {
    const SampleResult& r = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    const double time = 1e-9 * static_cast<double>(r.stamp - machine.start_stamp);
    if (r.refusal || time < 4.0 || time > 11.0) continue;
    ++result.samples;
    result.outputs += r.outputs.size();
    result.beside += !r.refusal && !r.isPublished();
    const auto add = [&](StampNs stamp, const CrankEstimate& crank, bool is_sent) {
      if (!isNear(crank)) return;
      times.push_back(1e-9 * static_cast<double>(stamp - machine.start_stamp));
      estimates.push_back(crank);
      sent.push_back(is_sent);
    };
    for (const WrenchOutput& output : r.outputs) add(output.stamp, output.crank, true);
    if (r.beside_blow) add(r.stamp, r.crank, false);
  }
  const auto truth = simulation::truthAt(machine, times);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (isAfter(truth[i].angle) == isAfter(estimates[i])) continue;
    ++(sent[i] ? result.wrong_published : result.wrong_withheld);
  }
  return result;
}

TEST(BesideBlow, NoSampleIsPublishedOnTheWrongSide) {
  std::size_t wrong = 0;
  for (const std::uint64_t seed : {411u, 413u}) {
    const Published p = published(5e-5, OutputKind::kInstantaneous, 0.0, seed);
    EXPECT_EQ(p.wrong_published, 0u) << seed;
    EXPECT_EQ(p.outputs + p.beside, p.samples) << seed;
    EXPECT_LT(static_cast<double>(p.beside), 0.025 * static_cast<double>(p.samples)) << seed;
    wrong += p.wrong_withheld;
  }
  EXPECT_GT(wrong, 0u) << "nothing to withhold in these sessions";
  for (const std::uint64_t seed : {411u, 412u, 413u, 414u})
    EXPECT_EQ(published(1e-3, OutputKind::kInstantaneous, 0.0, seed).wrong_published, 0u) << "jitter of 1 ms " << seed;
}

/// An encoder's edge shows the side relative to the encoder's own zero. If the edge were taken as exact, up to one blow
/// in four would have a sample on the wrong side.
TEST(BesideBlow, AnEdgeShowsTheSideOnlyAsFarAsTheZeroIsKnown) {
  for (const double degrees : {-0.23, -0.06, 0.1, 0.23}) {
    Published all;
    for (const std::uint64_t seed : {421u, 422u, 423u, 425u}) {
      const Published p = published(0.0, OutputKind::kInstantaneous, 0.0, seed, degrees * kTwoPi / 360.0);
      all.samples += p.samples, all.beside += p.beside;
      all.wrong_published += p.wrong_published, all.wrong_withheld += p.wrong_withheld;
    }
    EXPECT_EQ(all.wrong_published, 0u) << degrees;
    EXPECT_GT(all.wrong_withheld, 5u) << degrees;
    EXPECT_LT(static_cast<double>(all.beside), 0.01 * static_cast<double>(all.samples)) << degrees;
  }
}

/// The readings show that the dead centre is not at the zero. One blow in four has a sample between the two.
TEST(BesideBlow, NoSampleIsPublishedOnTheWrongSideOfAZeroThatIsSeenToBeWrong) {
  for (const double degrees : {-0.6, 0.4, 0.6}) {
    const Published p = published(0.0, OutputKind::kInstantaneous, 0.0, 421, degrees * kTwoPi / 360.0);
    EXPECT_EQ(p.wrong_published, 0u) << degrees;
    EXPECT_GT(p.wrong_withheld, 5u) << degrees;
    EXPECT_LT(static_cast<double>(p.beside), 0.03 * static_cast<double>(p.samples)) << degrees;
  }
}

TEST(BesideBlow, OutputsBetweenSamplesAreWithheldAsWell) {
  const Published p = published(5e-5, OutputKind::kInstantaneous, 3000.0, 411);
  EXPECT_EQ(p.wrong_published, 0u);
  const double expected = 3000.0 * static_cast<double>(p.samples) * 1e-3;
  EXPECT_GT(static_cast<double>(p.outputs), 0.99 * expected);
  EXPECT_LT(static_cast<double>(p.outputs), expected);
}

TEST(BesideBlow, MeansGoOn) {
  const Published p = published(5e-5, OutputKind::kMean, 0.0, 411);
  EXPECT_GT(p.beside, 0u);
  EXPECT_EQ(p.outputs, p.samples);
}

/// The readings need some milliseconds to show a blank firing. Until then the force of a blow is published, with a
/// deviation that follows from the frequency of blank firings.
TEST(BesideBlow, ABlowThatMayHaveBeenNoneIsFlagged) {
  const Settings shipped = test::heldHull(*load(configDirectory(), {}).value);
  simulation::MachineSettings machine = test::shippedMachine(shipped, 30.0, 431);
  machine.blow.blank_share = 0.1;
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(shipped.mechanism, shipped.pipeline);
  double square_error = 0.0, square_said = 0.0, contradicted_later = 0.0;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const SampleResult& r =
        pipeline.crankSample(session.crank[i].stamp, {session.crank[i].angle, session.crank[i].speed});
    const double offset = r.crank.position.angle.offset;
    if (!r.isPublished() || session.truth[i].time < 4.0 || offset < 0.0) continue;
    if (offset > 0.5) contradicted_later = std::max(contradicted_later, pipeline.crank().tracker().otherBranch());
    if (offset > 0.1) continue;
    square_error += square(r.wrench.force_x - session.truth[i].load.force_x);
    square_said += square(r.deviation.wrench().force_x);
  }
  EXPECT_GT(square_error, 1e8) << "blank blows";
  EXPECT_GT(square_said, 0.05 * square_error);
  EXPECT_LT(square_said, 2.0 * square_error);
  EXPECT_LT(contradicted_later, 1e-4) << "half a radian after the blow it is known";
}

}  // namespace
}  // namespace hammer_loads
