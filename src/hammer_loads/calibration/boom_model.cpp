#include "hammer_loads/calibration/boom_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::calibration {
namespace {

int heaviestBeyond(const Chain& chain, int joint) {
  int heaviest = chain.linkBeyond(joint);
  for (int i = heaviest + 1; i < chain.links() && chain.link(i).joint < 0; ++i)
    if (chain.link(i).body.mass > chain.link(heaviest).body.mass) heaviest = i;
  return heaviest;
}

/// Adds a point mass to a body.
WeighedLink together(WeighedLink link, double mass, double x, double z) {
  const double all = link.mass + mass, dx = x - link.com_x, dz = z - link.com_z;
  link.com_x += mass / all * dx, link.com_z += mass / all * dz;
  link.inertia += link.mass * mass / all * (dx * dx + dz * dz);
  link.mass = all;
  return link;
}

/// Scales a part by the ratio of its link's mass.
void scale(PartBeyond& part, double by) { part.mass *= by, part.inertia_y *= by; }

void replace(std::vector<WeighedLink>& links, const WeighedLink& link) {
  if (WeighedLink* same = findLink(links, link.name))
    *same = link;
  else
    links.push_back(link);
}

using Link = WeighedLink;
using Holder = CylinderParameters;

/// Kinds in the order of BoomUnknown.
constexpr UnknownKind kKinds[]{
    {"_mass_kg", "kg", "", &Link::mass, true},
    {"_com_x_m", "m", "", &Link::com_x},
    {"_com_z_m", "m", "", &Link::com_z},
    {"_inertia_kg_m2", "kg m2", "", &Link::inertia, true},
    {"_friction_force_N", "N", "", nullptr, false, &Holder::friction_force, &Holder::friction_force_std},
    {"_friction", "", "", nullptr, false, &Holder::friction, &Holder::friction_std},
    {"'s friction by speed", "N s/m", "not of the boom file"},
    {"_pressure_offset_Pa", "Pa", "", nullptr, false, &Holder::pressure_offset, &Holder::pressure_offset_std},
    {"'s bore and gain of its sensors", "", "not of the boom file; part by which its force is shown too large"},
    {"_joint_zero_rad", "rad", "", nullptr, false, &Holder::joint_zero, &Holder::joint_zero_std},
    {"weight on the tip", "kg", "hung on the tip"},
    {"'s offset in recording ", "Pa", "not of the boom file; "},
};

}  // namespace

const UnknownKind& kindOf(BoomUnknown unknown) { return kKinds[static_cast<std::size_t>(unknown)]; }

BoomModel::BoomModel(const BoomBasis& basis, const std::vector<TipWeight>& weights)
    : basis_(basis), weights_(weights), given_(Boom::make(basis.urdf, basis.parameters).value.value()) {
  for (std::size_t k = 0; k < given_.cylinders().size(); ++k) {
    const Cylinder& cylinder = given_.cylinders()[k];
    const CylinderParameters& p = cylinder.parameters();
    links_.push_back(heaviestBeyond(given_.chain(), cylinder.joint()));
    const auto add = [&](BoomUnknown kind, double given, double deviation) {
      if (deviation > 0.0) unknowns_.push_back({kind, k, given, deviation});
    };
    add(BoomUnknown::kMass, 0.0, basis.mass_std);
    add(BoomUnknown::kComX, 0.0, basis.com_std);
    add(BoomUnknown::kComZ, 0.0, basis.com_std);
    add(BoomUnknown::kInertia, 0.0, basis.inertia_std);
    add(BoomUnknown::kFrictionForce, p.friction_force, basis.friction_force_std * cylinder.greatestPush());
    add(BoomUnknown::kFriction, p.friction, basis.friction_std);
    add(BoomUnknown::kViscous, 0.0, basis.viscous_std * cylinder.greatestPush());
    add(BoomUnknown::kOffset, p.pressure_offset, basis.offset_std);
    add(BoomUnknown::kGain, 0.0, basis.gain_std);
    add(BoomUnknown::kZero, p.joint_zero, basis.zero_std);
  }
  for (std::size_t k = 0; k < given_.cylinders().size() && weights.size() > 1; ++k)
    for (std::size_t r = 0; r < weights.size(); ++r)
      unknowns_.push_back({BoomUnknown::kRecording, k, 0.0, basis.recording_std, r});
  for (std::size_t r = 0; r < weights.size(); ++r)
    if (weights[r].deviation > 0.0)
      unknowns_.push_back({BoomUnknown::kTipWeight, r, weights[r].mass, weights[r].deviation});
}

