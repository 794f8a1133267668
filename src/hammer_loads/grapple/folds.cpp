#include "hammer_loads/grapple/folds.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kLongestStep = 0.01;   ///< along the curve [rad]
constexpr double kShortestStep = 1e-6;  ///< [rad]: a branch that needs shorter ones has no tangent there
constexpr int kMostFoldSteps = 100000;

/// The curve of poses and det J at one point; gradients by (theta1, theta2, theta5).
struct Local {
  Closure closure;
  Eigen::Vector3d df1, df2, ddet;
  Eigen::Vector3d tangent() const { return df1.cross(df2); }  ///< direction whose first component is det J
};

Local localAt(const LeverGroup& group, const FirstRocker& rocker, const Eigen::Vector3d& y) {
  const Planar a = rocker.armAt(y[0]);
  const GroupPose p = group.pose(rocker.o1 + a, y[1], y[2]);
  Local l;
  l.closure = group.closure(p);
  const Closure& k = l.closure;
  l.df1 = {-cross(a, p.u), k.j11, k.j12};
  l.df2 = {-cross(a, p.v), k.j21, k.j22};
  const Eigen::Vector3d dj11{dot(a, p.b), dot(p.b, p.b) + dot(p.u, p.b), -dot(p.d, p.b)};
  const Eigen::Vector3d dj12{-dot(a, p.d), -dot(p.b, p.d), dot(p.d, p.d) - dot(p.u, p.d)};
  const Eigen::Vector3d dj21{dot(a, p.c), dot(p.c, p.c) + dot(p.v, p.c), -dot(p.e, p.c)};
  const Eigen::Vector3d dj22{-dot(a, p.e), -dot(p.c, p.e), dot(p.e, p.e) - dot(p.v, p.e)};
  l.ddet = dj11 * k.j22 + k.j11 * dj22 - dj12 * k.j21 - k.j12 * dj21;
  return l;
}

/// Newton in the plane normal to `normal` through y; false if it does not settle near its start.
bool correct(const LeverGroup& group, const FirstRocker& rocker, const Eigen::Vector3d& normal, double most_move,
             Eigen::Vector3d& y, Local& local) {
  const Eigen::Vector3d start = y;
  for (int i = 0; i < 12; ++i) {
    local = localAt(group, rocker, y);
    if (group.isMet(local.closure)) return true;
    Eigen::Matrix3d m;
    m << local.df1.transpose(), local.df2.transpose(), normal.transpose();
    y -= m.partialPivLu().solve(Eigen::Vector3d{local.closure.f1, local.closure.f2, 0.0});
    if (!((y - start).norm() <= most_move)) return false;
  }
  return false;
}

/// Newton on (f1, f2, det J); keeps y if that leads away.
void polishFold(const LeverGroup& group, const FirstRocker& rocker, Eigen::Vector3d& y) {
  const Eigen::Vector3d start = y;
  Eigen::Vector3d best = y;
  for (int i = 0; i < 4; ++i) {
    const Local l = localAt(group, rocker, best);
    Eigen::Matrix3d m;
    m << l.df1.transpose(), l.df2.transpose(), l.ddet.transpose();
    best -= m.fullPivLu().solve(Eigen::Vector3d{l.closure.f1, l.closure.f2, l.closure.determinant});
    if (!((best - start).norm() < 1e-6)) return;
  }
  y = best;
}

class BranchWalk {
 public:
  BranchWalk(const LeverGroup& group, const FirstRocker& rocker, const CurvePoint& start, int sense)
      : group_(group), rocker_(rocker), y_(start.theta1, start.theta2, start.theta5) {
    local_ = localAt(group, rocker, y_);
    sign_ = std::copysign(1.0, local_.closure.determinant);
    orientation_ = sense * sign_;
  }

  BranchEnd follow(double span) {
    const double start = y_[0];
    double step = kLongestStep;
    for (int i = 0; i < kMostFoldSteps; ++i) {
      const Eigen::Vector3d along = unitTangent(local_);
      Eigen::Vector3d y;
      Local local;
      if (!(step >= kShortestStep)) return end(BranchEnd::Kind::kSingular);
      if (!pointAt(along, step, y, local) || mayHideFolds(along, step, local)) {
        step *= 0.5;
        continue;
      }
      if (local.closure.determinant * sign_ <= 0.0) {
        bisect(along, step);
        return end(BranchEnd::Kind::kFold);
      }
      y_ = y;
      local_ = local;
      if (std::abs(y_[0] - start) >= span) return end(BranchEnd::Kind::kNone);
      step = std::min(2.0 * step, kLongestStep);
    }
    return end(BranchEnd::Kind::kSingular);
  }

 private:
  Eigen::Vector3d unitTangent(const Local& l) const { return orientation_ * l.tangent().normalized(); }

  bool pointAt(const Eigen::Vector3d& along, double step, Eigen::Vector3d& y, Local& local) const {
    y = y_ + step * along;
    return correct(group_, rocker_, along, 0.2 * step, y, local) && unitTangent(local).dot(along) > 0.9;
  }

  /// det J falls towards zero at one end and rises at the other, and its slopes reach zero between them: two folds may
  /// lie inside. Steps below 1e-5 rad are accepted.
  bool mayHideFolds(const Eigen::Vector3d& along, double step, const Local& next) const {
    const double slope0 = sign_ * local_.ddet.dot(along), slope1 = sign_ * next.ddet.dot(unitTangent(next));
    const double det0 = sign_ * local_.closure.determinant, det1 = sign_ * next.closure.determinant;
    return step > 1e-5 && slope0 < 0.0 && slope1 > 0.0 && det0 > 0.0 && det1 > 0.0 &&
           (det0 < -slope0 * step || det1 < slope1 * step);
  }

  void bisect(const Eigen::Vector3d& along, double step) {
    double low = 0.0, high = step;
    Eigen::Vector3d y = y_;
    while (high - low > 1e-14) {
      const double middle = 0.5 * (low + high);
      Local local;
      if (!pointAt(along, middle, y, local)) break;
      (local.closure.determinant * sign_ > 0.0 ? low : high) = middle;
    }
    polishFold(group_, rocker_, y);
    y_ = y;
  }

  BranchEnd end(BranchEnd::Kind kind) const { return {kind, {y_[0], y_[1], y_[2]}}; }

  const LeverGroup& group_;
  const FirstRocker& rocker_;
  Eigen::Vector3d y_;
  Local local_;
  double sign_{}, orientation_{};
};

}  // namespace

BranchEnd findBranchEnd(const LeverGroup& group, const FirstRocker& rocker, const CurvePoint& start, int sense,
                        double span) {
  return BranchWalk(group, rocker, start, sense).follow(span);
}

}  // namespace hammer_loads
