#include "hammer_loads/hammer/hull_model.h"

#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

/// Derivatives of force x, force z and moment by the links' masses: hullWrenchOf() and addTurningLinkage() are linear
/// in them.
LinkMasses::Effect effectOnHull(const Mechanism& mechanism, const LinkMotion& l, const CrankMotion& crank,
                                const HullMotion& hull) noexcept {
  using M = LinkMasses;
  const LinkAccelerations q = linkAccelerations(l, crank.speed, crank.acceleration);
  const TurningAccelerations t = turningAccelerations(l, crank.speed, hull);
  const Gravity g = hull.gravity;
  const Planar from_d = conj(mechanism.moments().pivot);
  const double coriolis = 2.0 * hull.rate * crank.speed;
  M::Effect by = M::Effect::Zero();
  const auto force = [&](int i, Planar direction, Planar acceleration) {
    const Planar a = direction * acceleration;
    by.col(i) << a.re, -a.im, direction.re * g.z + direction.im * g.x;
  };
  // Adds the part of a first moment about A; rate [-]: derivative of its direction by the crank angle.
  const auto atA = [&](int i, Planar direction, Planar relative, Planar turning, double rate) {
    force(i, direction, relative + turning);
    const Planar place = from_d * direction;
    by(2, i) += place.re * relative.im + place.im * relative.re + 2.0 * hull.acceleration * place.re -
                coriolis * rate * place.im;
  };
  atA(M::kCrank, l.phi, q.crank, t.links.crank, 1.0);
  atA(M::kCrank + 1, turned(l.phi), q.crank, t.links.crank, 1.0);
  atA(M::kRod, l.beta, q.rod, t.links.rod, l.v);
  atA(M::kRod + 1, turned(l.beta), q.rod, t.links.rod, l.v);
  force(M::kRocker, l.psi, q.rocker + t.links.rocker);
  force(M::kAtA, -1.0 * conj(from_d), t.hull);
  by(2, M::kAtA) -= hull.acceleration * (from_d * conj(from_d)).re;
  by.col(M::kMass) << g.x, g.z, 0.0;
  by(2, M::kCrankInertia) = -q.crank.im - hull.acceleration;
  by(2, M::kRodInertia) = -q.rod.im - hull.acceleration;
  by(2, M::kRockerInertia) = -q.rocker.im - hull.acceleration;
  const auto coupling = [&](int i, Planar direction) {
    by(2, i) = -direction.re * (q.rod.im + q.crank.im + 2.0 * hull.acceleration) -
               direction.im * (q.rod.re - q.crank.re - coriolis * (l.v - 1.0));
  };
  coupling(M::kCoupling, l.delta), coupling(M::kCoupling + 1, turned(l.delta));
  const double r = mechanism.parameters().drive_reaction_ratio;
  by(2, M::kWithinDrive) = -(1.0 - r) * crank.acceleration - (1.0 - r * r) * hull.acceleration;
  return by;
}

}  // namespace

HullModel::HullModel(const Mechanism& mechanism, Level level) : mechanism_(&mechanism), level_(rigid(level)) {
  if (level != Level::kPulse) return;
  const HalfSinePulse nominal = pulseAtConstantSpeed(mechanism, Level::kRocker, 1.0, {}).pulse;
  if (!(nominal.frequency > 0.0)) return;
  pulse_ = {nominal.amplitude, nominal.frequency, kPi / nominal.frequency};
}

WrenchColumns::WrenchColumns(const HullModel& model)
    : model_(&model), columns_(machineColumns(model.mechanism(), model.level())) {
  if (!columns_) return;
  models_.reserve(columns_->columns().size());
  for (const MachineColumn& column : columns_->columns()) models_.emplace_back(column.mechanism, column.level);
}

std::vector<std::string> WrenchColumns::names() const {
  std::vector<std::string> names;
  if (isExact()) return names;
  for (const MachineColumn& column : columns_->columns()) names.push_back(column.name);
  return names;
}

/// Leaves the table out where drive_reaction_ratio is uncertain, because that column depends on the drive's inertia.
void WrenchColumns::tabulate() {
  const auto ratio = indexOfConstant("drive_reaction_ratio");
  if (isExact() || model_->level() == Level::kPulse || model_->mechanism().parameters().deviations[*ratio] > 0.0)
    return;
  table_.emplace([&](CrankAngle angle) {
    const LinksAtAngle at = linksAt(*model_, angle);
    const auto part = [&](double speed, double acceleration, Gravity gravity) {
      return evaluate(0.0, at, {angle, speed, acceleration}, {gravity, 0.0, 0.0});
    };
    Table::Point point;
    point << part(1.0, 0.0, {}), part(0.0, 1.0, {}), part(0.0, 0.0, {1.0, 0.0}), part(0.0, 0.0, {0.0, 1.0});
    return point;
  });
}

WrenchColumns::Matrix WrenchColumns::wrench(double drive_inertia, const LinksAtAngle& at, const CrankMotion& crank,
                                            const HullMotion& hull) const noexcept {
  if (isExact()) return Matrix::Zero();
  if (!table_ || hull.turns() || !Table::covers(at.angle)) return evaluate(drive_inertia, at, crank, hull);
  const Table::Point point = table_->at(at.angle);
  const auto f = [](double x) { return static_cast<float>(x); };
  return f(crank.speed * crank.speed) * point.topRows<3>() + f(crank.acceleration) * point.middleRows<3>(3) +
         f(hull.gravity.x) * point.middleRows<3>(6) + f(hull.gravity.z) * point.bottomRows<3>();
}

WrenchColumns::Matrix WrenchColumns::evaluate(double drive_inertia, const LinksAtAngle& at, const CrankMotion& crank,
                                              const HullMotion& hull) const noexcept {
  const auto load = [&](const HullModel& model, const LinkMotion& links) {
    return vectorOf(hullWrench(model, driveReaction(model, drive_inertia), links, crank, hull));
  };
  const bool linear = model_->level() != Level::kPulse;
  Matrix columns =
      linear ? columns_->byMasses(effectOnHull(model_->mechanism(), at.links, crank, hull)) : Matrix(Matrix::Zero());
  const Eigen::Vector3d here = load(*model_, at.links);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const MachineColumn& column = columns_->columns()[i];
    if (column.enters == HammerConstant::Enters::kBlow || (linear && column.of_masses)) continue;
    columns.col(static_cast<Eigen::Index>(i)) =
        (1.0 / column.step * (load(models_[i], column.linksAt(at.angle, at.links)) - here)).cast<float>();
  }
  return columns;
}

}  // namespace hammer_loads
