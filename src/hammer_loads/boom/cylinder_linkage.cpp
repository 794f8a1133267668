// Bucket linkage of a cylinder: made from the chain and the boom file, and checked over the joint's range.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr double kInPlane = 1e-6;  // [-], [m]: pins and joint count as in one plane
constexpr int kRangeSteps = 1000;  // over the joint's range
// Numerical: kInPlane, kRangeSteps

Eigen::Vector2d inPlane(const Eigen::Vector3d& v) { return {v.x(), v.z()}; }

/// Returns true if the joint turns both links about their common y and lies in the plane of the pins.
bool isPlanar(const ChainLink& link) {
  const Eigen::Matrix3d at_zero = link.steady + link.cosine;
  return std::abs(std::abs(link.axis.y()) - 1.0) < kInPlane && std::abs(at_zero(1, 1) - 1.0) < kInPlane &&
         std::abs(link.origin.y()) < kInPlane;
}

}  // namespace

/// The branch that the file gives; else the one whose length fits the stroke.
void Cylinder::findLinkage(const Chain& chain, std::vector<std::string>& problems) {
  const ChainLink& link = chain.link(chain.linkBeyond(joint_));
  const char* name = parameters_.name.c_str();
  if (!isPlanar(link)) {
    problems.push_back(format("%s_linkage: bucket, %s must turn about y, with its origin at y = 0 of the link before",
                              name, parameters_.joint.c_str()));
    return;
  }
  BucketLinkageParameters& given = *parameters_.linkage;
  const Eigen::Vector2d origin = inPlane(link.origin);
  const Eigen::Vector3d driven(parameters_.rod_x, 0.0, parameters_.rod_z);
  const BucketLinkage::Pins pins{Eigen::Vector2d(parameters_.base_x, parameters_.base_z) - origin,
                                 Eigen::Vector2d(given.guide_x, given.guide_z) - origin,
                                 inPlane((link.steady + link.cosine) * driven), link.axis.y() > 0.0 ? 1.0 : -1.0};
  shorter_side_ = std::min(pins.driven.norm(), given.guide_length);
  if (!(shorter_side_ > 0.0)) return;
  const auto miss = [&](double branch) {
    given.branch = branch;
    linkage_.emplace(pins, given);
    return worstReach(chain).miss;
  };
  if (given.branch == 0.0) {
    const double one = miss(1.0), other = miss(-1.0);
    if (one == 0.0 && other == 0.0)
      problems.push_back(
          format("%s_linkage_branch: not given, must be 1 or -1: closed length and stroke fit both", name));
    given.branch = one < other ? 1.0 : -1.0;
  }
  linkage_.emplace(pins, given);
  checkClosure(chain, problems);
}

void Cylinder::checkClosure(const Chain& chain, std::vector<std::string>& problems) const {
  const double lower = chain.lower()[joint_], upper = chain.upper()[joint_];
  double worst = 0.0, worst_angle = 0.0, worst_reach = 0.0;
  for (int i = 0; i <= kRangeSteps; ++i) {
    const double angle = lower + (upper - lower) * i / kRangeSteps;
    const double reach = linkage_->reach(linkage_->at(std::cos(angle), std::sin(angle)));
    const double miss = std::max(linkage_->leastReach() - reach, reach - linkage_->mostReach());
    if (miss > worst) worst = miss, worst_angle = angle, worst_reach = reach;
  }
  if (!(worst > 0.0)) return;
  problems.push_back(
      format("%s_coupler_length_m: %.9g m, cannot close the linkage: at %s = %.6g rad guide pivot and driven pin are "
             "%.6g m apart, must be from %.6g to %.6g m",
             parameters_.name.c_str(), parameters_.linkage->coupler_length, parameters_.joint.c_str(), worst_angle,
             worst_reach, linkage_->leastReach(), linkage_->mostReach()));
}

}  // namespace hammer_loads
