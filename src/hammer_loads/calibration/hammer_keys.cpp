#include "hammer_loads/calibration/hammer_keys.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kHides = 3.0;   // times the deviation without the hammer's constants: worth a word
constexpr double kSeen = 0.7;    // part of a constant's deviation that is left, below which it is written
constexpr double kUnsaid = 1.2;  // ratio of a variance to that by separate deviations: two of them cover 93 % then

/// A constant that a hammer file should have from here: one number and its deviation, with the other constants as the
/// file has them.
struct Improved {
  std::size_t column;       ///< index in HammerPart::names
  std::size_t constant;     ///< index in kHammerConstants
  double error, deviation;  ///< [its standard deviations in the file]
};

/// Constants that the recording improves. One whose error is correlated with that of an unimproved constant is left
/// out, as a file cannot state correlations.
std::vector<Improved> improved(const HammerPart& hammer) {
  const auto count = static_cast<Eigen::Index>(hammer.names.size());
  const Eigen::MatrixXd P = hammer.covariance.bottomRightCorner(count, count);
  std::vector<Improved> found;
  for (std::size_t i = 0; i < hammer.names.size(); ++i) {
    const std::optional<std::size_t> constant = indexOfConstant(hammer.names[i]);
    if (constant && hammer.left(i) < kSeen)
      found.push_back({i, *constant, hammer.errors[static_cast<Eigen::Index>(i)], hammer.left(i)});
  }
  // The others keep errors of their prior's variance, 1, that go with these errors as P has it. Deviations d say
  // 1/kUnsaid of the variance of any sum of errors, or more, where kUnsaid diag(d^2) - M has no negative eigenvalue;
  // sums of M's rows see to that.
  while (!found.empty()) {
    const auto size = static_cast<Eigen::Index>(found.size());
    Eigen::MatrixXd rows(size, count), own(size, size);
    for (Eigen::Index k = 0; k < size; ++k) rows.row(k) = P.row(static_cast<Eigen::Index>(found[k].column));
    for (Eigen::Index k = 0; k < size; ++k) own.col(k) = rows.col(static_cast<Eigen::Index>(found[k].column));
    const Eigen::MatrixXd M = own + (rows * rows.transpose() - own * own.transpose()) / (kUnsaid - 1.0);
    for (Eigen::Index k = 0; k < size; ++k)
      found[k].deviation = std::sqrt(std::max(own(k, k), M.row(k).cwiseAbs().sum() / kUnsaid));
    const auto worst = std::max_element(found.begin(), found.end(),
                                        [](const Improved& a, const Improved& b) { return a.deviation < b.deviation; });
    if (worst->deviation <= kSeen) break;
    found.erase(worst);
  }
  return found;
}

}  // namespace

std::vector<Estimate> estimatesOf(const HammerPart& hammer, const HammerParameters& file) {
  std::vector<Estimate> estimates;
  HammerParameters found = file;
  bool closes = false;
  for (const Improved& one : improved(hammer)) {
    const HammerConstant& c = kHammerConstants[one.constant];
    const double sigma = file.deviations[one.constant], unit = std::string(c.unit) == "deg" ? kDegree : 1.0;
    c.field(found) += c.away * sigma * one.error;
    closes = closes || c.enters == HammerConstant::Enters::kMotion;
    const double deviation = one.deviation * sigma / unit;
    estimates.push_back(
        {c.key, c.unit, c.field(found) / unit, deviation, sigma / unit,
         "of the hammer, its others as given; this recording is in it: not for a second calibration from it", 0.0});
    estimates.push_back({deviationKey(c), c.unit, deviation, 0.0, deviation, "standard deviation of that", 0.0});
  }
  const LinkLengths& l = found.lengths;
  if (closes)
    estimates.push_back({"rod_length_m", "m", l.pivot_distance + l.rocker - l.crank, 0.0, l.rod,
                         "it follows: with it the linkage passes its dead centre at the blow", 0.0});
  return estimates;
}

std::string hiddenBy(const HammerPart& hammer, const GlobalMatrix& by_blows, Eigen::Index parameter) {
  const auto count = static_cast<Eigen::Index>(hammer.names.size());
  const Eigen::MatrixXd& P = hammer.covariance;
  if (count == 0 || !(P(parameter, parameter) > square(kHides) * by_blows(parameter, parameter))) return {};
  Eigen::Index most = 0;
  P.row(parameter)
      .tail(count)
      .transpose()
      .cwiseQuotient(P.diagonal().tail(count).cwiseSqrt())
      .cwiseAbs()
      .maxCoeff(&most);
  return hammer.nameOf(kGlobals + most);
}

std::vector<std::string> remarksOf(const HammerPart& hammer, const GlobalMatrix& by_blows,
                                   const HammerParameters& file) {
  std::vector<std::string> remarks;
  const auto count = static_cast<Eigen::Index>(hammer.names.size());
  const Eigen::MatrixXd& P = hammer.covariance;
  for (const Eigen::Index k : {kZero, kSine1, kCosine1, kLogInertia}) {
    const std::string by = hiddenBy(hammer, by_blows, k);
    if (by.empty()) continue;
    remarks.push_back(
        format("%s: known to %.2g if the hammer file were exact, to %.2g by the deviations of its constants, most by "
               "that of %s",
               hammer.nameOf(k).c_str(), std::sqrt(by_blows(k, k)), std::sqrt(P(k, k)), by.c_str()));
  }
  const std::vector<Improved> written = improved(hammer);
  for (std::size_t i = 0; i < hammer.names.size(); ++i) {
    const std::optional<std::size_t> k = indexOfConstant(hammer.names[i]);
    const auto is = [&](const Improved& one) { return one.column == i; };
    if (!k || hammer.left(i) > kSeen || std::any_of(written.begin(), written.end(), is)) continue;
    const double deviation = file.deviations[*k];
    Eigen::VectorXd with = P.bottomRightCorner(count, count).col(static_cast<Eigen::Index>(i));
    with.array() /= P.diagonal().tail(count).cwiseSqrt().array() * hammer.left(i);
    with[static_cast<Eigen::Index>(i)] = 0.0;
    Eigen::Index most = 0;
    with.cwiseAbs().maxCoeff(&most);
    remarks.push_back(format(
        "%s: by the readings %+.2g +- %.1g more than the file has, whose deviation is %.2g; not written, %s explains "
        "the same readings (correlation %.2f): a smaller deviation of that in the hammer file shows this one",
        hammer.names[i].c_str(), kHammerConstants[*k].away * deviation * hammer.errors[static_cast<Eigen::Index>(i)],
        deviation * hammer.left(i), deviation, hammer.nameOf(kGlobals + most).c_str(), std::abs(with[most])));
  }
  return remarks;
}

}  // namespace hammer_loads::calibration
