/// Effect of errors of a hammer's constants on its loads.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/linkage/machine_columns.h"

namespace hammer_loads {

/// Models of the other hammers of MachineColumns; in their order.
class WrenchColumns {
 public:
  using Matrix = MachineColumns::Effect;  ///< rows: force_x [N], force_z [N], torque_y [N m]

  explicit WrenchColumns(const HullModel& model);
  WrenchColumns(const WrenchColumns&) = delete;
  WrenchColumns& operator=(const WrenchColumns&) = delete;

  bool isExact() const noexcept { return models_.empty(); }
  /// Change of the hull wrench at a given motion of the crank, by one standard deviation each; drive_inertia: Jc
  /// [kg m2]. No allocation.
  Matrix wrench(double drive_inertia, const LinksAtAngle& at, const CrankMotion& crank,
                const HullMotion& hull) const noexcept;
  /// Prepares wrench() for many calls, in some 2 ms.
  void tabulate();
  /// Sources in the columns' order, as MachineColumn::name.
  std::vector<std::string> names() const;
  /// Hammers in the columns' order, each a part `step` of its constant's deviation away (MachineColumn).
  const std::vector<HullModel>& models() const noexcept { return models_; }
  double step(std::size_t i) const noexcept { return columns_->columns()[i].step; }

 private:
  /// Wrench per square of the speed, per acceleration, per gravity along x and along z.
  using Table = ColumnTable<12>;

  Matrix evaluate(double drive_inertia, const LinksAtAngle& at, const CrankMotion& crank,
                  const HullMotion& hull) const noexcept;

  const HullModel* model_;
  std::shared_ptr<const MachineColumns> columns_;
  std::vector<HullModel> models_;
  std::optional<Table> table_;
};

}  // namespace hammer_loads
