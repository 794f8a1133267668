/// The shipped boom, random poses, and a hand-made planar chain with its description.
#pragma once

#include <array>
#include <complex>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/util/format.h"
#include "support/constants.h"

namespace hammer_loads::test {

inline const Eigen::Vector3d kLevel(0.0, 0.0, -kGravity);  ///< gravity on level ground [m/s2]
inline const JointVector kZero = JointVector::Zero(4);     ///< zeros for the shipped boom's joints

inline std::string sourceFile(const std::string& path) {
  return std::string(HAMMER_LOADS_TEST_DATA) + "/../../" + path;
}

inline std::string textOf(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::string shippedUrdf() { return textOf(sourceFile("urdf/eo2621_mo100.urdf")); }

/// Returns the text with its first `from` replaced. Throws if there is none.
inline std::string withFirstReplaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("no " + from);
  return text.replace(at, from.size(), to);
}

/// Makes a boom from its description and parameter files. Unknown keys are problems.
inline Checked<Boom> loadBoom(const std::string& urdf_text, const std::vector<std::string>& files) {
  Checked<Boom> result;
  ParameterMap parameters;
  addFiles(files, parameters, result.problems);
  if (!result.problems.empty()) return result;
  ParameterReader reader(std::move(parameters));
  const BoomParameters given = readBoomParameters(reader);
  reader.reportUnknownKeys();
  if (reader.problems().empty()) {
    result = Boom::make(urdf_text, given);
    for (const std::string& problem : result.problems) reader.addProblem(problem);
  }
  result.problems = reader.problems();
  return result;
}

inline BoomParameters shippedBoomParameters() {
  const std::string file = sourceFile("config/boom_eo2621.yaml");
  Checked<Boom> boom = loadBoom(shippedUrdf(), {file});
  if (!boom.value) throw std::runtime_error(boom.problems.front());
  return boom.value->parameters();
}

/// Returns the parameters of the shipped boom with a hammer cylinder that acts without a linkage.
inline BoomParameters directBoomParameters() {
  BoomParameters p = shippedBoomParameters();
  CylinderParameters& hammer = p.cylinders.back();
  hammer.linkage.reset();
  hammer.base_x = 0.50, hammer.base_z = 0.28, hammer.rod_x = 0.277, hammer.rod_z = 0.115;
  hammer.closed_length = 0.99, hammer.stroke = 0.53;
  return p;
}

inline Boom shippedBoom() {
  Checked<Boom> boom = Boom::make(shippedUrdf(), shippedBoomParameters());
  if (!boom.value) throw std::runtime_error(boom.problems.front());
  return std::move(*boom.value);
}

inline double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}

inline Eigen::Vector3d randomVector(std::mt19937& random, double size) {
  return {between(random, -size, size), between(random, -size, size), between(random, -size, size)};
}

inline Wrench randomWrench(std::mt19937& random) { return {randomVector(random, 5e4), randomVector(random, 1e4)}; }

/// Returns random joint angles within the limits and within +-3 rad.
inline JointVector randomPosition(const Chain& chain, std::mt19937& random) {
  JointVector q(chain.joints());
  for (int j = 0; j < chain.joints(); ++j) {
    q[j] = between(random, std::max(chain.lower()[j], -3.0), std::min(chain.upper()[j], 3.0));
  }
  return q;
}

inline JointVector joints(std::initializer_list<double> values) {
  JointVector q(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), q.data());
  return q;
}

/// Returns the angles of swing, boom, arm and hammer joint for a steep arm and a vertical hull [rad].
inline JointVector workingPosition() { return joints({0.2, -0.35, 1.20, -0.85}); }

/// Links in a vertical plane with joints about +y. Vectors are complex numbers x + i z: a rotation by q is e^(-iq).
/// The loads follow from the equations of Newton and Euler for each body, from the tip to the base.
template <std::size_t N>
struct PlanarChain {
  using Complex = std::complex<double>;
  struct Link {
    Complex to_next;   ///< next joint (tip for the last) from this link's joint, in its frame [m]
    Complex com;       ///< [m]
    double mass{};     ///< [kg]
    double inertia{};  ///< about the centre of mass, about y [kg m2]
  };
  std::array<Link, N> links;
  double gravity{9.80665};

