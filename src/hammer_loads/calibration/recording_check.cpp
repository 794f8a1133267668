#include "hammer_loads/calibration/recording_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hammer_loads/calibration/positive_system.h"
#include "hammer_loads/calibration/sensor_check.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/median.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kContradicts = 4.0;   // standard deviations
constexpr double kSuspectNoise = 8.0;  // ratio of a sensor's noise to that in the other recordings
constexpr double kSuspectIsOff = 2.0;  // standard deviations, where the sensor's noise is suspect
constexpr double kLeastAngle = 0.01;   // [rad]: twice the deviation of a zero; less is no fault
constexpr double kLeastReach = 0.05;   // [rad]: the scale of a joint that rests does not show
constexpr double kMostAngle = 0.2;     // [rad]: what seems larger is the model's own error
constexpr double kFlawStd = 0.1;       // [rad]: standard, of a flaw before the recording; a larger one meets limits
constexpr double kFrictionStd = 0.3;  // standard, of a recording's friction, relative to that of all: warmth of the oil
constexpr double kAngleStep = 1e-3;   // [rad]: step of differences
// Prior: kFlawStd, kFrictionStd
// Numerical: kAngleStep
constexpr std::size_t kFewestRows = 5;  // of a cylinder in a recording

/// Ways in which the sensor of a joint differs in one recording from itself in the others.
enum class Flaw { kConstant, kScale };
constexpr std::array<std::pair<Flaw, const char*>, 2> kFlaws{
    {{Flaw::kConstant, "reads %.2g deg more"}, {Flaw::kScale, "reads angles %.2g %% wider"}}};

/// Spread of all values but one about their median, as a standard deviation: a faulty recording shifts all others
/// alike.
double spreadWithout(const std::vector<double>& values, std::size_t one) {
  std::vector<double> others(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(one));
  others.insert(others.end(), values.begin() + static_cast<std::ptrdiff_t>(one) + 1, values.end());
  return stdByMedian(others, medianOf(others));
}

/// Rows of one recording in the linear system of a fit.
struct Part {
  std::vector<std::size_t> rows;
  Eigen::MatrixXd slopes;  ///< change of the model's forces by the unknowns [N]
  Eigen::VectorXd left;    ///< [N]
  Eigen::VectorXd weight;  ///< [1/N2]
  std::size_t count() const { return rows.size(); }
  Eigen::MatrixXd normal() const { return slopes.transpose() * weight.asDiagonal() * slopes; }
};

double meanAngle(const BoomPoints& recording, int joint) {
  double sum = 0.0;
  for (const BoomPoint& p : recording.points) sum += p.motion.position[joint];
  return sum / static_cast<double>(recording.points.size());
}

/// Angle by which a flaw of size one shifts a reading [rad].
double shapeOf(Flaw flaw, const BoomPoint& point, int joint, double mean_angle) {
  return flaw == Flaw::kConstant ? 1.0 : point.motion.position[joint] - mean_angle;
}

/// Largest of them in a recording [rad].
double reachOf(Flaw flaw, const BoomPoints& recording, int joint, double mean_angle) {
  double most = 0.0;
  for (const BoomPoint& p : recording.points) most = std::max(most, std::abs(shapeOf(flaw, p, joint, mean_angle)));
  return most;
}

class Comparison {
 public:
  Comparison(const BoomModel& model, const std::vector<BoomPoints>& recordings, const std::vector<BoomRow>& rows,
             const BoomFit& fit, const std::vector<std::string>& names)
      : model_(model), recordings_(recordings), rows_(rows), fit_(fit), names_(names) {
    const Eigen::MatrixXd slopes = slopesOf(model, rows, fit.x);
    const Eigen::VectorXd left = residualsOf(model, rows, fit.x), weight = weightsOf(fit, rows, left);
    parts_.resize(recordings.size());
    for (std::size_t i = 0; i < rows.size(); ++i) parts_[rows[i].recording].rows.push_back(i);
    const Eigen::Index n = fit.x.size();
    normal_ = Eigen::MatrixXd::Identity(n, n);
    for (Part& part : parts_) {
      const auto count = static_cast<Eigen::Index>(part.count());
      part.slopes.resize(count, n), part.left.resize(count), part.weight.resize(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto row = static_cast<Eigen::Index>(part.rows[static_cast<std::size_t>(i)]);
        part.slopes.row(i) = slopes.row(row), part.left[i] = left[row], part.weight[i] = weight[row];
      }
      normal_ += part.normal();
    }
  }

  std::vector<Contradiction> run() {
    for (std::size_t k = 0; k < model_.given().cylinders().size(); ++k) {
      checkForces(k);
      for (const auto& [flaw, text] : kFlaws) checkSensor(k, flaw, text);
    }
    std::sort(found_.begin(), found_.end(),
              [](const Contradiction& a, const Contradiction& b) { return a.size > b.size; });
    return std::move(found_);
  }

 private:
  const std::string& jointOf(std::size_t cylinder) const {
    return model_.given().cylinders()[cylinder].parameters().joint;
  }

