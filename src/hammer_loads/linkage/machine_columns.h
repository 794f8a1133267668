/// Errors of a hammer's constants, represented by hammers with one constant changed by a standard deviation, and the
/// masses of the links as one vector: the loads of a given motion are linear in it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/util/by_constants.h"

namespace hammer_loads {

/// Masses, first moments and inertias of LinkMoments in this order; a complex one takes two numbers.
struct LinkMasses {
  enum Index {
    kMass,              ///< total mass of the links [kg]
    kAtA,               ///< mass of crank and connecting rod, concentrated at A [kg]
    kCrank,             ///< this and the next: C1 [kg m]
    kRod = 4,           ///< this and the next: C2 [kg m]
    kRocker = 6,        ///< C3 [kg m]
    kCrankInertia,      ///< J1 [kg m2]
    kRodInertia,        ///< J2 [kg m2]
    kRockerInertia,     ///< I [kg m2]
    kCoupling,          ///< this and the next: l1 m2 rho2 [kg m2]
    kWithinDrive = 12,  ///< crankWithinDrive() [kg m2]
    kSize
  };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Effect = Eigen::Matrix<double, 3, kSize>;  ///< derivatives of three loads

  /// Masses that a level gives its links.
  static Vector of(const Mechanism& mechanism, Level level) noexcept {
    const HammerParameters& p = mechanism.parameters();
    const LinkMoments& k = mechanism.moments();
    Vector masses = Vector::Zero();
    masses[kMass] = p.rocker_mass;
    masses[kRocker] = k.rocker;
    masses[kRockerInertia] = p.rocker_inertia_about_pivot;
    masses[kWithinDrive] = crankWithinDrive(mechanism, level);
    if (level != Level::kLinkage) return masses;
    masses.head<6>() << k.mass, p.crank_mass + p.rod_mass, k.crank.re, k.crank.im, k.rod.re, k.rod.im;
    masses[kCrankInertia] = k.crank_inertia, masses[kRodInertia] = k.rod_inertia;
    masses[kCoupling] = k.coupling.re, masses[kCoupling + 1] = k.coupling.im;
    return masses;
  }
};

/// Returns true if two hammers differ by their masses alone.
inline bool haveLikeMotion(const Mechanism& a, const Mechanism& b) noexcept {
  const auto place = [](const Mechanism& m) {
    const LinkLengths& l = m.parameters().lengths;
    return std::tuple(l.crank, l.rocker, l.pivot_distance, m.parameters().rocker_com_angle,
                      m.parameters().drive_reaction_ratio);
  };
  return place(a) == place(b);
}

/// Largest number of columns of a machine; missing ones are zero.
constexpr int kMachineColumns = 20;

/// A column is the change of a load, a state or a number by one standard deviation of a constant: columns of one hammer
/// are independent, and the sum of their squares is a variance (JCGM 100, 5.1.2). The other hammer is off by a part
/// `step` of the standard deviation, and its effect is divided by step. The rod's length follows changed lengths, so
/// that the change point is kept.
struct MachineColumn {
  /// A rod whose centre of mass is off by half its length changes an energy nonlinearly, by a third of the slope. A
  /// tenth of that change leaves a derivative, and 1e-14 of rounding.
  static constexpr double kStep = 0.1;

  Mechanism mechanism;  ///< hammer with the changed constant
  Level level;          ///< level of that hammer; kLinkage for the column of what a simpler level neglects
  HammerConstant::Enters enters;
  double step;       ///< kStep; 1 for the column of what a level neglects
  std::string name;  ///< key of the constant, or the level that leaves something out
  bool of_masses;    ///< true if the change of the loads of a given motion is linear in LinkMasses

  /// Returns the links at the angle. links: those of the unchanged hammer.
  LinkMotion linksAt(CrankAngle angle, const LinkMotion& links) const noexcept {
    return enters == HammerConstant::Enters::kMotion ? linkMotion(mechanism.linkage(), angle) : links;
  }
};

/// Columns over a revolution, linear between points some 0.7 deg apart: within a hundredth of each column's largest
/// value (test), at a third of the time or less.
template <int rows>
class ColumnTable {
 public:
  using Point = ByConstants<rows, kMachineColumns>;

