/// Reference machine with a vibrating boom: own mass matrix, stiffness from the cylinders' triangles by differences,
/// Rayleigh damping, integration in small steps. Shares no code with src/hammer_loads/boom.
#pragma once

#include <Eigen/Eigenvalues>

#include "boom/booms.h"
#include "boom/linkage_reference.h"

namespace hammer_loads::test {

constexpr double kMillisecond = 1e-3;
constexpr double kStandardGravity = 9.80665, kHalfTurn = 3.14159265358979323846;

/// Returns boom, arm, and bracket with hull, with the figures of urdf/eo2621_mo100.urdf entered by hand.
inline PlanarChain<3> planarEo2621() {
  PlanarChain<3> planar;
  planar.links[0] = {{2.60, 0.0}, {1.20, 0.08}, 400.0, 229.4};
  planar.links[1] = {{1.70, 0.0}, {0.70, 0.06}, 230.0, 86.03};
  const std::complex<double> bracket(0.03, -0.06), hull(0.10 - 0.08, -0.55 + 0.05);
  const std::complex<double> com = (50.0 * bracket + 350.0 * hull) / 400.0;
  planar.links[2] = {
      {0.10, -0.55}, com, 400.0, 1.104 + 29.9 + 50.0 * std::norm(bracket - com) + 350.0 * std::norm(hull - com)};
  return planar;
}

struct PlanarModes {
  Eigen::Vector3d omega;  ///< ascending [rad/s]
  Eigen::Matrix3d shape;  ///< shape^T M shape = 1
};

/// Returns the modes x of springs K on the joints and mass matrix M. K^-1/2 M K^-1/2 has the eigenvectors K^1/2 x.
inline PlanarModes planarModes(const Eigen::Vector3d& K, const Eigen::Matrix3d& M) {
  const Eigen::Vector3d soft = K.cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(soft.asDiagonal() * M * soft.asDiagonal());
  PlanarModes modes;
  for (int k = 0; k < 3; ++k) {
    modes.omega[k] = 1.0 / std::sqrt(solver.eigenvalues()[2 - k]);
    modes.shape.col(k) = modes.omega[k] * soft.cwiseProduct(solver.eigenvectors().col(2 - k));
  }
  return modes;
}

/// True machine with its own bulk modulus and damping.
class VibratingMachine {
 public:
  VibratingMachine(const BoomParameters& parameters, double bulk_modulus, unsigned seed)
      : planar_(planarEo2621()), random_(seed) {
    planar_.gravity = 0.0;
    M_ = planar_.massMatrix(pose_);
    for (std::size_t i = 0; i < 3; ++i) K_[static_cast<int>(i)] = stiffness(parameters.cylinders[i], i, bulk_modulus);
    inverse_ = M_.inverse();
    omega = planarModes(K_, M_).omega;
    // Rayleigh damping: 7 % at the first mode, growing with frequency at the others.
    const double beta = 2.0 * 0.045 / omega[0], alpha = 2.0 * 0.025 * omega[0];
    C_ = alpha * M_ + beta * K_.asDiagonal().toDenseMatrix();
    zeta = 0.5 * (alpha * omega.cwiseInverse() + beta * omega);
  }

  /// Advances by one millisecond under a linear load.
  void step(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    constexpr int kSub = 20;
    const double h = kMillisecond / kSub;
    for (int i = 0; i < kSub; ++i) {
      const auto load = [&](double part) -> Eigen::Vector3d { return from + (i + part) / kSub * (to - from); };
      const auto rate = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& v, double part) {
        return accelerationOf(x, v, load(part));
      };
      const Eigen::Vector3d a1 = rate(x_, v_, 0.0), v2 = v_ + h / 2 * a1;
      const Eigen::Vector3d a2 = rate(x_ + h / 2 * v_, v2, 0.5), v3 = v_ + h / 2 * a2;
      const Eigen::Vector3d a3 = rate(x_ + h / 2 * v2, v3, 0.5), v4 = v_ + h * a3;
      const Eigen::Vector3d a4 = rate(x_ + h * v3, v4, 1.0);
      x_ += h / 6 * (v_ + 2 * v2 + 2 * v3 + v4);
      v_ += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    load_ = to;
  }
  Eigen::Vector3d load(const Wrench& w) const {
    const auto Q = planar_.loads(pose_, {}, {}, {w.force.x(), w.force.z()}, w.torque.y());
    return Eigen::Vector3d(Q.data());
  }
  Eigen::Vector3d acceleration() const { return accelerationOf(x_, v_, load_); }
  const Eigen::Vector3d& displacement() const { return x_; }
  Eigen::Vector3d hold() const { return K_.cwiseProduct(x_) + C_ * v_; }  ///< what the cylinders carry

