// Cost of the hammer's and the boom's loads beside general multibody libraries: KDL, and MuJoCo where it is installed.
// scripts/update_performance writes them to doc/performance.md. The counter `difference` of a row is the largest
// difference from this package's result over its states, as a fraction of the largest result.
#include <benchmark/benchmark.h>

#include <cmath>
#include <complex>
#include <functional>
#include <kdl/chain.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/boom/boom.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/settings/load.h"
#ifdef HAMMER_LOADS_MUJOCO
#include <mujoco/mujoco.h>
#endif

namespace hammer_loads {
namespace {

constexpr std::size_t kStates = 360;
using Complex = std::complex<double>;

/// Times a computation over all states and compares it with the reference's results.
template <typename State, typename Result>
void add(const std::string& name, const std::vector<State>& states, const std::function<Result(const State&)>& load,
         const std::function<Result(const State&)>& reference) {
  double size = 0.0, difference = 0.0;
  for (const State& state : states) {
    const Result expected = reference(state);
    size = std::max(size, expected.cwiseAbs().maxCoeff());
    difference = std::max(difference, (load(state) - expected).cwiseAbs().maxCoeff());
  }
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& run) {
    for (auto _ : run)
      for (const State& state : states) benchmark::DoNotOptimize(load(state));
    run.SetItemsProcessed(static_cast<std::int64_t>(states.size()) * run.iterations());
    run.counters["difference"] = difference / size;
  });
}

struct CrankState {
  double angle, speed, acceleration;  ///< [rad], [rad/s], [rad/s2]
};

/// Angles of rod and rocker by the law of cosines and derivatives from the closed loop, as a user of a general library
/// computes them. The crank lies between 0 and 2 pi, not at the blow.
struct Closure {
  Closure(const LinkLengths& l, const CrankState& crank) {
    const Complex b = std::polar(l.crank, crank.angle), from_d = b - l.pivot_distance;
    const double distance = std::abs(from_d);
    const double at_d =
        std::acos((distance * distance + l.rocker * l.rocker - l.rod * l.rod) / (2.0 * distance * l.rocker));
    psi = std::arg(from_d) - at_d;
    const Complex rocker = std::polar(l.rocker, psi), rod = l.pivot_distance + rocker - b, i(0.0, 1.0);
    beta = std::arg(rod);
    // b + rod = d + rocker, differentiated once and twice: two equations for the two rates.
    const auto solve = [&](Complex right) {
      const double determinant = std::imag(std::conj(rod) * rocker);
      return std::pair{std::imag(std::conj(rocker) * right) / determinant,
                       std::imag(std::conj(rod) * right) / determinant};
    };
    std::tie(beta_rate, psi_rate) = solve(-i * (i * crank.speed * b));
    const Complex right = (i * crank.acceleration - crank.speed * crank.speed) * b - beta_rate * beta_rate * rod +
                          psi_rate * psi_rate * rocker;
    std::tie(beta_accel, psi_accel) = solve(-i * right);
  }
  double beta, psi, beta_rate, psi_rate, beta_accel, psi_accel;
};

/// Returns the load on the hull with the moment about D from the base's reactions in the mechanism's frame.
Eigen::Vector3d seenFromHull(const Mechanism& mechanism, const Eigen::Vector3d& base) {
  const Complex turned = Complex(base[0], base[1]) * Complex(mechanism.cosComAngle(), -mechanism.sinComAngle());
  return {turned.real(), -turned.imag(), -base[2]};
}

/// Inverse dynamics of one chain without gravity.
class KdlDynamics {
 public:
  explicit KdlDynamics(const KDL::Chain& chain, const KDL::Vector& gravity = KDL::Vector::Zero())
      : chain_(chain), solver_(chain_, gravity), external_(chain.getNrOfSegments(), KDL::Wrench::Zero()) {
    for (KDL::JntArray* one : {&q, &rate, &acceleration, &torque_}) one->resize(chain.getNrOfJoints());
  }
  KdlDynamics(const KdlDynamics&) = delete;  // KDL's solver refers to its chain
  KdlDynamics& operator=(const KdlDynamics&) = delete;

  void setTipLoad(const KDL::Wrench& load) { external_.back() = load; }
  /// Returns the joint torques for the motion q, rate, acceleration.
  const Eigen::VectorXd& torques() {
    solver_.CartToJnt(q, rate, acceleration, external_, torque_);
    return torque_.data;
  }
  KDL::JntArray q, rate, acceleration;

