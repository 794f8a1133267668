/// A hammer with what no level models: pins with clearance in a circle and with friction, a connecting rod that is a
/// free body and bends, a tool that is met late.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::test {

struct WornMachineSettings {
  HammerParameters hammer;
  double rod_stiffness{8e8}, damping_ratio{0.25};      ///< of rod and both pins [N/m]; at 200 Hz [-]
  double clearance{};                                  ///< of each pin of the rod, difference of diameters [m]
  double friction{}, pin_radius{0.022};                ///< coefficient in all four pins [-]; [m]
  double bow{}, bending_frequency{400.0};              ///< of the rod's middle off its line [m]; of its first mode [Hz]
  double restitution{0.14}, restitution_spread{0.03};  ///< of the tool, from blow to blow [-]
  double late{}, late_share{};                         ///< of the tool at most [m]; share of the revolutions [-]
  double duration{4.0}, step{1.2e-6};                  ///< [s]
  std::uint64_t seed{1};
};

/// Rigid crank and rocker; the rod a plane body with three degrees of freedom and a bending mode, whose pins are
/// springs with dampers, in a circle of clearance with an oil film; Coulomb friction by the pins' forces; a hydraulic
/// motor on a pump of constant flow; a tool as a spring that gives back a part of the energy. Cartesian coordinates and
/// forces alone, none of the package's equations. Runge-Kutta of order 4.
class WornMachine {
 public:
  struct Sample {
    double time{}, reading{};                 ///< [s], of an encoder of 4096 counts [rad]
    double force_x{}, force_z{}, torque_y{};  ///< by links and tool on the hull, the drive's reaction left out
    double since_touch{}, crank_speed{};      ///< [s], [rad/s]
  };
  struct Blow {
    double time{}, energy{};  ///< of the first touch [s], given to the tool [J]
  };

  explicit WornMachine(const WornMachineSettings& s) : s_(s), p_(s.hammer), random_(s.seed) {
    p_.lengths.rod = p_.lengths.pivot_distance + p_.lengths.rocker - p_.lengths.crank;
    spring_ = 2.0 * s.rod_stiffness;
    damper_ = 2.0 * (2.0 * s.damping_ratio * s.rod_stiffness / (kTwoPi * 200.0));
    ahead_ = std::polar(1.0, p_.rocker_com_angle);
    close();
    nextTool();
  }

  /// At 1 kHz, and the blows.
  std::pair<std::vector<Sample>, std::vector<Blow>> run() {
    std::vector<Sample> samples;
    std::vector<Blow> blows;
    double last = -1.0, due = 0.02;
    bool in_blow = false;
    const auto steps = static_cast<long>(s_.duration / s_.step);
    for (long n = 0; n < steps; ++n) {
      const double time = static_cast<double>(n) * s_.step;
      Forces forces;
      const State slope = rate(y_, &forces);
      crank_reaction_ = std::abs(forces.on_crank), rocker_reaction_ = std::abs(forces.on_rocker);
      if (forces.tool > 0.0) {
        if (!in_blow) blows.push_back({time, 0.0});
        in_blow = true, last = time;
        blows.back().energy -= forces.tool * p_.striking_distance * std::cos(y_[kPsi]) * y_[kPsiSpeed] * s_.step;
        deepest_ = std::max(deepest_, depth(std::polar(1.0, y_[kPsi])));
      } else if (in_blow && time - last > 0.012) {
        in_blow = false;
        nextTool();
      }
      if (time >= due) {
        const double count = kTwoPi / 4096.0;
        samples.push_back({time, std::floor(y_[kPhi] / count) * count, forces.hull.real(), forces.hull.imag(),
                           forces.torque, time - last, y_[kPhiSpeed]});
        due += 1e-3;
      }
      advance(slope);
    }
    return {samples, blows};
  }

 private:
  using C = std::complex<double>;
  enum {
    kPhi,
    kPhiSpeed,
    kPsi,
    kPsiSpeed,
    kX,
    kY,
    kBeta,
    kXSpeed,
    kYSpeed,
    kBetaSpeed,
    kBend,
    kBendSpeed,
    kPressure,
    kSize
  };
  using State = std::array<double, kSize>;
  struct Forces {
    C hull, on_crank, on_rocker;  ///< in hull axes x, z; in the mechanism's, by the hull
    double torque{}, tool{};
  };
  static constexpr C kI{0.0, 1.0};
  static double dot(C a, C b) { return a.real() * b.real() + a.imag() * b.imag(); }
  static double cross(C a, C b) { return a.real() * b.imag() - a.imag() * b.real(); }

