#include "hammer_loads/calibration/boom_calibration.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/recording_check.h"
#include "hammer_loads/calibration/sensor_check.h"
#include "hammer_loads/calibration/static_torques.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kStrongCorrelation = 0.9;  // correlation
constexpr std::size_t kLeastRows = 60;      // per cylinder: 12 s of motion, both ways
constexpr std::size_t kMostPoses = 40;      // at which static torques are judged
constexpr double kSurprise = 3.0;           // standard deviations

double rms(const std::vector<double>& values) {
  double square = 0.0;
  for (const double v : values) square += v * v;
  return values.empty() ? kNaN : std::sqrt(square / static_cast<double>(values.size()));
}

class Finder {
 public:
  Finder(const BoomBasis& basis, const std::vector<WeighedRecording>& recordings) : basis_(basis) {
    for (const WeighedRecording& r : recordings) {
      readings_.push_back(&r.recording);
      points_.push_back(pointsOf(r.recording));
      weights_.push_back(r.weight);
      result_.names.push_back(r.name);
      result_.seconds += points_.back().seconds;
      result_.points += points_.back().points.size(), result_.left_out += points_.back().left_out;
    }
  }

  BoomCalibration run(const Progress& progress) {
    const BoomModel model(basis_, weights_);
    if (!readable(model)) return std::move(result_);
    const std::vector<BoomRow> rows = rowsOf(model, points_);
    if (!enough(model, rows)) return std::move(result_);
    report(progress, 0.1);
    const std::vector<BoomRow> early = part(rows, false), late = part(rows, true);
    const BoomFit held = fitBoom(model, early, piece(progress, 0.1, 0.4));
    const BoomFit fit = fitBoom(model, rows, piece(progress, 0.4, 0.8));
    if (!fit.converged) result_.remarks.emplace_back("the fit did not settle: values are those of its last round");
    const std::vector<Contradiction> found = contradictions(model, points_, rows, fit, result_.names);
    if (!found.empty()) {
      refuse(found.front().text);
      return std::move(result_);
    }
    fillCylinders(model, fit, rows, held, late);
    fillJoints(model, fit);
    fillEstimates(model, fit);
    fillCorrelations(model, fit);
    checkWeight(progress);
    report(progress, 1.0);
    return std::move(result_);
  }

 private:
  bool refuse(std::string why) {
    result_.problem = std::move(why);
    return false;
  }

  bool readable(const BoomModel& model) {
    if (model.given().cylinders().empty()) return refuse("cylinders: [], must be some for calibrate --boom");
    BoomPoints free;  // a single recording may have poses without information on the weight
    for (std::size_t r = 0; r < points_.size(); ++r) {
      if (points_[r].points.empty())
        return refuse("no instant at which every joint and pressure is known and the hammer rests");
      if (weights_[r].mass == 0.0)
        free.points.insert(free.points.end(), points_[r].points.begin(), points_[r].points.end());
    }
    const auto add = [this](const std::string& line) {
      result_.problem += (result_.problem.empty() ? "" : "\n") + line;
    };
    for (const std::string& line : misreadings(model, free)) add(line);
    for (const std::string& line : noisySensors(model.given().chain(), points_, result_.names)) add(line);
    for (const std::string& line : brokenSensors(model.given().chain(), readings_, result_.names)) add(line);
    return result_.problem.empty();
  }

  bool enough(const BoomModel& model, const std::vector<BoomRow>& rows) {
    for (std::size_t k = 0; k < model.given().cylinders().size(); ++k) {
      const auto own = static_cast<std::size_t>(
          std::count_if(rows.begin(), rows.end(), [&](const BoomRow& row) { return row.cylinder == k; }));
      if (own >= kLeastRows) continue;
      const std::string& joint = model.given().cylinders()[k].parameters().joint;
      return refuse(format("%s: surely moves at %zu instants, must at %zu: drive it for half a minute, both ways",
                           joint.c_str(), own, kLeastRows));
    }
    return true;
  }

  /// The last quarter of each recording, or what is before it.
  std::vector<BoomRow> part(const std::vector<BoomRow>& rows, bool last) const {
    std::vector<BoomRow> some;
    for (const BoomRow& row : rows) {
      const std::vector<BoomPoint>& points = points_[row.recording].points;
      const double from = points.front().time + 0.75 * (points.back().time - points.front().time);
      if ((row.point->time >= from) == last) some.push_back(row);
    }
    return some;
  }