 private:
  KDL::Chain chain_;
  KDL::ChainIdSolver_RNE solver_;
  KDL::Wrenches external_;
  KDL::JntArray torque_;
};

struct Link {
  double length, mass;
  Complex com;
  double inertia_about_com;
};

Link crankOf(const HammerParameters& p) {
  return {p.lengths.crank, p.crank_mass, {p.crank_com_along, p.crank_com_across}, p.crank_inertia_about_com};
}
Link rodOf(const HammerParameters& p) {
  return {p.lengths.rod, p.rod_mass, {p.rod_com_along, p.rod_com_across}, p.rod_inertia_about_com};
}
Link rockerOf(const HammerParameters& p) {
  return {p.lengths.rocker, p.rocker_mass, std::polar(p.rocker_com_distance, p.rocker_com_angle),
          p.rocker_inertia_about_pivot - p.rocker_mass * p.rocker_com_distance * p.rocker_com_distance};
}

/// Returns links that three joints hold from a base at D; the first link rotates about a pivot beside D [m].
KDL::Chain heldChain(double pivot, const std::vector<Link>& links) {
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::TransX)));
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::TransY)));
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame(KDL::Vector(pivot, 0.0, 0.0))));
  for (const Link& link : links) {
    const double inertia = link.inertia_about_com;
    chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame(KDL::Vector(link.length, 0.0, 0.0)),
                     KDL::RigidBodyInertia(link.mass, KDL::Vector(link.com.real() - link.length, link.com.imag(), 0.0),
                                           KDL::RotationalInertia(inertia, inertia, inertia))));
  }
  return chain;
}

/// Models crank and rod as one chain and the rocker as another, both from the held base. The forces of the base's
/// joints are the hull's load. No pin force is needed: KDL closes no loop, and internal forces cancel in the sum.
class KdlHammer {
 public:
  explicit KdlHammer(const Mechanism& mechanism)
      : mechanism_(mechanism),
        driven_(heldChain(-mechanism.parameters().lengths.pivot_distance,
                          {crankOf(mechanism.parameters()), rodOf(mechanism.parameters())})),
        rocker_(heldChain(0.0, {rockerOf(mechanism.parameters())})) {}

  Eigen::Vector3d operator()(const CrankState& crank) {
    const Closure c(mechanism_.parameters().lengths, crank);
    driven_.q.data << 0, 0, 0, crank.angle, c.beta - crank.angle;
    driven_.rate.data << 0, 0, 0, crank.speed, c.beta_rate - crank.speed;
    driven_.acceleration.data << 0, 0, 0, crank.acceleration, c.beta_accel - crank.acceleration;
    rocker_.q.data << 0, 0, 0, c.psi;
    rocker_.rate.data << 0, 0, 0, c.psi_rate;
    rocker_.acceleration.data << 0, 0, 0, c.psi_accel;
    const Eigen::Vector3d base = driven_.torques().head<3>() + rocker_.torques().head<3>();
    return seenFromHull(mechanism_, base);
  }

 private:
  Mechanism mechanism_;
  KdlDynamics driven_, rocker_;
};

struct BoomState {
  JointMotion motion;
  Wrench load;  ///< on the tip, in its axes
};

class KdlBoom {
 public:
  explicit KdlBoom(const Boom& boom) : dynamics_(boom.chain().kdl(), KDL::Vector(0.0, 0.0, -kStandardGravity)) {}
  Eigen::Vector4d operator()(const BoomState& state) {
    const auto vector = [](const Eigen::Vector3d& v) { return KDL::Vector(v.x(), v.y(), v.z()); };
    dynamics_.q.data = state.motion.position, dynamics_.rate.data = state.motion.velocity;
    dynamics_.acceleration.data = state.motion.acceleration;
    dynamics_.setTipLoad({vector(state.load.force), vector(state.load.torque)});
    return -dynamics_.torques();
  }

 private:
  KdlDynamics dynamics_;
};