  void close() {
    y_.fill(0.0);
    y_[kPhi] = 0.6;
    const C b = std::polar(p_.lengths.crank, y_[kPhi]), d = p_.lengths.pivot_distance;
    const double reach = std::abs(b - d), l3 = p_.lengths.rocker, l2 = p_.lengths.rod;
    const double inner = std::acos((l3 * l3 + reach * reach - l2 * l2) / (2.0 * l3 * reach));
    y_[kPsi] = std::arg(b - d) - inner;
    const C rod = d + std::polar(l3, y_[kPsi]) - b;
    y_[kBeta] = std::arg(rod);
    const C centre = b + C(p_.rod_com_along, p_.rod_com_across) * std::polar(1.0, y_[kBeta]);
    y_[kX] = centre.real(), y_[kY] = centre.imag();
  }
  void nextTool() {
    std::normal_distribution<> normal;
    std::uniform_real_distribution<> part;
    restitution_ = std::max(0.03, s_.restitution + s_.restitution_spread * normal(random_));
    place_ = part(random_) < s_.late_share ? s_.late * part(random_) : 0.0;
    deepest_ = 0.0;
  }
  double depth(C rocker) const { return -p_.striking_distance * rocker.imag() - place_; }
  /// Loaded along one line, unloaded along a steeper one.
  double toolForce(double depth) const {
    constexpr double kStiffness = 1e9;
    if (depth <= 0.0) return 0.0;
    if (depth >= deepest_) return kStiffness * depth;
    const double steep = kStiffness / (restitution_ * restitution_);
    return std::max(0.0, steep * (depth - deepest_) + kStiffness * deepest_);
  }
  /// On the rod's eye, by a pin that is so far from its middle.
  C pinForce(C from, C speed) const {
    if (!(s_.clearance > 0.0)) return spring_ * from + damper_ * speed;
    constexpr double kFilm = 1000.0, kGrows = 5e-6;  // [N s/m], [m]
    const double away = std::abs(from), pressed = away - 0.5 * s_.clearance;
    if (!(pressed > 0.0)) return kFilm * speed;
    const C normal = from / away;
    const double force = spring_ * pressed + damper_ * std::min(1.0, pressed / kGrows) * dot(speed, normal);
    return kFilm * speed + std::max(0.0, force) * normal;
  }
  double rub(double force, double turning) const {
    constexpr double kStick = 0.3;  // [rad/s]
    return s_.friction == 0.0 ? 0.0 : s_.friction * s_.pin_radius * force * std::tanh(turning / kStick);
  }

