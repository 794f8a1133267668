#include "hammer_loads/calibration/hammer_part.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "hammer_loads/calibration/positive_system.h"
#include "hammer_loads/linkage/machine_columns.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::calibration {
namespace {

// Numerical: kReplicas, kSteps
constexpr int kReplicas = 4;            // replicas of the recording, in pairs whose errors have opposite signs
constexpr double kMostUncertain = 5.0;  // variance over the prior variance
constexpr double kBiasStd = 0.5;        // standard deviation of the remaining bias over the removed bias
// Prior: kBiasStd
constexpr double kMounting = 0.0175;  // standard deviation of each part of an encoder's eccentricity [rad]: 1 deg
// Prior: kMounting

constexpr const char* kNames[kGlobals] = {"zero",
                                          "sine of the eccentricity once per revolution",
                                          "cosine of the eccentricity once per revolution",
                                          "sine of the eccentricity twice per revolution",
                                          "cosine of the eccentricity twice per revolution",
                                          "drive inertia",
                                          "stiffness of the oil",
                                          "drag of the drive"};

/// Information of a blow on shared parameters and constants, with its local parameters eliminated.
struct Information {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd score;
};

Information informationOf(const SegmentFit& fit, const JointFit& joint, const SegmentModel& model,
                          const MachineColumns& columns, const std::vector<SegmentModel>& others) {
  const auto count = static_cast<Eigen::Index>(columns.columns().size()), size = kGlobals + count;
  std::vector<std::vector<ShotPoint>> neighbours;
  for (const SegmentModel& other : others) neighbours.push_back(fit.motion(other, joint.globals));
  const std::vector<ResidualRow> rows = fit.rows(model, joint.globals, joint.noise);
  const NormalEquations own = fit.equationsOf(rows, joint.noise);
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(kLocals, size);
  Information all{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  Eigen::VectorXd by(size);
  for (const ResidualRow& row : rows) {
    by.head<kGlobals>() = row.by_global;
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto column = static_cast<std::size_t>(k);
      const ShotPoint& there = neighbours[column][row.point];
      by[kGlobals + k] =
          (row.by_offset * (there.offset - row.at.offset) + row.by_speed * (there.speed - row.at.speed)) /
          columns.columns()[column].step;
    }
    const double weight = weightOf(row);
    cross.noalias() += weight * row.by_local * by.transpose();
    all.matrix.selfadjointView<Eigen::Lower>().rankUpdate(by, weight);
    all.score += weight * row.residual * by;
  }
  all.matrix = Eigen::MatrixXd(all.matrix.selfadjointView<Eigen::Lower>());
  const Eigen::MatrixXd by_locals = cross.transpose() * inverseOf(own.ll);
  all.matrix -= by_locals * cross;
  all.score -= by_locals * own.l;
  return all;
}

}  // namespace

bool HammerPart::has(const std::string& constant) const {
  return std::find(names.begin(), names.end(), constant) != names.end();
}

std::string HammerPart::nameOf(Eigen::Index row) const {
  return row < kGlobals ? std::string(kNames[row]) : names[static_cast<std::size_t>(row - kGlobals)];
}