#ifdef HAMMER_LOADS_MUJOCO
/// Model built from its text, with the memory of one evaluation.
class MujocoModel {
 public:
  explicit MujocoModel(const std::string& text) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(text.size()));
    std::copy(text.begin(), text.end(), static_cast<char*>(files->filedata[0]));
    char error[1000] = "";
    model_.reset(mj_loadXML("model.xml", files.get(), error, sizeof error));
    mj_deleteVFS(files.get());
    if (model_ == nullptr) throw std::runtime_error(error);
    data_.reset(mj_makeData(model_.get()));
  }
  Eigen::Map<Eigen::VectorXd> q() { return {data_->qpos, model_->nq}; }
  Eigen::Map<Eigen::VectorXd> rate() { return {data_->qvel, model_->nv}; }
  Eigen::Map<Eigen::VectorXd> acceleration() { return {data_->qacc, model_->nv}; }
  Eigen::Map<const Eigen::VectorXd> torques() {
    mj_inverse(model_.get(), data_.get());
    return {data_->qfrc_inverse, model_->nv};
  }
  /// Returns the joint torques of a load at a place on the last body, in its axes; call after torques().
  Eigen::VectorXd torquesOfTipLoad(const Eigen::Vector3d& place, const Wrench& load) {
    const int body = model_->nbody - 1;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data_->xmat + 9 * body);
    const Eigen::Vector3d force = R * load.force, torque = R * load.torque;
    const Eigen::Vector3d point = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body) + R * place;
    Eigen::VectorXd out = Eigen::VectorXd::Zero(model_->nv);
    mj_applyFT(model_.get(), data_.get(), force.data(), torque.data(), point.data(), body, out.data());
    return out;
  }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};

std::string textOfLink(double x, const Link& link) {
  std::ostringstream out;
  out.precision(17);
  out << "<body pos='" << x << " 0 0'><joint type='hinge' axis='0 0 1'/><inertial pos='" << link.com.real() << ' '
      << link.com.imag() << " 0' mass='" << link.mass << "' diaginertia='" << link.inertia_about_com << ' '
      << link.inertia_about_com << ' ' << link.inertia_about_com << "'/>";
  return out.str();
}

/// Returns the two chains of KdlHammer as one tree.
std::string textOfHammer(const HammerParameters& p) {
  return "<mujoco><compiler angle='radian' boundmass='1e-9' boundinertia='1e-12'/><option gravity='0 0 0'/><worldbody>"
         "<body><joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 1 0'/><joint type='hinge' axis='0 0 "
         "1'/>" +
         textOfLink(-p.lengths.pivot_distance, crankOf(p)) + textOfLink(p.lengths.crank, rodOf(p)) + "</body></body>" +
         textOfLink(0.0, rockerOf(p)) + "</body></body></worldbody></mujoco>";
}

class MujocoHammer {
 public:
  explicit MujocoHammer(const Mechanism& mechanism)
      : mechanism_(mechanism), model_(textOfHammer(mechanism.parameters())) {}
  Eigen::Vector3d operator()(const CrankState& crank) {
    const Closure c(mechanism_.parameters().lengths, crank);
    model_.q() << 0, 0, 0, crank.angle, c.beta - crank.angle, c.psi;
    model_.rate() << 0, 0, 0, crank.speed, c.beta_rate - crank.speed, c.psi_rate;
    model_.acceleration() << 0, 0, 0, crank.acceleration, c.beta_accel - crank.acceleration, c.psi_accel;
    return seenFromHull(mechanism_, model_.torques().head<3>());
  }

 private:
  Mechanism mechanism_;
  MujocoModel model_;
};

std::string textOf(const KDL::Vector& v) {
  std::ostringstream out;
  out.precision(17);
  out << v.x() << ' ' << v.y() << ' ' << v.z();
  return out.str();
}

/// Returns a chain as nested bodies at their joints; a segment's inertia is about its centre in its tip's axes.
std::string textOfChain(const KDL::Chain& chain) {
  std::ostringstream out;
  out.precision(17);
  out << "<mujoco><compiler angle='radian' boundmass='1e-9' boundinertia='1e-12'/><option gravity='0 0 "
      << -kStandardGravity << "'/><worldbody>";
  KDL::Frame at;
  for (const KDL::Segment& segment : chain.segments) {
    double x{}, y{}, z{}, w{};
    at.M.GetQuaternion(x, y, z, w);
    out << "<body pos='" << textOf(at.p) << "' quat='" << w << ' ' << x << ' ' << y << ' ' << z << "'>";
    const KDL::Joint& joint = segment.getJoint();
    if (joint.getType() != KDL::Joint::Fixed)
      out << "<joint type='hinge' axis='" << textOf(joint.JointAxis()) << "' pos='" << textOf(joint.JointOrigin())
          << "'/>";
    at = segment.getFrameToTip();
    KDL::RigidBodyInertia inertia = at * segment.getInertia();
    const KDL::Vector com = inertia.getCOG();
    const auto about_com = inertia.RefPoint(com).getRotationalInertia();
    out << "<inertial pos='" << textOf(com) << "' mass='" << inertia.getMass() << "' fullinertia='" << about_com.data[0]
        << ' ' << about_com.data[4] << ' ' << about_com.data[8] << ' ' << about_com.data[1] << ' ' << about_com.data[2]
        << ' ' << about_com.data[5] << "'/>";
  }
  for (unsigned i = 0; i < chain.getNrOfSegments(); ++i) out << "</body>";
  out << "</worldbody></mujoco>";
  return out.str();
}