  /// A recording's mean force, as the others predict it.
  void checkForces(std::size_t cylinder) {
    const std::vector<double> noise = noiseRatios(recordings_, model_.given().cylinders()[cylinder].joint());
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      const Part& part = parts_[r];
      const Eigen::MatrixXd covariance = inverseOf(normal_ - part.normal());
      const Eigen::VectorXd change = -covariance * (part.slopes.transpose() * part.weight.cwiseProduct(part.left));
      const Eigen::VectorXd off = part.left - part.slopes * change;
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(fit_.x.size());
      double sum = 0.0, count = 0.0;
      for (Eigen::Index i = 0; i < off.size(); ++i) {
        if (rows_[part.rows[static_cast<std::size_t>(i)]].cylinder != cylinder) continue;
        sum += off[i], slope += part.slopes.row(i).transpose(), count += 1.0;
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
      found_.push_back({size / limit, what + why + ", leave that recording out"});
    }
  }

  /// Change of the model's forces by the reading of a joint [N/rad], in the rows of a recording.
  Eigen::VectorXd slopesByAngle(std::size_t recording, int joint) const {
    std::vector<BoomPoint> points;
    std::vector<BoomRow> up, down;
    const Part& part = parts_[recording];
    points.reserve(2 * part.count());
    for (const std::size_t i : part.rows) {
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

  /// Slopes of a recording's rows by the unknowns and by friction of its own, one for each cylinder.
  Eigen::MatrixXd withFriction(const Part& part) const {
    const std::size_t cylinders = model_.given().cylinders().size();
    const Eigen::Index n = part.slopes.cols();
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(part.slopes.rows(), n + static_cast<Eigen::Index>(cylinders));
    slopes.leftCols(n) = part.slopes;
    for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
      const BoomRow& row = rows_[part.rows[static_cast<std::size_t>(i)]];
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

  /// A flaw of one recording's sensor as one more unknown of the fit.
  Size sizeOf(std::size_t recording, int joint, Flaw flaw) const {
    const Part& part = parts_[recording];
    if (part.count() == 0) return {};
    const double mean_angle = meanAngle(recordings_[recording], joint);
    Eigen::VectorXd slope = slopesByAngle(recording, joint);
    for (Eigen::Index i = 0; i < slope.size(); ++i)
      slope[i] *= shapeOf(flaw, *rows_[part.rows[static_cast<std::size_t>(i)]].point, joint, mean_angle);
    const Eigen::VectorXd weighted = part.weight.cwiseProduct(slope);
    const Eigen::MatrixXd slopes = withFriction(part);
    const Eigen::Index n = normal_.rows(), all = slopes.cols();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(all, all);
    normal += slopes.transpose() * part.weight.asDiagonal() * slopes;
    normal.topLeftCorner(n, n) = normal_;
    Eigen::VectorXd towards = slopes.transpose() * part.weight.cwiseProduct(part.left);
    towards.head(n).setZero();  // the fit is at its minimum
    const Eigen::VectorXd by_unknowns = slopes.transpose() * weighted, shared = solved(normal, by_unknowns);
    const double rest = slope.dot(weighted) - by_unknowns.dot(shared);
    const double shown = weighted.dot(part.left) - shared.dot(towards);
    const double reach = reachOf(flaw, recordings_[recording], joint, mean_angle);
    if (!(rest > 0.0) || reach < kLeastReach) return {};
    const double information = rest + std::pow(reach / kFlawStd, 2);
    // A reading that is too large by d makes the model's force too large by slope d.
    return {-shown / information, std::sqrt(rest) / information, reach};
  }

  void checkSensor(std::size_t cylinder, Flaw flaw, const char* text) {
    const int joint = model_.given().cylinders()[cylinder].joint();
    std::vector<Size> sizes;
    std::vector<double> values;
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      sizes.push_back(sizeOf(r, joint, flaw));
      values.push_back(sizes.back().value);
    }
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      const Size& s = sizes[r];
      if (!(s.deviation > 0.0)) continue;
      const double size = std::abs(s.value) / std::hypot(s.deviation, spreadWithout(values, r));
      if (size <= kContradicts || std::abs(s.value) * s.reach < kLeastAngle) continue;
      if (std::abs(s.value) * s.reach > kMostAngle) continue;
      const double shown = flaw == Flaw::kScale ? 100.0 * s.value : s.value * 180.0 / kPi;
      found_.push_back({std::abs(s.value) / s.deviation / kContradicts,
                        jointOf(cylinder) + ": its sensor " + format(text, shown) +
                            format(" in %s than in the other recordings: faulty there, leave that recording out",
                                   names_[r].c_str())});
    }
  }

  const BoomModel& model_;
  const std::vector<BoomPoints>& recordings_;
  const std::vector<BoomRow>& rows_;
  const BoomFit& fit_;
  const std::vector<std::string>& names_;
  std::vector<Part> parts_;
  Eigen::MatrixXd normal_;
  std::vector<Contradiction> found_;
};

}  // namespace

std::vector<Contradiction> contradictions(const BoomModel& model, const std::vector<BoomPoints>& recordings,
                                          const std::vector<BoomRow>& rows, const BoomFit& fit,
                                          const std::vector<std::string>& names) {
  if (recordings.size() < 3) return {};
  return Comparison(model, recordings, rows, fit, names).run();
}

}  // namespace hammer_loads::calibration
