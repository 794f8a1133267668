/// Lengths of a bucket linkage from a table of its cylinder's stroke and its joint's angle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/bucket_linkage.h"
#include "hammer_loads/calibration/findings.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads::calibration {

/// Strokes and angles of one joint, in any order.
struct StrokeTable {
  std::vector<double> stroke;  ///< travel of the rod from its closed end [m]
  std::vector<double> angle;   ///< angle of the joint [rad]
};

/// Reads CSV with the columns stroke_m and angle_rad. problem: one line that names the line of the file, its value and
/// the rule.
std::optional<StrokeTable> readStrokeTable(const std::string& csv, std::string& problem);

/// Unknowns of the fit, in the order of its vectors: pins from the joint's axis, links, closed length; all [m].
struct LinkageUnknowns {
  enum Index { kBaseX, kBaseZ, kGuideX, kGuideZ, kGuide, kCoupler, kRodX, kRodZ, kClosed, kCount };
  using Vector = Eigen::Matrix<double, kCount, 1>;
  /// Suffixes to the cylinder's name that make the keys of the boom file.
  static constexpr std::array<const char*, kCount> kKeys{"base_x_m",
                                                         "base_z_m",
                                                         "rocker_link_base_x_m",
                                                         "rocker_link_base_z_m",
                                                         "rocker_link_length_m",
                                                         "coupler_length_m",
                                                         "rod_x_m",
                                                         "rod_z_m",
                                                         "closed_length_m"};
};

/// Prior knowledge of the linkage. sense: 1 where the joint turns about +y, -1 about -y.
struct LinkageBasis {
  /// Values measured with a tape [m]; empty: not measured.
  std::array<std::optional<double>, LinkageUnknowns::kCount> measured;
  // Prior: tape_std
  double tape_std{0.01};  ///< standard deviation of each of them [m]
  double sense{1.0};
};

struct LinkageFit : Findings {
  LinkageUnknowns::Vector value;  ///< [m]
  double branch{};                ///< BucketLinkageParameters::branch
  std::size_t rows{};
  double left{}, worst{};   ///< rms and largest of the strokes' residuals [m]
  double arm{}, arm_std{};  ///< rms of the lever arm over the table; rms of its standard deviation [m/rad]

  BucketLinkage linkage(double sense) const;
  /// Returns true if the lever arm is known to 1 % of its rms.
  bool determined() const { return problem.empty() && arm_std <= 0.01 * arm; }
};

/// Fits the linkage by least squares from many random starts. cylinder: prefix of the keys.
LinkageFit fitLinkage(const StrokeTable& table, const LinkageBasis& basis, const std::string& cylinder,
                      const Progress& progress = {});

}  // namespace hammer_loads::calibration
