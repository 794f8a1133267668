/// A robot description (URDF), read once.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace urdf {
class ModelInterface;
}

namespace hammer_loads {

/// Every complaint is in our own words, and none on the console. Copies share what was read.
class RobotDescription {
 public:
  RobotDescription() : RobotDescription(std::string()) {}
  RobotDescription(const std::string& text);
  RobotDescription(const char* text) : RobotDescription(std::string(text)) {}

  /// Null when the text is no URDF, passes a limit (UrdfLimits) or is no tree.
  const urdf::ModelInterface* model() const noexcept;
  /// One line each: why it is null, or a link whose mass or inertia no body can have (negative, not finite, beyond
  /// every machine, or principal moments that violate the triangle inequality), or a joint whose place or axis is none.
  const std::vector<std::string>& problems() const noexcept;

 private:
  struct Read;
  std::shared_ptr<const Read> read_;
};

}  // namespace hammer_loads