  void fillCylinders(const BoomModel& model, const BoomFit& fit, const std::vector<BoomRow>& rows, const BoomFit& held,
                     const std::vector<BoomRow>& late) {
    const Eigen::VectorXd after = residualsOf(model, rows, fit.x), before = residualsOf(model, rows, model.zero()),
                          unseen = residualsOf(model, late, held.x);
    Boom boom = model.given();
    for (std::size_t k = 0; k < fit.noise.size(); ++k) {
      CylinderFit c;
      c.name = model.given().cylinders()[k].parameters().name;
      std::vector<double> force, left, was, out;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].cylinder != k) continue;
        const auto e = static_cast<Eigen::Index>(i);
        force.push_back(rows[i].measured), left.push_back(after[e]), was.push_back(before[e]);
        const BoomPoint& point = *rows[i].point;
        model.move(boom, model.zero(), point);
        result_.residuals.push_back({k, point.motion.position[boom.cylinders()[k].joint()],
                                     BoomModel::rodSpeed(boom, k, point) > 0.0, before[e], after[e]});
      }
      for (std::size_t i = 0; i < late.size(); ++i)
        if (late[i].cylinder == k) out.push_back(unseen[static_cast<Eigen::Index>(i)]);
      for (std::size_t r = 0; r < points_.size() && points_.size() > 1; ++r)
        c.left_in.push_back(rmsOf(rows, after, k, r));
      c.rows = force.size(), c.force = rms(force), c.left = rms(left), c.before = rms(was), c.held_out = rms(out);
      const auto friction = [&](const Eigen::VectorXd& x) {
        return model.valueOf(x, BoomUnknown::kFrictionForce, k) + c.force * model.valueOf(x, BoomUnknown::kFriction, k);
      };
      c.friction = friction(fit.x), c.friction_std = deviationOf(fit, gradientOf(friction, fit.x));
      result_.cylinders.push_back(c);
    }
  }

  static double rmsOf(const std::vector<BoomRow>& rows, const Eigen::VectorXd& left, std::size_t cylinder,
                      std::size_t recording) {
    std::vector<double> own;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i].cylinder == cylinder && rows[i].recording == recording)
        own.push_back(left[static_cast<Eigen::Index>(i)]);
    return rms(own);
  }

  void fillJoints(const BoomModel& model, const BoomFit& fit) {
    const std::vector<BoomPoint>& points = points_.front().points;
    std::vector<JointVector> poses;
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kMostPoses)
      poses.push_back(points[i].motion.position);
    const std::vector<std::vector<StaticTorque>> found = staticTorques(model, fit, poses);
    const Eigen::MatrixXd before = weightTorques(model, model.zero(), poses);
    for (std::size_t k = 0; k < fit.noise.size(); ++k) {
      std::vector<double> torque, deviation, off;
      for (std::size_t p = 0; p < poses.size(); ++p) {
        torque.push_back(found[p][k].value), deviation.push_back(found[p][k].deviation);
        off.push_back(found[p][k].value - before(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(k)));
      }
      result_.joints.push_back(
          {model.given().cylinders()[k].parameters().joint, rms(torque), rms(deviation), rms(off)});
    }
  }

  static Estimate estimateOf(const BoomModel& model, const BoomFit& fit, std::size_t unknown) {
    const auto e = static_cast<Eigen::Index>(unknown);
    Estimate estimate;
    estimate.key = model.nameOf(unknown), estimate.value = model.valueOf(fit.x, unknown);
    estimate.limit = model.unknowns()[unknown].deviation;
    estimate.deviation = estimate.limit * std::sqrt(fit.covariance(e, e));
    return estimate;
  }

  void fillEstimates(const BoomModel& model, const BoomFit& fit) {
    result_.found = model.parametersAt(fit.x);
    const Boom found = *Boom::make(basis_.urdf, result_.found).value;
    for (std::size_t i = 0; i < model.unknowns().size(); ++i) {
      Estimate estimate = estimateOf(model, fit, i);
      describe(model, found, model.unknowns()[i], estimate);
      result_.estimates.push_back(estimate);
    }
    for (std::size_t k = 0; k < fit.noise.size(); ++k) fillMoments(model, fit, k);
  }

  void describe(const BoomModel& model, const Boom& found, const Unknown& u, Estimate& e) {
    if (u.kind == BoomUnknown::kTipWeight) {
      e.unit = "kg", e.meaning = "hung on the tip";
      return;
    }
    if (u.kind == BoomUnknown::kRecording) {
      e.unit = "Pa", e.meaning = "not of the boom file; " + result_.names[u.recording];
      return;
    }
    CylinderParameters& cylinder = result_.found.cylinders[u.of];
    const WeighedLink given = model.given().chain().body(model.linkOf(u.of)),
                      link = found.chain().body(model.linkOf(u.of));
    const auto absolute = [&](double value, double before, double unit, const char* name) {
      e.value = value, e.deviation *= unit, e.limit *= unit, e.unit = name;
      e.meaning = format("given %.6g", before);
    };
    switch (u.kind) {
      case BoomUnknown::kMass:
        return absolute(link.mass, given.mass, link.mass, "kg");
      case BoomUnknown::kComX:
        return absolute(link.com_x, given.com_x, 1.0, "m");
      case BoomUnknown::kComZ:
        return absolute(link.com_z, given.com_z, 1.0, "m");
      case BoomUnknown::kInertia:
        return absolute(link.inertia, given.inertia, link.inertia, "kg m2");
      case BoomUnknown::kFrictionForce:
        cylinder.friction_force_std = e.deviation;
        return absolute(e.value, u.given, 1.0, "N");
      case BoomUnknown::kFriction:
        cylinder.friction_std = e.deviation;
        return absolute(e.value, u.given, 1.0, "");
      case BoomUnknown::kOffset:
        cylinder.pressure_offset_std = e.deviation;
        return absolute(e.value, u.given, 1.0, "Pa");
      case BoomUnknown::kZero:
        cylinder.joint_zero_std = e.deviation;
        return absolute(e.value, u.given, 1.0, "rad");
      case BoomUnknown::kViscous:
        e.unit = "N s/m", e.meaning = "not of the boom file";
        return;
      default:
        e.meaning = "not of the boom file; part by which its force is shown too large";
        return;
    }
  }

  void fillMoments(const BoomModel& model, const BoomFit& fit, std::size_t cylinder) {
    const std::string& name = model.given().chain().link(model.linkOf(cylinder)).name;
    const Eigen::Vector2d deviation = firstMomentDeviation(model, fit, cylinder);
    if (WeighedLink* link = findLink(result_.found.chain.weighed, name))
      link->moment_x_std = deviation[0], link->moment_z_std = deviation[1];
  }

  void fillCorrelations(const BoomModel& model, const BoomFit& fit) {
    const Eigen::VectorXd scale = fit.covariance.diagonal().cwiseSqrt();
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
      const std::string name = model.nameOf(static_cast<std::size_t>(i));
      if (std::abs(fit.x[i]) > kSurprise)
        result_.remarks.push_back(format("%s is %.1f deviations off what was given", name.c_str(), std::abs(fit.x[i])));
      for (Eigen::Index j = 0; j < i; ++j) {
        const double r = fit.covariance(i, j) / (scale[i] * scale[j]);
        if (std::abs(r) > kStrongCorrelation)
          result_.correlations.push_back({model.nameOf(static_cast<std::size_t>(j)), name, r});
      }
    }
  }

  /// Estimates the weight on a boom that was weighed without it.
  void checkWeight(const Progress& progress) {
    const auto hung = std::find_if(weights_.begin(), weights_.end(), [](const TipWeight& w) { return w.mass > 0.0; });
    const bool any_free =
        std::any_of(weights_.begin(), weights_.end(), [](const TipWeight& w) { return w.mass == 0.0; });
    if (hung == weights_.end() || !any_free) return;
    std::vector<TipWeight> asked = weights_;
    constexpr double kAnything = 3.0;  // times what hangs there
    for (TipWeight& w : asked)
      if (w.mass > 0.0) w.deviation = kAnything * w.mass;
    const BoomModel model(basis_, asked);
    const BoomFit fit = fitBoom(model, rowsOf(model, points_), piece(progress, 0.8, 1.0));
    for (std::size_t i = 0; i < model.unknowns().size(); ++i) {
      if (model.unknowns()[i].kind != BoomUnknown::kTipWeight) continue;
      Estimate& check = result_.weight_check.emplace(estimateOf(model, fit, i));
      check.unit = "kg";
      check.meaning = format("given %.6g", hung->mass);
      return;
    }
  }

  BoomBasis basis_;
  std::vector<const BoomRecording*> readings_;
  std::vector<BoomPoints> points_;
  std::vector<TipWeight> weights_;
  BoomCalibration result_;
};

}  // namespace

bool BoomCalibration::determined() const {
  return problem.empty() &&
         std::all_of(joints.begin(), joints.end(), [](const JointWeight& j) { return j.part() <= kLimit; }) &&
         std::all_of(cylinders.begin(), cylinders.end(), [](const CylinderFit& c) { return c.holds(); });
}

BoomCalibration calibrateBoom(const BoomBasis& basis, const std::vector<WeighedRecording>& recordings,
                              const Progress& progress) {
  return Finder(basis, recordings).run(progress);
}

}  // namespace hammer_loads::calibration
