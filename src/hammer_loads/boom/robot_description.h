/// Robot description (URDF), read once; bounds of its text, checked before it is given to recursive parsers.
#pragma once

#include <cstddef>
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
  const urdf::ModelInterface* model() const noexcept { return model_.get(); }
  /// Problems, one line each: the reason for a null tree, or a link whose mass or inertia no body can have (negative,
  /// not finite, beyond every machine, or principal moments that violate the triangle inequality), or a joint whose
  /// place or axis is invalid.
  const std::vector<std::string>& problems() const noexcept { return problems_; }

 private:
  std::shared_ptr<const urdf::ModelInterface> model_;
  std::vector<std::string> problems_;
};

/// The bounds exceed any machine and are far below what exhausts a thread's stack.
struct UrdfLimits {
  static constexpr std::size_t kBytes = std::size_t{16} << 20;  ///< length of the text
  static constexpr int kDepth = 64;                             ///< tags within tags
  static constexpr int kLinks = 1000;                           ///< links of the robot
  static constexpr int kJoints = 1000;                          ///< joints of the robot
  // Limit: kBytes, kDepth, kLinks, kJoints
};

/// One line when the text passes a limit, naming it, or has a `<` within a tag, where parsers may disagree; else empty.
/// Does not judge anything else: a text that is no XML passes.
std::string urdfLimitPassed(const std::string& text);

}  // namespace hammer_loads
