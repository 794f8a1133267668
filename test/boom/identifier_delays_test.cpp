// Delay of an IMU's stamps, and the part of it by which the measured crank angle leads the crank, for the machine of
// mode_identifier_test.cpp.

#include <gtest/gtest.h>

#include "boom/identifier_session.h"

namespace hammer_loads {
namespace {

using test::IdentifierSession;
using test::kMillisecond;
using test::Sensor;

/// A wrong bulk modulus is not mistaken for a delay, nor a delay for a wrong bulk modulus.
TEST(ModeIdentifier, FindsByWhatStampsAreLate) {
  for (double given_over_true : {0.7, 1.4}) {
    for (std::size_t late : {0U, 1U, 3U}) {
      IdentifierSession run(given_over_true, Sensor::kImu);
      run.late_ = late;
      run.run(12.0);
      const ModeIdentifier& found = run.identifier();
      const double delay = kMillisecond * static_cast<double>(late);
      EXPECT_NEAR(found.delay(Clock::kImu), delay, 0.1 * kMillisecond + 0.1 * delay) << late;
      EXPECT_LT(found.delayDeviation(Clock::kImu), 0.1 * kMillisecond + 0.2 * delay) << late;
      for (int k = 0; k < 2; ++k) EXPECT_LT(std::abs(run.frequencyError(k)), 0.01) << late << k;
      EXPECT_LT(run.torqueError(4.0), 0.05) << late;
    }
  }
}

/// The crank's lead is only the part of a delay that is expected of the crank. It is zero without a delay.
TEST(ModeIdentifier, TakesFromADelayWhatTheCrankLeads) {
  struct Case {
    std::size_t late;
    CrankLead expected;  ///< [ms]
    double lead;         ///< [ms]
  };
  for (const Case& c : {Case{1, {1.0, 0.3}, 1.0}, Case{1, {0.9, 0.3}, 1.0}, Case{1, {0.0, 0.3}, 0.03},
                        Case{3, {1.0, 0.3}, 1.0}, Case{0, {1.0, 0.3}, 0.0}, Case{1, {-1.0, 0.3}, 0.0}}) {
    IdentifierSession run(1.0, Sensor::kImu);
    run.late_ = c.late;
    run.boom_->vibration().expectCrankLead({kMillisecond * c.expected.mean, kMillisecond * c.expected.deviation});
    run.run(8.0);
    const ModeIdentifier& found = run.identifier();
    const double late = kMillisecond * static_cast<double>(c.late), lead = kMillisecond * c.lead;
    EXPECT_NEAR(found.crankLead(), lead, 0.15 * kMillisecond) << c.late << " " << c.expected.mean;
    EXPECT_NEAR(found.crankLead() + found.delay(Clock::kImu), late, 0.1 * kMillisecond + 0.1 * late);
    run.lead_ = static_cast<std::size_t>(std::lround(c.lead));
    EXPECT_LT(run.torqueError(4.0), 0.02) << c.late << " " << c.expected.mean << ": in the crank's time it is 0.033";
  }
}

}  // namespace
}  // namespace hammer_loads