double BoomModel::valueOf(const Eigen::VectorXd& x, BoomUnknown kind, std::size_t of, double otherwise,
                          std::size_t recording) const {
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& u = unknowns_[i];
    if (u.kind == kind && u.of == of && u.recording == recording) return valueOf(x, i);
  }
  return otherwise;
}

std::string BoomModel::nameOf(std::size_t unknown) const {
  const Unknown& u = unknowns_[unknown];
  const UnknownKind& kind = kindOf(u.kind);
  if (u.kind == BoomUnknown::kTipWeight) return kind.name;
  const std::string name =
      (kind.of_link ? given_.chain().link(links_[u.of]).name : given_.cylinders()[u.of].parameters().name) + kind.name;
  return u.kind == BoomUnknown::kRecording ? name + std::to_string(u.recording + 1) : name;
}

std::vector<WeighedLink> BoomModel::linksAt(const Eigen::VectorXd& x) const {
  std::vector<WeighedLink> links;
  for (const int index : links_) links.push_back(given_.chain().body(index));
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const UnknownKind& kind = kindOf(unknowns_[i].kind);
    if (!kind.of_link) continue;
    double& value = links[unknowns_[i].of].*kind.of_link;
    value = kind.is_logarithm ? value * std::exp(valueOf(x, i)) : value + valueOf(x, i);
  }
  return links;
}

std::vector<WeighedLink> BoomModel::weighedAt(const Eigen::VectorXd& x) const {
  std::vector<WeighedLink> weighed = basis_.parameters.chain.weighed;
  for (const WeighedLink& link : linksAt(x)) replace(weighed, link);
  return weighed;
}

BoomParameters BoomModel::parametersAt(const Eigen::VectorXd& x) const {
  BoomParameters parameters = basis_.parameters;
  parameters.chain.weighed = weighedAt(x);
  const std::vector<WeighedLink> links = linksAt(x);
  for (SectionParameters& section : parameters.sections) {
    const WeighedLink* link = section.beyond ? findLink(links, section.link) : nullptr;
    if (link == nullptr) continue;
    const Chain& chain = given_.chain();
    scale(*section.beyond, link->mass / chain.link(*chain.linkIndex(link->name)).body.mass);
  }
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const auto member = kindOf(unknowns_[i].kind).of_cylinder;
    if (member) parameters.cylinders[unknowns_[i].of].*member = valueOf(x, i);
  }
  return parameters;
}

std::optional<Boom> BoomModel::boomAt(const Eigen::VectorXd& x) const {
  return given_.weighed(basis_.urdf, weighedAt(x));
}

std::optional<Boom> BoomModel::boomAt(const Eigen::VectorXd& x, std::size_t recording) const {
  std::vector<WeighedLink> weighed = weighedAt(x);
  const Chain& chain = given_.chain();
  const TipWeight& weight = weights_[recording];
  const double mass = valueOf(x, BoomUnknown::kTipWeight, recording, weight.mass);
  if (mass != 0.0) {
    WeighedLink tip = chain.body(chain.tip());
    if (const WeighedLink* known = findLink(weighed, tip.name)) tip = *known;
    replace(weighed, together(tip, mass, weight.x, weight.z));
  }
  return given_.weighed(basis_.urdf, std::move(weighed));
}