  /// Returns the readings of an IMU at the hull's frame: specific force along x and z [m/s2], rate about y [rad/s].
  Eigen::Vector3d imu(double accelerometer_noise, double gyro_noise) {
    const Eigen::Vector3d a = acceleration();
    const std::complex<double> i(0.0, 1.0);
    std::complex<double> point = 0.0, linear = 0.0, turn = 1.0;
    double angle = 0.0, rate = 0.0, spin = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int n = static_cast<int>(k);
      angle += pose_[k] + x_[n], rate += v_[n], spin += a[n];
      turn = std::exp(-i * angle);
      linear += (-i * spin - rate * rate) * turn * planar_.links[k].to_next;
      point += turn * planar_.links[k].to_next;
    }
    const std::complex<double> felt = (linear + i * kStandardGravity) / turn;
    return {felt.real() + 0.15 + noise(accelerometer_noise), felt.imag() - 0.1 + noise(accelerometer_noise),
            rate + 0.004 + noise(gyro_noise)};
  }
  double noise(double size) { return size * std::normal_distribution<>()(random_); }

  Eigen::Vector3d omega, zeta;
  static constexpr std::array<double, 3> pose_{-0.35, 1.20, -0.85};

 private:
  Eigen::Vector3d accelerationOf(const Eigen::Vector3d& x, const Eigen::Vector3d& v,
                                 const Eigen::Vector3d& load) const {
    return inverse_ * (load - C_ * v - K_.cwiseProduct(x));
  }
  /// Returns a joint's stiffness by the oil of both chambers at the arm of the triangle or the linkage [N m/rad].
  static double stiffness(const CylinderParameters& p, std::size_t joint, double bulk_modulus) {
    constexpr std::array<std::complex<double>, 3> kPivot{
        std::complex<double>(0.25, 0.40), std::complex<double>(2.60, 0.0), std::complex<double>(1.70, 0.0)};
    const auto length = [&](double q) {
      if (p.linkage) {
        BucketLinkageParameters lengths = *p.linkage;
        lengths.branch = -1.0;
        const Eigen::Vector2d pivot(kPivot[joint].real(), kPivot[joint].imag());
        const BucketLinkage::Pins pins{Eigen::Vector2d(p.base_x, p.base_z) - pivot,
                                       Eigen::Vector2d(lengths.guide_x, lengths.guide_z) - pivot,
                                       {p.rod_x, p.rod_z}};
        return static_cast<double>(LinkageReference(pins, lengths).length(q));
      }
      return std::abs(kPivot[joint] + std::exp(std::complex<double>(0.0, -q)) * std::complex<double>(p.rod_x, p.rod_z) -
                      std::complex<double>(p.base_x, p.base_z));
    };
    const double q = pose_[joint], arm = (length(q + 1e-5) - length(q - 1e-5)) / 2e-5;
    const double bore = kHalfTurn / 4 * p.bore * p.bore, rod = bore - kHalfTurn / 4 * p.rod_diameter * p.rod_diameter;
    const double out = length(q) - p.closed_length;
    return bulk_modulus * arm * arm *
           (bore * bore / (p.bore_hose_volume + bore * out) + rod * rod / (p.rod_hose_volume + rod * (p.stroke - out)));
  }

  PlanarChain<3> planar_;
  std::mt19937 random_;
  Eigen::Matrix3d M_, C_, inverse_;  // inverse_: of M_
  Eigen::Vector3d K_, x_ = Eigen::Vector3d::Zero(), v_ = Eigen::Vector3d::Zero(), load_ = Eigen::Vector3d::Zero();
};

/// Half-sine pulses of 18 ms on the hull, 4.7 per second at slightly uneven intervals.
class PulsingHammer {
 public:
  Wrench at(double time) {
    while (time > next_) {
      start_ = next_;
      next_ += 0.2128 + 0.004 * std::sin(3.7 * next_);
    }
    const double phase = (time - start_) / 0.018;
    const double pulse = phase > 0.0 && phase < 1.0 ? 8e3 * std::sin(kHalfTurn * phase) : 0.0;
    return {Eigen::Vector3d(0.3 * pulse, 0.0, pulse), Eigen::Vector3d(0.0, -0.12 * pulse, 0.0)};
  }

 private:
  double start_ = -1.0, next_ = 0.1;
};

}  // namespace hammer_loads::test
