// What the crank's filter takes for the tool and for a blow that was passed.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "support/constants.h"
#include "support/filter_settings.h"
#include "support/mo100.h"
#include "support/striking_crank.h"

namespace hammer_loads {
namespace {

class FilterAtBlow : public testing::Test {
 protected:
  CrankFilter filterOf(const CrankFilterSettings& settings) const {
    return CrankFilter(ShaftModel(mechanism_, Level::kRocker), 0.6, settings);
  }
  Mechanism mechanism_{test::mechanismOf(test::mo100Parameters())};
};

/// What a tool takes that is met before the dead centre is not known when the first reading shows it: up to nine tenths
/// of the speed are within two deviations, and these are no wider than that.
TEST_F(FilterAtBlow, AToolMayTakeMostOfTheSpeed) {
  double worst = 0.0;
  for (const double taken : {0.1, 0.3, 0.6, 0.9}) {
    test::StrikingCrank crank(mechanism_.linkage(), 0.737, 0.6);
    crank.blow = [&](int number) {
      const bool early = number == 6;
      return test::StrikingCrank::Blow{early ? 1.0 - taken : 0.9, true, early ? 0.03 : 0.0};
    };
    CrankFilter f = filterOf(test::filterSettings(kTwoPi / 65536.0));
    f.start({crank.angle(), std::nullopt});
    for (int i = 1; i < 4000 && !(crank.blows() == 7 && f.belief().tool_met); ++i) {
      crank.advanceTo(1e-3 * i);
      f.update(1e-3, {crank.angle(), std::nullopt});
    }
    ASSERT_TRUE(f.belief().tool_met);
    const double deviation = std::sqrt(f.covariance()(CrankBelief::kFactor, CrankBelief::kFactor));
    worst = std::max(worst, std::abs(f.belief().factor - (1.0 - taken)) / deviation);
  }
  EXPECT_LT(worst, 2.0);
  EXPECT_GT(worst, 1.0);
}

/// Just before a sample it shows little there, just after one at once: without speeds, by readings in counts.
TEST_F(FilterAtBlow, KnowsTheSpeedThatAToolTookWhereverItIsMet) {
  double sum = 0.0, worst = 0.0;
  constexpr int kPlaces = 40;
  for (int place = 0; place < kPlaces; ++place) {
    test::StrikingCrank crank(mechanism_.linkage(), 0.737, 0.6);
    crank.blow = [&](int number) {
      const bool early = number == 6;
      return test::StrikingCrank::Blow{early ? 0.3 : 0.9, true, early ? 0.03 + 0.0005 * place : 0.0};
    };
    CrankFilter f = filterOf(test::filterSettings(kTwoPi / 4096.0));
    const auto read = [&] { return kTwoPi / 4096.0 * (std::floor(crank.angle() / (kTwoPi / 4096.0)) + 0.5); };
    f.start({read(), std::nullopt});
    int met = 0;
    for (int i = 1; i < 4000 && met < 6; ++i) {
      crank.advanceTo(1e-3 * i);
      f.update(1e-3, {read(), std::nullopt});
      met += crank.blows() == 7 && f.belief().struck_early;
    }
    const double error = f.belief().factor - 0.3;
    sum += error, worst = std::max(worst, std::abs(error));
  }
  EXPECT_LT(std::abs(sum / kPlaces), 0.005);
  EXPECT_LT(worst, 0.03);
}

}  // namespace
}  // namespace hammer_loads
