/// Findings of a calibration, as its report states them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {

/// One key of the file that the other commands read.
struct Estimate {
  std::string key, unit;
  double value{}, deviation{};
  double limit{};  ///< deviation that costs some 0.8 % of the wrench's peak, or of the key's own quantity
  std::string meaning;
  double by_blows{};  ///< part of the deviation that more blows would reduce; the rest comes from the given parameters
  std::string hidden_by{};  ///< constant of the hammer file, or level, that causes most of the deviation; empty: the
                            ///< number of blows does
  bool determined() const { return deviation <= limit; }
};

/// Two parameters that the recording can hardly separate.
struct Correlation {
  std::string first, second;
  double value{};
};

struct Findings {
  std::string problem;  ///< reason why there is no result
  std::vector<Estimate> estimates;
  std::vector<Correlation> correlations;  ///< beyond kStrongCorrelation
  std::vector<std::string> remarks;
};

constexpr double kStrongCorrelation = 0.9;
// Warning: kStrongCorrelation

/// Adds the strong correlations of unknowns with these names.
inline void addCorrelations(const Eigen::MatrixXd& covariance, const std::vector<std::string>& names,
                            Findings& findings) {
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double r = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
      if (std::abs(r) > kStrongCorrelation)
        findings.correlations.push_back({names[static_cast<std::size_t>(j)], names[static_cast<std::size_t>(i)], r});
    }
  }
}

/// Returns the lines of the report on parameters that cannot be separated, and the remarks.
inline std::string notesOf(const Findings& findings) {
  std::string text;
  for (const Correlation& r : findings.correlations)
    text += format("cannot be separated (correlation %+.2f): %s and %s\n", r.value, r.first.c_str(), r.second.c_str());
  for (const std::string& remark : findings.remarks) text += "note: " + remark + "\n";
  return text;
}

}  // namespace hammer_loads::calibration
