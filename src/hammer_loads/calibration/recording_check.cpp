#include "hammer_loads/calibration/recording_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/calibration/positive_system.h"
#include "hammer_loads/calibration/sensor_check.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/median.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kContradicts = gate::kVeryRare;
constexpr double kSuspectNoise = 8.0;           // ratio of a sensor's noise to that in the other recordings
constexpr double kSuspectIsOff = gate::kUsual;  // limit if the sensor's noise is suspect
constexpr double kLeastAngle = 0.01;            // [rad]; twice the standard deviation of a zero, less is no fault
constexpr double kLeastReach = 0.05;            // [rad]; the scale of a joint at rest cannot be observed
constexpr double kMostAngle = 0.2;              // [rad]; larger apparent errors are errors of the model
constexpr double kFlawStd = 0.1;                // [rad]; prior standard deviation of a flaw, larger ones exceed limits
constexpr double kFrictionStd = 0.3;  // standard deviation of a recording's friction, relative: oil temperature
constexpr double kAngleStep = 1e-3;   // [rad]; step of differences
// Prior: kFlawStd, kFrictionStd
// Numerical: kAngleStep
constexpr std::size_t kFewestRows = 5;  // per cylinder and recording
// Warning: kSuspectNoise, kLeastAngle, kLeastReach, kMostAngle, kFewestRows

/// Returns the spread of all values but one about their median, as a standard deviation. A faulty recording shifts all
/// others alike.
double spreadWithout(const std::vector<double>& values, std::size_t one) {
  std::vector<double> others(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(one));
  others.insert(others.end(), values.begin() + static_cast<std::ptrdiff_t>(one) + 1, values.end());
  return stdByMedian(others, medianOf(others));
}

/// Consecutive rows of one recording in the linear system of a fit.
struct Part {
  std::size_t first{}, count{};
  BoomSystem system;
};

class Comparison {
 public:
  Comparison(const BoomModel& model, const std::vector<BoomPoints>& recordings, const std::vector<BoomRow>& rows,
             const BoomFit& fit, const std::vector<std::string>& names)
      : model_(model), recordings_(recordings), rows_(rows), fit_(fit), names_(names) {
    const BoomSystem all = systemOf(model, rows, fit);
    parts_.resize(recordings.size());
    for (const BoomRow& row : rows) ++parts_[row.recording].count;
    normal_ = Eigen::MatrixXd::Identity(fit.x.size(), fit.x.size());
    std::size_t first = 0;
    for (Part& part : parts_) {
      part.first = std::exchange(first, first + part.count);
      const auto begin = static_cast<Eigen::Index>(part.first), count = static_cast<Eigen::Index>(part.count);
      part.system = {all.left.segment(begin, count), all.weight.segment(begin, count),
                     all.slopes.middleRows(begin, count)};
      normal_ += part.system.information();
    }
  }

  std::string run() {
    for (std::size_t k = 0; k < model_.given().cylinders().size(); ++k) {
      checkForces(k);
      for (const bool is_scale : {false, true}) checkSensor(k, is_scale);
    }
    return text_;
  }

 private:
  /// Keeps the text of the largest contradiction. size: deviation over its limit.
  void note(double size, const std::string& text) {
    if (size > largest_) largest_ = size, text_ = text + ", leave that recording out";
  }
  const BoomRow& rowOf(const Part& part, Eigen::Index i) const {
    return rows_[part.first + static_cast<std::size_t>(i)];
  }
  const std::string& jointOf(std::size_t cylinder) const {
    return model_.given().cylinders()[cylinder].parameters().joint;
  }

