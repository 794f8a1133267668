#include "hammer_loads/boom/urdf_text.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// urdfdom reports through console_bridge; while this lives, its first error is kept instead of printed.
class FirstError : public console_bridge::OutputHandler {
 public:
  FirstError() { console_bridge::useOutputHandler(this); }
  ~FirstError() override { console_bridge::restorePreviousOutputHandler(); }
  FirstError(const FirstError&) = delete;
  FirstError& operator=(const FirstError&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override {
    if (text_.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) text_ = text;
  }
  [[nodiscard]] std::string oneLine() const {
    std::string line = text_.empty() ? "it is no URDF" : text_;
    for (char& letter : line) {
      if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
    }
    return line;
  }

 private:
  std::string text_;
};

void checkInertia(const urdf::Link& link, std::vector<std::string>& problems) {
  const urdf::Inertial& body = *link.inertial;
  if (!(body.mass >= 0.0) || !std::isfinite(body.mass)) {
    problems.push_back(
        format("robot_description: mass of link %s: %.9g kg, must be >= 0 and finite", link.name.c_str(), body.mass));
  }
  Eigen::Matrix3d inertia;
  inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz, body.izz;
  if (!inertia.allFinite()) {
    problems.push_back(format("robot_description: inertia of link %s: must be finite", link.name.c_str()));
    return;
  }
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  // Slack for figures given with few digits.
  const double slack = 1e-2 * std::abs(moments[2]);
  if (moments[0] < -1e-9 * std::abs(moments[2]) || moments[0] + moments[1] < moments[2] - slack) {
    problems.push_back(
        format("robot_description: inertia of link %s: principal moments %.6g, %.6g, %.6g kg m2, must "
               "be >= 0 and the largest at most the sum of the others",
               link.name.c_str(), moments[0], moments[1], moments[2]));
  }
}

}  // namespace

urdf::ModelInterfaceSharedPtr readUrdf(const std::string& text, std::vector<std::string>& problems) {
  urdf::ModelInterfaceSharedPtr model;
  {
    const FirstError error;
    model = urdf::parseURDF(text);
    if (!model) problems.push_back("robot_description: cannot be read: " + error.oneLine());
  }
  if (!model) return nullptr;
  for (const auto& [name, link] : model->links_) {
    if (link->inertial) checkInertia(*link, problems);
  }
  return model;
}

}  // namespace hammer_loads