  using Joints = std::array<double, N>;

  /// Returns the moment about +y of a force f at r.
  static double moment(Complex r, Complex f) { return r.imag() * f.real() - r.real() * f.imag(); }

  /// Returns the joint torques of all loads: minus those that the drives must give. The tip's load is in its axes.
  Joints loads(const Joints& q, const Joints& qd, const Joints& qdd, Complex tip_force, double tip_torque) const {
    const Complex i(0.0, 1.0);
    std::array<Complex, N> turn, acceleration;
    std::array<double, N> spin;
    Complex joint_acceleration = 0.0;
    double angle = 0.0, rate = 0.0, spin_rate = 0.0;
    for (std::size_t k = 0; k < N; ++k) {
      angle += q[k], rate += qd[k], spin_rate += qdd[k];
      turn[k] = std::exp(-i * angle);
      const Complex factor = -i * spin_rate - rate * rate;
      acceleration[k] = joint_acceleration + factor * turn[k] * links[k].com;
      joint_acceleration += factor * turn[k] * links[k].to_next;
      spin[k] = spin_rate;
    }
    Complex force = -tip_force * turn[N - 1];  // of link k on link k + 1
    double torque = -tip_torque;
    Joints result{};
    for (std::size_t k = N; k-- > 0;) {
      const Complex inertia_force = links[k].mass * (acceleration[k] + i * gravity);
      torque += moment(turn[k] * links[k].to_next, force) + moment(turn[k] * links[k].com, inertia_force) +
                links[k].inertia * spin[k];
      force += inertia_force;
      result[k] = -torque;
    }
    return result;
  }

  /// Returns the mass matrix. Column k is minus the loads of a unit acceleration of joint k, at rest without weight.
  Eigen::Matrix<double, N, N> massMatrix(const Joints& q) const {
    PlanarChain weightless = *this;
    weightless.gravity = 0.0;
    Eigen::Matrix<double, N, N> M;
    for (std::size_t k = 0; k < N; ++k) {
      Joints unit{};
      unit[k] = 1.0;
      const Joints column = weightless.loads(q, {}, unit, 0.0, 0.0);
      for (std::size_t r = 0; r < N; ++r) M(static_cast<int>(r), static_cast<int>(k)) = -column[r];
    }
    return M;
  }

  /// Returns the robot description with joints j0, j1, ... and the tip link `tip`.
  std::string urdf() const {
    std::string text = "<robot name=\"planar\"><link name=\"base_link\"/>";
    std::string parent = "base_link";
    Complex origin = 0.0;
    for (std::size_t k = 0; k <= N; ++k) {
      const bool tip = k == N;
      const std::string name = tip ? "tip" : format("link%zu", k);
      text += format(
          "<joint name=\"j%zu\" type=\"%s\"><parent link=\"%s\"/><child link=\"%s\"/>"
          "<origin xyz=\"%.17g 0 %.17g\"/><axis xyz=\"0 1 0\"/></joint>",
          k, tip ? "fixed" : "continuous", parent.c_str(), name.c_str(), origin.real(), origin.imag());
      text += "<link name=\"" + name + "\">";
      if (!tip) {
        text += format("<inertial><origin xyz=\"%.17g 0 %.17g\"/><mass value=\"%.17g\"/>", links[k].com.real(),
                       links[k].com.imag(), links[k].mass);
        text += format("<inertia ixx=\"%.17g\" ixy=\"0\" ixz=\"0\" iyy=\"%.17g\" iyz=\"0\" izz=\"%.17g\"/></inertial>",
                       links[k].inertia, links[k].inertia, links[k].inertia);
        origin = links[k].to_next;
      }
      text += "</link>";
      parent = name;
    }
    return text + "</robot>";
  }

  static PlanarChain random(std::mt19937& random) {
    const auto complex = [&] { return Complex(between(random, -1.5, 3.0), between(random, -1.0, 1.0)); };
    PlanarChain chain;
    for (Link& link : chain.links) {
      link = {complex(), complex(), between(random, 20.0, 500.0), between(random, 5.0, 300.0)};
    }
    return chain;
  }
};

}  // namespace hammer_loads::test