  /// Compares the mean force of each recording with the prediction from the others.
  void checkForces(std::size_t cylinder) {
    const std::vector<double> noise = noiseRatios(recordings_, model_.given().cylinders()[cylinder].joint());
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      const BoomSystem& s = parts_[r].system;
      const Eigen::MatrixXd covariance = inverseOf(normal_ - s.information());
      const Eigen::VectorXd change = -covariance * (s.slopes.transpose() * s.weight.cwiseProduct(s.left));
      const Eigen::VectorXd off = s.left - s.slopes * change;
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(fit_.x.size());
      double sum = 0.0, count = 0.0;
      for (Eigen::Index i = 0; i < off.size(); ++i) {
        if (rowOf(parts_[r], i).cylinder != cylinder) continue;
        sum += off[i], slope += s.slopes.row(i).transpose(), count += 1.0;
      }
      if (count < static_cast<double>(kFewestRows)) continue;
      slope /= count;
      const double rows_std = fit_.noise[cylinder] * std::sqrt(fit_.together[cylinder] / count);
      const double deviation = std::hypot(std::sqrt(slope.dot(covariance * slope)), rows_std);
      const double size = std::abs(sum / count) / deviation;
      const bool suspect = noise[r] > kSuspectNoise;
      const double limit = suspect ? kSuspectIsOff : kContradicts;
      if (size <= limit) continue;
      const std::string what =
          format("%s: the force in %s is off by %.0f +- %.0f N from what the other recordings predict",
                 jointOf(cylinder).c_str(), names_[r].c_str(), sum / count, deviation);
      const std::string why = suspect ? format(", and its sensor has %.0f times their noise: faulty there", noise[r])
                                      : ": its sensor, a pressure or the load on the tip is another there";
      note(size / limit, what + why);
    }
  }

  /// Returns the derivatives of the model's forces by the reading of a joint [N/rad], in the rows of a recording.
  Eigen::VectorXd slopesByAngle(std::size_t recording, int joint) const {
    std::vector<BoomPoint> points;
    std::vector<BoomRow> up, down;
    const Part& part = parts_[recording];
    points.reserve(2 * part.count);
    for (std::size_t i = part.first; i < part.first + part.count; ++i) {
      for (const double step : {kAngleStep, -kAngleStep}) {
        points.push_back(*rows_[i].point);
        points.back().motion.position[joint] += step;
        BoomRow row = rows_[i];
        row.point = &points.back();
        (step > 0.0 ? up : down).push_back(row);
      }
    }
    return (residualsOf(model_, down, fit_.x) - residualsOf(model_, up, fit_.x)) / (2.0 * kAngleStep);
  }

  /// Returns the derivatives of a recording's rows by the unknowns and by its own friction, one for each cylinder.
  Eigen::MatrixXd withFriction(const Part& part) const {
    const std::size_t cylinders = model_.given().cylinders().size();
    const Eigen::Index n = part.system.slopes.cols();
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(part.system.slopes.rows(), n + static_cast<Eigen::Index>(cylinders));
    slopes.leftCols(n) = part.system.slopes;
    for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
      const BoomRow& row = rowOf(part, i);
      const auto value = [&](BoomUnknown kind) { return model_.valueOf(fit_.x, kind, row.cylinder); };
      Boom boom = model_.given();
      model_.move(boom, fit_.x, *row.point);
      const double friction =
          value(BoomUnknown::kFrictionForce) + value(BoomUnknown::kFriction) * std::abs(row.measured);
      slopes(i, n + static_cast<Eigen::Index>(row.cylinder)) =
          std::copysign(kFrictionStd * friction, BoomModel::rodSpeed(boom, row.cylinder, *row.point));
    }
    return slopes;
  }

  struct Size {
    double value{}, deviation{}, reach{};
  };

  /// Estimates the difference of a sensor in one recording from the others as one more unknown of the fit. The
  /// difference is constant or in proportion to the angle.
  Size sizeOf(std::size_t recording, int joint, bool is_scale) const {
    const Part& part = parts_[recording];
    if (part.count == 0) return {};
    const std::vector<BoomPoint>& points = recordings_[recording].points;
    double mean_angle = 0.0, reach = 0.0;
    for (const BoomPoint& p : points) mean_angle += p.motion.position[joint] / static_cast<double>(points.size());
    /// Angle by which a flaw of size one shifts a reading [rad].
    const auto shiftAt = [&](const BoomPoint& p) { return is_scale ? p.motion.position[joint] - mean_angle : 1.0; };
    for (const BoomPoint& p : points) reach = std::max(reach, std::abs(shiftAt(p)));
    Eigen::VectorXd slope = slopesByAngle(recording, joint);
    for (Eigen::Index i = 0; i < slope.size(); ++i) slope[i] *= shiftAt(*rowOf(part, i).point);
    const Eigen::VectorXd weighted = part.system.weight.cwiseProduct(slope);
    const Eigen::MatrixXd slopes = withFriction(part);
    const Eigen::Index n = normal_.rows(), all = slopes.cols();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(all, all);
    normal += slopes.transpose() * part.system.weight.asDiagonal() * slopes;
    normal.topLeftCorner(n, n) = normal_;
    Eigen::VectorXd towards = slopes.transpose() * part.system.weight.cwiseProduct(part.system.left);
    towards.head(n).setZero();  // the fit is at its minimum
    const Eigen::VectorXd by_unknowns = slopes.transpose() * weighted, shared = solved(normal, by_unknowns);
    const double rest = slope.dot(weighted) - by_unknowns.dot(shared);
    const double shown = weighted.dot(part.system.left) - shared.dot(towards);
    if (!(rest > 0.0) || reach < kLeastReach) return {};
    const double information = rest + std::pow(reach / kFlawStd, 2);
    // A reading that is too large by d makes the model's force too large by slope d.
    return {-shown / information, std::sqrt(rest) / information, reach};
  }

  void checkSensor(std::size_t cylinder, bool is_scale) {
    const int joint = model_.given().cylinders()[cylinder].joint();
    std::vector<Size> sizes;
    std::vector<double> values;
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      sizes.push_back(sizeOf(r, joint, is_scale));
      values.push_back(sizes.back().value);
    }
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      const Size& s = sizes[r];
      if (!(s.deviation > 0.0)) continue;
      const double size = std::abs(s.value) / std::hypot(s.deviation, spreadWithout(values, r));
      if (size <= kContradicts || std::abs(s.value) * s.reach < kLeastAngle) continue;
      if (std::abs(s.value) * s.reach > kMostAngle) continue;
      const std::string differs = is_scale ? format("reads angles %.2g %% wider", 100.0 * s.value)
                                           : format("reads %.2g deg more", s.value * 180.0 / kPi);
      note(std::abs(s.value) / s.deviation / kContradicts, jointOf(cylinder) + ": its sensor " + differs + " in " +
                                                               names_[r] +
                                                               " than in the other recordings: faulty there");
    }
  }

  const BoomModel& model_;
  const std::vector<BoomPoints>& recordings_;
  const std::vector<BoomRow>& rows_;
  const BoomFit& fit_;
  const std::vector<std::string>& names_;
  std::vector<Part> parts_;
  Eigen::MatrixXd normal_;
  double largest_{};
  std::string text_;
};

}  // namespace

std::string contradictionOf(const BoomModel& model, const std::vector<BoomPoints>& recordings,
                            const std::vector<BoomRow>& rows, const BoomFit& fit,
                            const std::vector<std::string>& names) {
  return recordings.size() < 3 ? "" : Comparison(model, recordings, rows, fit, names).run();
}

}  // namespace hammer_loads::calibration