std::size_t BoomModel::firstWithWeightOf(std::size_t recording) const {
  const TipWeight& own = weights_[recording];
  const auto same = [&](const TipWeight& w) {
    return own.deviation == 0.0 && w.deviation == 0.0 && w.mass == own.mass && w.x == own.x && w.z == own.z;
  };
  const auto first = std::find_if(weights_.begin(), weights_.begin() + static_cast<std::ptrdiff_t>(recording), same);
  return static_cast<std::size_t>(first - weights_.begin());
}

double BoomModel::jointZero(const Eigen::VectorXd& x, std::size_t cylinder) const {
  return valueOf(x, BoomUnknown::kZero, cylinder, given_.cylinders()[cylinder].parameters().joint_zero);
}

void BoomModel::move(Boom& boom, const Eigen::VectorXd& x, const BoomPoint& point) const {
  JointMotion motion = point.motion;
  for (std::size_t k = 0; k < boom.cylinders().size(); ++k)
    motion.position[boom.cylinders()[k].joint()] -= jointZero(x, k);
  boom.move(motion, basis_.g_B);
}

double BoomModel::rodSpeed(const Boom& boom, std::size_t cylinder, const BoomPoint& point) {
  return boom.cylinderPosition(cylinder).arm * point.motion.velocity[boom.cylinders()[cylinder].joint()];
}

/// Friction acts against the rod's motion: the rod's push is the oil's force minus friction.
double BoomModel::shownForce(const Boom& boom, const Eigen::VectorXd& x, std::size_t cylinder, std::size_t recording,
                             const BoomPoint& point) const {
  const auto unknown = [&](BoomUnknown kind, double otherwise) { return valueOf(x, kind, cylinder, otherwise); };
  const Cylinder& c = boom.cylinders()[cylinder];
  const CylinderParameters& p = c.parameters();
  const double force = c.load(boom.cylinderPosition(cylinder), boom.steadyTorque(c.joint())).force;
  const double speed = rodSpeed(boom, cylinder, point);
  const double rubbing = unknown(BoomUnknown::kFrictionForce, p.friction_force) +
                         unknown(BoomUnknown::kFriction, p.friction) * std::abs(force);
  const double oil = force + (speed < 0.0 ? -rubbing : rubbing) + unknown(BoomUnknown::kViscous, 0.0) * speed;
  return oil * (1.0 + unknown(BoomUnknown::kGain, 0.0)) +
         (unknown(BoomUnknown::kOffset, p.pressure_offset) +
          valueOf(x, BoomUnknown::kRecording, cylinder, 0.0, recording)) *
             c.boreArea();
}

double BoomModel::measuredForce(std::size_t cylinder, const BoomPoint& point) const {
  const auto& p = point.pressure[cylinder];
  return forceOf(given_.cylinders()[cylinder], {p[0], p[1]});
}

Eigen::VectorXd weightTorques(const BoomModel& model, const Eigen::VectorXd& x, const std::vector<JointVector>& poses) {
  const std::vector<Cylinder>& cylinders = model.given().cylinders();
  Eigen::VectorXd torques(static_cast<Eigen::Index>(poses.size() * cylinders.size()));
  const std::optional<Boom> boom = model.boomAt(x);
  if (!boom) return torques.setConstant(kNaN);
  Eigen::Index next = 0;
  for (JointVector position : poses) {
    for (std::size_t k = 0; k < cylinders.size(); ++k) position[cylinders[k].joint()] -= model.jointZero(x, k);
    ChainPose pose;
    forwardKinematics(boom->chain(), position, pose);
    const JointVector torque = jointTorqueOfWeight(boom->chain(), pose, model.basis().g_B);
    for (const Cylinder& cylinder : cylinders) torques[next++] = torque[cylinder.joint()];
  }
  return torques;
}

}  // namespace hammer_loads::calibration