  State rate(const State& y, Forces* forces) const {
    constexpr double kG = 9.81, kMotor = 1.6e-5, kFlow = 3.6e-4, kOil = 1.3e-11, kLeak = 2e-12;
    const double l2 = p_.lengths.rod;
    const C crank = std::polar(1.0, y[kPhi]), rocker = std::polar(1.0, y[kPsi]), rod = std::polar(1.0, y[kBeta]);
    const C pin_b = p_.lengths.crank * crank, pin_c = p_.lengths.pivot_distance + p_.lengths.rocker * rocker;
    const C b_speed = kI * y[kPhiSpeed] * pin_b, c_speed = kI * y[kPsiSpeed] * p_.lengths.rocker * rocker;
    const C gravity = kG * C(ahead_.imag(), -ahead_.real());  // -z of the hull
    // A bowed rod is shorter the further it bends.
    const double by_bow = kPi * kPi / (2.0 * l2), bend = y[kBend];
    const double shorter = by_bow * (s_.bow * bend + 0.5 * bend * bend), slope = by_bow * (s_.bow + bend);
    const C eye_b = C(-p_.rod_com_along + 0.5 * shorter, -p_.rod_com_across) * rod;
    const C eye_c = C(l2 - p_.rod_com_along - 0.5 * shorter, -p_.rod_com_across) * rod;
    const C centre(y[kX], y[kY]), speed(y[kXSpeed], y[kYSpeed]);
    const C shortens = 0.5 * slope * y[kBendSpeed] * rod;
    const C force_b = pinForce(pin_b - centre - eye_b, b_speed - speed - kI * y[kBetaSpeed] * eye_b - shortens);
    const C force_c = pinForce(pin_c - centre - eye_c, c_speed - speed - kI * y[kBetaSpeed] * eye_c + shortens);
    const double rub_b = rub(std::abs(force_b), y[kBetaSpeed] - y[kPhiSpeed]);
    const double rub_c = rub(std::abs(force_c), y[kBetaSpeed] - y[kPsiSpeed]);
    const C rod_acceleration = (force_b + force_c) / p_.rod_mass + gravity;
    const double rod_turns = (cross(eye_b, force_b) + cross(eye_c, force_c) - rub_b - rub_c) / p_.rod_inertia_about_com;
    const double bends = kTwoPi * s_.bending_frequency, modal = 0.5 * p_.rod_mass;
    const double bending = s_.bow > 0.0 ? 0.5 * slope * dot(force_b - force_c, rod) / modal - bends * bends * bend -
                                              2.0 * 0.02 * bends * y[kBendSpeed]
                                        : 0.0;
    const C crank_centre = C(p_.crank_com_along, p_.crank_com_across) * crank;
    const double crank_inertia =
        p_.crank_inertia_about_com + p_.crank_mass * std::norm(crank_centre) + p_.drive_inertia;
    const double motor = kMotor * y[kPressure] - 0.3 * y[kPhiSpeed] - 4.0 * std::tanh(y[kPhiSpeed] / 0.2);
    const double crank_turns = (motor - cross(pin_b, force_b) + rub_b - rub(crank_reaction_, y[kPhiSpeed]) +
                                p_.crank_mass * cross(crank_centre, gravity)) /
                               crank_inertia;
    const C centre_of_rocker = p_.rocker_com_distance * rocker * ahead_;
    const double tool = toolForce(depth(rocker));
    const double rocker_turns =
        (-cross(p_.lengths.rocker * rocker, force_c) + rub_c - rub(rocker_reaction_, y[kPsiSpeed]) +
         p_.rocker_mass * cross(centre_of_rocker, gravity) + tool * p_.striking_distance * rocker.real()) /
        p_.rocker_inertia_about_pivot;
    const double flow =
        kFlow - kMotor * y[kPhiSpeed] - kLeak * y[kPressure] - 1e-10 * std::max(0.0, y[kPressure] - 2.2e7);
    if (forces != nullptr) {
      const C a1 = (kI * crank_turns - y[kPhiSpeed] * y[kPhiSpeed]) * crank_centre;
      const C a3 = (kI * rocker_turns - y[kPsiSpeed] * y[kPsiSpeed]) * centre_of_rocker;
      const C up = tool * C(-ahead_.imag(), ahead_.real()), d = p_.lengths.pivot_distance;
      const C by_links = p_.crank_mass * (gravity - a1) + p_.rod_mass * (gravity - rod_acceleration) +
                         p_.rocker_mass * (gravity - a3) + up;
      forces->hull = {-(ahead_.real() * by_links.real() + ahead_.imag() * by_links.imag()),
                      -ahead_.imag() * by_links.real() + ahead_.real() * by_links.imag()};
      const double about_centre =
          p_.rocker_inertia_about_pivot - p_.rocker_mass * p_.rocker_com_distance * p_.rocker_com_distance;
      forces->torque = -p_.crank_mass * cross(crank_centre - d, a1 - gravity) -
                       p_.crank_inertia_about_com * crank_turns -
                       p_.rod_mass * cross(centre - d, rod_acceleration - gravity) -
                       p_.rod_inertia_about_com * rod_turns - p_.rocker_mass * cross(centre_of_rocker, a3 - gravity) -
                       about_centre * rocker_turns + cross(p_.striking_distance * rocker * ahead_, up);
      forces->on_crank = p_.crank_mass * (a1 - gravity) + force_b;
      forces->on_rocker = p_.rocker_mass * (a3 - gravity) + force_c - up;
      forces->tool = tool;
    }
    return {y[kPhiSpeed],
            crank_turns,
            y[kPsiSpeed],
            rocker_turns,
            y[kXSpeed],
            y[kYSpeed],
            y[kBetaSpeed],
            rod_acceleration.real(),
            rod_acceleration.imag(),
            rod_turns,
            y[kBendSpeed],
            bending,
            y[kPressure] <= 0.0 && flow < 0.0 ? 0.0 : flow / kOil};
  }

  void advance(const State& first) {
    const double h = s_.step;
    const auto at = [&](const State& slope, double time) {
      State there;
      for (int i = 0; i < kSize; ++i) there[i] = y_[i] + time * slope[i];
      return rate(there, nullptr);
    };
    const State second = at(first, 0.5 * h), third = at(second, 0.5 * h), fourth = at(third, h);
    for (int i = 0; i < kSize; ++i) y_[i] += h / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]);
    y_[kPressure] = std::max(0.0, y_[kPressure]);
    if (!std::isfinite(y_[kPhi])) throw std::runtime_error("worn machine: the step is too long");
  }

  WornMachineSettings s_;
  HammerParameters p_;
  std::mt19937_64 random_;
  double spring_{}, damper_{};  ///< of a pin
  C ahead_;                     ///< direction of the rocker's centre of mass from its line of pins
  double restitution_{}, place_{}, deepest_{};
  double crank_reaction_{}, rocker_reaction_{};  ///< of the step before [N]
  State y_{};
};

}  // namespace hammer_loads::test
