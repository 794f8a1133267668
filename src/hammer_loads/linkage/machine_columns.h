/// Errors of a hammer's constants, as hammers: the same with one constant a standard deviation off.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/linkage/shaft_load.h"

namespace hammer_loads {

/// Most columns of a machine; those that it does not have are zero.
constexpr int kMachineColumns = 20;

/// A column is the change of a load, a state or a number by one standard deviation of a constant: columns of one
/// hammer are independent, and the sum of their squares is a variance (JCGM 100, 5.1.2). The other hammer is a part
/// `step` of the deviation away, and what it changes counts 1/step times. Lengths keep the change point: the rod
/// follows.
struct MachineColumn {
  /// A rod whose centre of mass is half its length away bends an energy by a third of its slope; a tenth of that leaves
  /// a derivative, and 1e-14 of rounding.
  static constexpr double kStep = 0.1;

  Mechanism mechanism;  ///< of the other hammer
  Level level;          ///< as above: of what a level leaves out, that which has it
  HammerConstant::Enters enters;
  double step;       ///< kStep, or 1 of what a level leaves out
  std::string name;  ///< key of the constant, or the level that leaves something out

  /// links: of the hammer itself at the angle.
  LinkMotion linksAt(CrankAngle angle, const LinkMotion& links) const noexcept {
    return enters == HammerConstant::Enters::kMotion ? linkMotion(mechanism.linkage(), angle) : links;
  }
};

class MachineColumns {
 public:
  /// One standard deviation of each column on the shaft's load: of inertia, half its slope, torque.
  using OnShaft = Eigen::Matrix<double, 3, kMachineColumns>;

  MachineColumns(const Mechanism& mechanism, Level level);

  const std::vector<MachineColumn>& columns() const noexcept { return columns_; }
  /// load: at the angle, without what the hull's own motion adds.
  OnShaft onShaft(CrankAngle angle, Gravity gravity) const noexcept;

 private:
  Mechanism mechanism_;
  Level level_;
  std::vector<MachineColumn> columns_;
};

/// Whether a hammer can exist whose constant, of kHammerConstants, is off by its deviation.
bool isPossible(const HammerParameters& parameters, std::size_t constant);

/// Null: the hammer is exact, and its level has all of it.
std::shared_ptr<const MachineColumns> machineColumns(const Mechanism& mechanism, Level level);

}  // namespace hammer_loads