HammerPart findWithHammer(JointFit joint, const SegmentModel& model) {
  constexpr int kSteps = 2;
  HammerPart part;
  part.globals = joint.globals, part.covariance = joint.plain_covariance;
  Eigen::VectorXd prior = priorDeviations().cwiseAbs2().cwiseInverse();
  const auto columns = machineColumns(model.mechanism, model.level);
  if (!columns) return part;
  for (const MachineColumn& column : columns->columns()) part.names.push_back(column.name);
  const auto count = static_cast<Eigen::Index>(part.names.size()), size = kGlobals + count;
  part.errors = Eigen::VectorXd::Zero(count);
  Globals centre = joint.globals;  // centre of the priors: 0 for eccentricities; the others are wide
  centre.segment<4>(kSine1).setZero();
  prior.conservativeResize(size);
  prior.tail(count).setOnes();
  std::optional<Mechanism> hammer = model.mechanism;
  for (int i = 0; i < kSteps && hammer; ++i) {
    const SegmentModel here{*hammer, model.level};
    const MachineColumns neighbours(*hammer, model.level);
    if (neighbours.columns().size() != part.names.size()) break;  // the constants are at the limit of a possible hammer
    std::vector<SegmentModel> others;
    for (const MachineColumn& column : neighbours.columns()) others.emplace_back(column.mechanism, column.level);
    Information all{prior.asDiagonal(), Eigen::VectorXd(size)};
    all.score << prior.head<kGlobals>().cwiseProduct(centre - joint.globals), -part.errors;
    for (SegmentFit& fit : joint.fits) {
      if (i > 0) fitLocals(fit, here, joint.globals, joint.noise);
      const Information one = informationOf(fit, joint, here, neighbours, others);
      all.matrix += one.matrix, all.score += one.score;
    }
    if (joint.centred) holdEccentricity(all.matrix, all.score);
    part.covariance = inverseOf(all.matrix);
    if (joint.centred) clearEccentricity(part.covariance);
    const Eigen::VectorXd change = part.covariance * all.score;
    if (!change.allFinite()) break;
    joint.globals += change.head<kGlobals>();
    part.errors += change.tail(count);
    hammer = columns->hammerOff(part.errors);
  }
  part.globals = joint.globals;
  return part;
}

void HammerPart::widen(const JointFit& fit) {
  for (Eigen::Index k = 0; k < kGlobals; ++k) {
    const double excess = fit.covariance(k, k) - fit.plain_covariance(k, k);
    if (!(excess > 0.0 && covariance(k, k) > 0.0)) continue;
    const double by = std::sqrt(1.0 + excess / covariance(k, k));
    covariance.row(k) *= by, covariance.col(k) *= by;
  }
}

/// The prior is applied after the removal of bias, which would undo it within the fits.
void HammerPart::weighByMounting() {
  const Eigen::Index count = errors.size();
  for (Eigen::Index k = kSine1; k <= kCosine2; ++k) {
    if (!(covariance(k, k) > 0.0)) continue;
    const Eigen::VectorXd gain = covariance.col(k) / (covariance(k, k) + square(kMounting));
    const double off = -globals[k];
    globals += gain.head<kGlobals>() * off;
    errors += gain.tail(count) * off;
    covariance -= gain * covariance.row(k).eval();
  }
}

bool HammerPart::isCertain() const {
  return (covariance.diagonal().head<kGlobals>().array() <= kMostUncertain * priorDeviations().cwiseAbs2().array())
      .all();
}

void removeBias(JointFit& joint, HammerPart& hammer, const SegmentModel& model, double count,
                const Progress& progress) {
  if (joint.fits.empty()) return;
  const Eigen::Index size = hammer.covariance.rows();
  Globals bias = Globals::Zero();
  Eigen::VectorXd of_hammer = Eigen::VectorXd::Zero(size);
  for (int i = 0; i < kReplicas; ++i) {
    std::vector<BlowSegment> segments;
    std::mt19937_64 random(1 + static_cast<std::uint64_t>(i / 2));
    for (const SegmentFit& fit : joint.fits)
      segments.push_back(fit.replica(model, joint.globals, joint.noise, count, i % 2 == 0 ? 1.0 : -1.0, random));
    JointFit replica = joint;
    for (std::size_t k = 0; k < segments.size(); ++k) replica.fits[k] = joint.fits[k].onto(segments[k]);
    settleNear(replica, model, piece(progress, static_cast<double>(i) / kReplicas, (i + 1.0) / kReplicas));
    bias += (replica.globals - joint.globals) / kReplicas;
    const HammerPart found = findWithHammer(replica, model);
    of_hammer.head<kGlobals>() += (found.globals - joint.globals) / kReplicas;
    of_hammer.tail(size - kGlobals) += found.errors / kReplicas;
  }
  joint.globals -= bias;
  joint.covariance += kBiasStd * kBiasStd * bias * bias.transpose();
  hammer.globals -= of_hammer.head<kGlobals>();
  hammer.errors -= of_hammer.tail(size - kGlobals);
  hammer.covariance += kBiasStd * kBiasStd * of_hammer * of_hammer.transpose();
  for (SegmentFit& fit : joint.fits) fitLocals(fit, model, joint.globals, joint.noise);
}

}  // namespace hammer_loads::calibration