  /// at(angle): columns at an angle.
  template <typename At>
  explicit ColumnTable(const At& at) {
    for (int i = -kBeyond; i <= kPoints; ++i) {
      before_.push_back(at(CrankAngle{-kWidth * i, Side::kBeforeBlow}));
      after_.push_back(at(CrankAngle{kWidth * i, Side::kAfterBlow}));
    }
  }
  /// Returns false for an angle of the mirrored branch that is further beyond the blow.
  static bool covers(CrankAngle angle) noexcept { return fromBlow(angle) >= -kBeyond; }
  /// Returns the columns at a covered angle. It extrapolates beyond half a revolution; a NaN angle gives NaN.
  Point at(CrankAngle angle) const noexcept {
    const double place = fromBlow(angle) + kBeyond;
    const int i = static_cast<int>(std::min(kBeyond + kPoints - 1.0, place));  // the last where it is not a number
    const Point* from = (angle.side == Side::kBeforeBlow ? before_ : after_).data() + i;
    return from[0] + static_cast<float>(place - i) * (from[1] - from[0]);
  }

 private:
  static constexpr int kPoints = 256;          ///< parts of half a revolution
  static constexpr int kBeyond = kPoints / 2;  ///< points on the mirrored branch
  static constexpr double kWidth = 0.5 * kTwoPi / kPoints;
  static double fromBlow(CrankAngle angle) noexcept {
    return (angle.side == Side::kBeforeBlow ? -angle.offset : angle.offset) / kWidth;
  }
  std::vector<Point> before_, after_;  ///< from the mirrored branch through the blow on
};
/// Rows of MachineColumns::OnShaft, its weight for a gravity along x and along z.
using ShaftTable = ColumnTable<4>;

class MachineColumns {
 public:
  /// Effect of each column's standard deviation on three loads; on the shaft: inertia, half its slope, weight's torque.
  using Effect = ByConstants<3, kMachineColumns>;
  using OnShaft = Effect;

  MachineColumns(const Mechanism& mechanism, Level level);

  const std::vector<MachineColumn>& columns() const noexcept { return columns_; }
  /// Effects of the columns of masses on loads of a given motion; by: derivatives of these loads by LinkMasses.
  Effect byMasses(const LinkMasses::Effect& by) const noexcept {
    Effect effects = Effect::Zero();
    for (const Part& part : parts_) effects.col(part.column) += (part.size * by.col(part.mass)).cast<float>();
    return effects;
  }
  /// Hammer whose constants are off by this many standard deviations each, in the columns' order; empty if it cannot
  /// exist. The column of what a level neglects has no effect.
  std::optional<Mechanism> hammerOff(const Eigen::VectorXd& errors) const;
  /// Effects on the shaft's load at the angle, without the terms of the hull's own motion.
  OnShaft onShaft(CrankAngle angle, Gravity gravity) const noexcept;
  ShaftTable shaftTable() const;

 private:
  struct Part {  ///< change of one number of LinkMasses [its unit]
    Eigen::Index column, mass;
    double size;
  };
  void add(const Mechanism& other, Level level, HammerConstant::Enters enters, double step, const std::string& name);

  Mechanism mechanism_;
  Level level_;
  std::vector<MachineColumn> columns_;
  std::vector<Part> parts_;
};

/// MachineColumns::onShaft() from a table, which covers the angle.
inline MachineColumns::OnShaft onShaft(const ShaftTable& table, CrankAngle angle, Gravity gravity) noexcept {
  const ShaftTable::Point at = table.at(angle);
  MachineColumns::OnShaft columns = at.topRows<3>();
  columns.row(2) = static_cast<float>(gravity.x) * at.row(2) + static_cast<float>(gravity.z) * at.row(3);
  return columns;
}

/// Returns true if a hammer can exist whose constant (index in kHammerConstants) is off by one standard deviation.
bool isPossible(const HammerParameters& parameters, std::size_t constant);

/// Null if the hammer is exact and its level neglects nothing.
std::shared_ptr<const MachineColumns> machineColumns(const Mechanism& mechanism, Level level);

}  // namespace hammer_loads
