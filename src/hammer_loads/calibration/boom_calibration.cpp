#include "hammer_loads/calibration/boom_calibration.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/recording_check.h"
#include "hammer_loads/calibration/sensor_check.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

constexpr std::size_t kLeastRows = 60;  // per cylinder: 12 s of motion, in both directions
constexpr std::size_t kMostPoses = 40;  // for the rms of static torques
// Limit: kLeastRows
// Numerical: kMostPoses

double rms(const std::vector<double>& values) {
  double square = 0.0;
  for (const double v : values) square += v * v;
  return values.empty() ? kNaN : std::sqrt(square / static_cast<double>(values.size()));
}

/// Returns the rms of the values in a cylinder's rows, in one recording or in all.
double rmsOf(const std::vector<BoomRow>& rows, const Eigen::VectorXd& values, std::size_t cylinder,
             std::optional<std::size_t> recording = {}) {
  std::vector<double> own;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].cylinder == cylinder && (!recording || rows[i].recording == *recording))
      own.push_back(values[static_cast<Eigen::Index>(i)]);
  return rms(own);
}

std::size_t countOf(const std::vector<BoomRow>& rows, std::size_t cylinder) {
  const auto own = [&](const BoomRow& row) { return row.cylinder == cylinder; };
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), own));
}

/// Returns x and z of the first moment about a cylinder's joint of the bodies beyond it, in the axes of `link`. Bodies
/// beyond the next joint count as concentrated in that joint.
Eigen::Vector2d firstMoment(const Boom& boom, int joint, int link) {
  const Chain& chain = boom.chain();
  ChainPose pose;
  forwardKinematics(chain, JointVector::Zero(chain.joints()), pose);
  const int first = chain.linkBeyond(joint);
  int last = first + 1;
  while (last < chain.links() && chain.link(last).joint < 0) ++last;
  Eigen::Vector3d moment_B = Eigen::Vector3d::Zero();
  for (int i = first; i < chain.links(); ++i) {
    const RigidBody& body = chain.link(i).body;
    const Eigen::Vector3d at_B =
        i < last ? Eigen::Vector3d(pose.link(i) * body.com) : Eigen::Vector3d(pose.link(last).translation());
    moment_B += body.mass * (at_B - pose.p_BJ_B[static_cast<std::size_t>(joint)]);
  }
  const Eigen::Vector3d moment = pose.link(link).linear().transpose() * moment_B;
  return {moment.x(), moment.z()};
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
    result_.problem = contradictionOf(model, points_, rows, fit, result_.names);
    if (!result_.problem.empty()) return std::move(result_);
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
    const Chain& chain = model.given().chain();
    std::vector<std::string> lines = misreadings(model, free);
    for (const auto& more :
         {noisySensors(chain, points_, result_.names), brokenSensors(chain, readings_, result_.names)})
      lines.insert(lines.end(), more.begin(), more.end());
    return lines.empty() || refuse(joined(lines, "\n"));
  }

  bool enough(const BoomModel& model, const std::vector<BoomRow>& rows) {
    for (std::size_t k = 0; k < model.given().cylinders().size(); ++k) {
      const std::size_t own = countOf(rows, k);
      if (own >= kLeastRows) continue;
      const std::string& joint = model.given().cylinders()[k].parameters().joint;
      return refuse(format("%s: surely moves at %zu instants, must at %zu: drive it for half a minute, both ways",
                           joint.c_str(), own, kLeastRows));
    }
    return true;
  }

  /// Returns the rows of the last quarter of each recording, or those before it.
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
    Eigen::VectorXd force(after.size());
    Boom boom = model.given();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto e = static_cast<Eigen::Index>(i);
      const std::size_t k = rows[i].cylinder;
      const BoomPoint& point = *rows[i].point;
      model.move(boom, model.zero(), point);
      force[e] = rows[i].measured;
      result_.residuals.push_back({k, point.motion.position[boom.cylinders()[k].joint()],
                                   BoomModel::rodSpeed(boom, k, point) > 0.0, before[e], after[e]});
    }
    for (std::size_t k = 0; k < fit.noise.size(); ++k) {
      CylinderFit c;
      c.name = model.given().cylinders()[k].parameters().name;
      c.rows = countOf(rows, k), c.force = rmsOf(rows, force, k), c.left = rmsOf(rows, after, k);
      c.before = rmsOf(rows, before, k), c.held_out = rmsOf(late, unseen, k);
      for (std::size_t r = 0; r < points_.size() && points_.size() > 1; ++r)
        c.left_in.push_back(rmsOf(rows, after, k, r));
      const auto friction = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, model.valueOf(x, BoomUnknown::kFrictionForce, k) +
                                                c.force * model.valueOf(x, BoomUnknown::kFriction, k));
      };
      c.friction = friction(fit.x)[0], c.friction_std = stdsOf(fit, friction)[0];
      result_.cylinders.push_back(c);
    }
  }

  void fillJoints(const BoomModel& model, const BoomFit& fit) {
    const std::vector<BoomPoint>& points = points_.front().points;
    std::vector<JointVector> poses;
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kMostPoses)
      poses.push_back(points[i].motion.position);
    const auto torques = [&](const Eigen::VectorXd& x) { return weightTorques(model, x, poses); };
    const Eigen::VectorXd found = torques(fit.x), stds = stdsOf(fit, torques), off = found - torques(model.zero());
    const std::size_t cylinders = fit.noise.size();
    for (std::size_t k = 0; k < cylinders; ++k) {
      const auto rms_of_joint = [&](const Eigen::VectorXd& all) {
        std::vector<double> own;
        for (std::size_t i = k; i < poses.size() * cylinders; i += cylinders)
          own.push_back(all[static_cast<Eigen::Index>(i)]);
        return rms(own);
      };
      result_.joints.push_back({model.given().cylinders()[k].parameters().joint, rms_of_joint(found),
                                rms_of_joint(stds), rms_of_joint(off)});
    }
  }

  static Estimate estimateOf(const BoomModel& model, const BoomFit& fit, std::size_t unknown) {
    const auto e = static_cast<Eigen::Index>(unknown);
    const Unknown& u = model.unknowns()[unknown];
    return {model.nameOf(unknown),
            kindOf(u.kind).unit,
            model.valueOf(fit.x, unknown),
            u.deviation * std::sqrt(fit.covariance(e, e)),
            u.deviation,
            kindOf(u.kind).note};
  }

  void fillEstimates(const BoomModel& model, const BoomFit& fit) {
    result_.found = model.parametersAt(fit.x);
    const Boom found = *Boom::make(basis_.urdf, result_.found).value;
    for (std::size_t i = 0; i < model.unknowns().size(); ++i) {
      const Unknown& u = model.unknowns()[i];
      const UnknownKind& kind = kindOf(u.kind);
      Estimate e = estimateOf(model, fit, i);
      if (kind.of_link) {
        const int link = model.linkOf(u.of);
        e.value = found.chain().body(link).*kind.of_link;
        const double unit = kind.is_logarithm ? e.value : 1.0;
        e.deviation *= unit, e.limit *= unit;
        e.meaning = format("given %.6g", model.given().chain().body(link).*kind.of_link);
      } else if (kind.of_cylinder) {
        result_.found.cylinders[u.of].*kind.std = e.deviation;
        e.meaning = format("given %.6g", u.given);
      } else if (u.kind == BoomUnknown::kRecording) {
        e.meaning += result_.names[u.recording];
      }
      result_.estimates.push_back(e);
    }
    for (std::size_t k = 0; k < fit.noise.size(); ++k) {
      const int joint = model.given().cylinders()[k].joint(), link = model.linkOf(k);
      const Eigen::VectorXd deviation = stdsOf(fit, [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        const std::optional<Boom> boom = model.boomAt(x);
        return boom ? firstMoment(*boom, joint, link) : Eigen::Vector2d(kNaN, kNaN);
      });
      if (WeighedLink* weighed = findLink(result_.found.chain.weighed, model.given().chain().link(link).name))
        weighed->moment_x_std = deviation[0], weighed->moment_z_std = deviation[1];
    }
  }

  void fillCorrelations(const BoomModel& model, const BoomFit& fit) {
    std::vector<std::string> names;
    for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
      names.push_back(model.nameOf(static_cast<std::size_t>(i)));
      if (const double off = std::abs(fit.x[i]); off > gate::kRare)
        result_.remarks.push_back(format("%s is %.1f deviations off what was given", names.back().c_str(), off));
    }
    addCorrelations(fit.covariance, names, result_);
  }

  /// Estimates the weight on a boom that was identified without it.
  void checkWeight(const Progress& progress) {
    const auto hung = std::find_if(weights_.begin(), weights_.end(), [](const TipWeight& w) { return w.mass > 0.0; });
    const bool any_free =
        std::any_of(weights_.begin(), weights_.end(), [](const TipWeight& w) { return w.mass == 0.0; });
    if (hung == weights_.end() || !any_free) return;
    std::vector<TipWeight> asked = weights_;
    constexpr double kAnything = 3.0;  // times the hung weight
    // Prior: kAnything
    for (TipWeight& w : asked)
      if (w.mass > 0.0) w.deviation = kAnything * w.mass;
    const BoomModel model(basis_, asked);
    const BoomFit fit = fitBoom(model, rowsOf(model, points_), piece(progress, 0.8, 1.0));
    for (std::size_t i = 0; i < model.unknowns().size(); ++i) {
      if (model.unknowns()[i].kind != BoomUnknown::kTipWeight) continue;
      result_.weight_check = estimateOf(model, fit, i);
      result_.weight_check->meaning = format("given %.6g", hung->mass);
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