class MujocoBoom {
 public:
  explicit MujocoBoom(const Boom& boom) : model_(textOfChain(boom.chain().kdl())) {
    const KDL::Frame tip = boom.chain().kdl().segments.back().getFrameToTip();
    place_ = {tip.p.x(), tip.p.y(), tip.p.z()};
  }
  Eigen::Vector4d operator()(const BoomState& state) {
    model_.q() = state.motion.position, model_.rate() = state.motion.velocity,
    model_.acceleration() = state.motion.acceleration;
    const Eigen::Vector4d torques = model_.torques();
    return model_.torquesOfTipLoad(place_, state.load) - torques;
  }

 private:
  MujocoModel model_;
  Eigen::Vector3d place_;
};
#endif

void addHammer(const Mechanism& mechanism) {
  std::vector<CrankState> states;
  for (std::size_t i = 0; i < kStates; ++i)
    states.push_back({kTwoPi * (static_cast<double>(i) + 0.5) / kStates, 31.416, 50.0});
  using Load = std::function<Eigen::Vector3d(const CrankState&)>;
  const Load ours = [model = HullModel(mechanism, Level::kLinkage)](const CrankState& crank) {
    return vectorOf(hullWrench(model, {CrankAngle::fromAngle(crank.angle), crank.speed, crank.acceleration}, {}));
  };
  add("load of the links on the hull/hammer_loads, level linkage", states, ours, ours);
  const auto kdl = std::make_shared<KdlHammer>(mechanism);
  add("load of the links on the hull/KDL", states, Load([kdl](const CrankState& crank) { return (*kdl)(crank); }),
      ours);
#ifdef HAMMER_LOADS_MUJOCO
  const auto mujoco = std::make_shared<MujocoHammer>(mechanism);
  add("load of the links on the hull/MuJoCo", states,
      Load([mujoco](const CrankState& crank) { return (*mujoco)(crank); }), ours);
#endif
}

void addBoom(const Boom& shipped) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double size) {
    return JointVector(JointVector::NullaryExpr(4, [&] { return size * unit(random); }));
  };
  const auto force = [&](double size) {
    return Eigen::Vector3d(Eigen::Vector3d::NullaryExpr([&] { return size * unit(random); }));
  };
  std::vector<BoomState> states;
  for (std::size_t i = 0; i < kStates; ++i)
    states.push_back({{vector(1.0), vector(1.0), vector(5.0)}, {force(5e4), force(5e3)}});
  using Load = std::function<Eigen::Vector4d(const BoomState&)>;
  const auto boom = std::make_shared<Boom>(shipped);
  const Load ours = [boom](const BoomState& state) {
    BoomLoads loads;
    boom->move(state.motion, {0.0, 0.0, -kStandardGravity});
    boom->loads(state.load, true, loads);
    return Eigen::Vector4d(loads.total);
  };
  add("torques of the boom's joints/hammer_loads, in four parts and with cylinders", states, ours, ours);
  const auto kdl = std::make_shared<KdlBoom>(shipped);
  add("torques of the boom's joints/KDL", states, Load([kdl](const BoomState& state) { return (*kdl)(state); }), ours);
#ifdef HAMMER_LOADS_MUJOCO
  const auto mujoco = std::make_shared<MujocoBoom>(shipped);
  add("torques of the boom's joints/MuJoCo", states,
      Load([mujoco](const BoomState& state) { return (*mujoco)(state); }), ours);
#endif
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  using namespace hammer_loads;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  const Settings settings = accuracy::shippedBoom("{}");
  addHammer(settings.mechanism);
  addBoom(*settings.boom);
  benchmark::RunSpecifiedBenchmarks();
}
