/// Robot description (URDF), read once.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace urdf {
class ModelInterface;
}

namespace hammer_loads {

/// Text and tree of a URDF. All problems are reported here and none on the console. Copies share the tree.
class RobotDescription {
 public:
  RobotDescription() : RobotDescription(std::string()) {}
  RobotDescription(const std::string& text);
  RobotDescription(const char* text) : RobotDescription(std::string(text)) {}

  /// Tree of the URDF; null when the text is no URDF, passes a limit (UrdfLimits) or is no tree.
  const urdf::ModelInterface* model() const noexcept;
  /// Problems, one line each: the reason for a null tree, or a link whose mass or inertia no body can have (negative,
  /// not finite, beyond every machine, or principal moments that violate the triangle inequality), or a joint whose
  /// place or axis is invalid.
  const std::vector<std::string>& problems() const noexcept;

 private:
  struct Read;
  std::shared_ptr<const Read> read_;
};

}  // namespace hammer_loads
