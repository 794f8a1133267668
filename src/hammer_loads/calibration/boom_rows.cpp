#include <cmath>
#include <optional>

#include "hammer_loads/calibration/boom_fit.h"
#include "hammer_loads/estimation/gates.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kLeastRodSpeed = 0.01;  // [m/s]; below it, seals stick and slip with more friction (Stribeck)
constexpr double kStep = 0.05;           // step of differences [prior standard deviations]
// Numerical: kStep

/// Returns true if the rod moves in one direction throughout the readings of the point.
bool surelyMoves(const Boom& boom, std::size_t cylinder, const BoomPoint& point) {
  const int joint = boom.cylinders()[cylinder].joint();
  const double arm = std::abs(boom.cylinderPosition(cylinder).arm);
  const double rate = std::abs(point.motion.velocity[joint]);
  const double least = rate - point.half_width * std::abs(point.motion.acceleration[joint]);
  return arm * least > kLeastRodSpeed && rate > gate::kRare * point.rate_std[joint];
}

/// Returns true for an unknown of a link, on which the forces of all cylinders depend.
bool isOfLinks(const Unknown& unknown) { return kindOf(unknown.kind).of_link != nullptr; }

/// Returns false if the unknown belongs to another cylinder or recording and does not affect the force of the row.
bool concerns(const Unknown& unknown, const BoomRow& row) {
  if (unknown.kind == BoomUnknown::kTipWeight) return unknown.of == row.recording;
  if (unknown.kind == BoomUnknown::kRecording && unknown.recording != row.recording) return false;
  return isOfLinks(unknown) || unknown.kind == BoomUnknown::kZero || unknown.of == row.cylinder;
}

/// Booms of the recordings at x. Making a boom takes as long as evaluating a hundred rows. Recordings with the same
/// weight therefore share one. Steps of unknowns on which no boom depends use the booms at x.
class BoomsAt {
 public:
  BoomsAt(const BoomModel& model, const Eigen::VectorXd& x, std::size_t recordings) : booms_(recordings) {
    for (std::size_t r = 0; r < recordings; ++r) {
      of_.push_back(model.firstWithWeightOf(r));
      if (of_[r] == r) booms_[r] = model.boomAt(x, r);
    }
  }
  std::optional<Boom>& operator[](std::size_t recording) { return booms_[of_[recording]]; }

 private:
  std::vector<std::size_t> of_;
  std::vector<std::optional<Boom>> booms_;
};

std::size_t recordingsOf(const std::vector<BoomRow>& rows) { return rows.empty() ? 0 : rows.back().recording + 1; }

Eigen::VectorXd residualsWith(BoomsAt& booms, const BoomModel& model, const std::vector<BoomRow>& rows,
                              const Eigen::VectorXd& x) {
  Eigen::VectorXd left(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BoomRow& row = rows[i];
    std::optional<Boom>& boom = booms[row.recording];
    if (!boom) return left.setConstant(kNaN);
    model.move(*boom, x, *row.point);
    left[static_cast<Eigen::Index>(i)] =
        row.measured - model.shownForce(*boom, x, row.cylinder, row.recording, *row.point);
  }
  return left;
}

}  // namespace

std::vector<BoomRow> rowsOf(const BoomModel& model, const std::vector<BoomPoints>& recordings) {
  std::vector<BoomRow> rows;
  Boom boom = model.given();
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (std::size_t k = 0; k < boom.cylinders().size(); ++k) {
      for (const BoomPoint& point : recordings[r].points) {
        model.move(boom, model.zero(), point);
        if (boom.cylinderPosition(k).zero_moment_arm || !surelyMoves(boom, k, point)) continue;
        rows.push_back({r, k, &point, model.measuredForce(k, point)});
      }
    }
  }
  return rows;
}

Eigen::VectorXd residualsOf(const BoomModel& model, const std::vector<BoomRow>& rows, const Eigen::VectorXd& x) {
  BoomsAt booms(model, x, recordingsOf(rows));
  return residualsWith(booms, model, rows, x);
}

Eigen::MatrixXd slopesOf(const BoomModel& model, const std::vector<BoomRow>& rows, const Eigen::VectorXd& x) {
  BoomsAt booms(model, x, recordingsOf(rows));
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Unknown& unknown = model.unknowns()[static_cast<std::size_t>(i)];
    std::vector<BoomRow> some;
    std::vector<Eigen::Index> at;
    for (std::size_t r = 0; r < rows.size(); ++r)
      if (concerns(unknown, rows[r])) some.push_back(rows[r]), at.push_back(static_cast<Eigen::Index>(r));
    Eigen::VectorXd up = x, down = x;
    up[i] += kStep, down[i] -= kStep;
    const bool changes_boom = isOfLinks(unknown) || unknown.kind == BoomUnknown::kTipWeight;
    const auto residuals = [&](const Eigen::VectorXd& stepped) {
      return changes_boom ? residualsOf(model, some, stepped) : residualsWith(booms, model, some, stepped);
    };
    const Eigen::VectorXd slope = (residuals(down) - residuals(up)) / (2.0 * kStep);
    for (std::size_t r = 0; r < at.size(); ++r) J(at[r], i) = slope[static_cast<Eigen::Index>(r)];
  }
  return J;
}

}  // namespace hammer_loads::calibration
