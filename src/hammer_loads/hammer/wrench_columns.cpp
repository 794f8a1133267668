#include "hammer_loads/hammer/wrench_columns.h"

namespace hammer_loads {

WrenchColumns::WrenchColumns(const HullModel& model)
    : model_(&model), columns_(machineColumns(model.mechanism(), model.level())) {
  if (!columns_) return;
  for (const MachineColumn& column : columns_->columns()) models_.emplace_back(column.mechanism, column.level);
}

std::vector<std::string> WrenchColumns::names() const {
  std::vector<std::string> names;
  if (isExact()) return names;
  for (const MachineColumn& column : columns_->columns()) names.push_back(column.name);
  return names;
}

WrenchColumns::Matrix WrenchColumns::wrench(double drive_inertia, const LinksAtAngle& at, const CrankMotion& crank,
                                            const HullMotion& hull) const noexcept {
  Matrix columns = Matrix::Zero();
  const auto load = [&](const HullModel& model, const LinkMotion& links) {
    return vectorOf(hullWrench(model, driveReaction(model, drive_inertia), links, crank, hull));
  };
  if (isExact()) return columns;
  const Eigen::Vector3d here = load(*model_, at.links);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const MachineColumn& column = columns_->columns()[i];
    if (column.enters == HammerConstant::Enters::kBlow) continue;
    columns.col(static_cast<Eigen::Index>(i)) =
        (load(models_[i], column.linksAt(at.angle, at.links)) - here) / column.step;
  }
  return columns;
}

}  // namespace hammer_loads
