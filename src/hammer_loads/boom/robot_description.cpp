#include "hammer_loads/boom/robot_description.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <exception>
#include <set>
#include <string_view>

#include "hammer_loads/boom/figure_limits.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// One thing in angle brackets.
struct Tag {
  enum class Kind { kOpen, kClose, kEmpty, kOther, kBad };
  Kind kind{Kind::kOther};
  std::string_view name;
  std::size_t end{};  ///< behind it
};

bool startsName(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') || byte == '_' || byte >= 127;
}

/// Behind the next `closing`, or the text's end.
std::size_t behind(std::string_view text, std::string_view closing, std::size_t from) {
  const std::size_t found = text.find(closing, from);
  return found == std::string_view::npos ? text.size() : found + closing.size();
}

/// The `>` that ends a tag, outside quotes; npos when a `<` comes first or the text ends.
std::size_t endOfTag(std::string_view text, std::size_t from) {
  char quote = '\0';
  for (std::size_t i = from; i < text.size(); ++i) {
    const char letter = text[i];
    if (letter == '<') return std::string_view::npos;
    if (quote != '\0') {
      if (letter == quote) quote = '\0';
    } else if (letter == '"' || letter == '\'') {
      quote = letter;
    } else if (letter == '>') {
      return i;
    }
  }
  return std::string_view::npos;
}

/// The tag that begins at a `<`.
Tag tagAt(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  if (rest.substr(0, 4) == "<!--") return {Tag::Kind::kOther, {}, behind(text, "-->", at + 4)};
  if (rest.substr(0, 9) == "<![CDATA[") return {Tag::Kind::kOther, {}, behind(text, "]]>", at + 9)};
  const std::size_t end = endOfTag(text, at + 1);
  if (end == std::string_view::npos) return {Tag::Kind::kBad, {}, text.size()};
  if (rest.size() > 1 && rest[1] == '/') return {Tag::Kind::kClose, {}, end + 1};
  if (rest.size() < 2 || !startsName(rest[1])) return {Tag::Kind::kOther, {}, end + 1};
  const std::size_t name_end = std::min(end, text.find_first_of(" \t\r\n\v\f/>=\"'", at));
  const Tag::Kind kind = text[end - 1] == '/' ? Tag::Kind::kEmpty : Tag::Kind::kOpen;
  return {kind, text.substr(at + 1, name_end - at - 1), end + 1};
}

std::string passed(const char* what, int limit) {
  return format("robot_description: more than %d %s, must be at most %d", limit, what, limit);
}

/// urdfdom reports through console_bridge; while this lives, its errors are kept instead of printed.
class Errors : public console_bridge::OutputHandler {
 public:
  Errors() { console_bridge::useOutputHandler(this); }
  ~Errors() override { console_bridge::restorePreviousOutputHandler(); }
  Errors(const Errors&) = delete;
  Errors& operator=(const Errors&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR || lines_.size() == kMost) return;
    lines_.push_back(text);
    for (char& letter : lines_.back()) {
      if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
    }
  }
  [[nodiscard]] std::string first() const { return lines_.empty() ? "it is no URDF" : lines_.front(); }
  /// The parser goes on with mass 0 where it cannot read a link's inertia: cause, then the link, in two reports.
  void addUnreadInertias(std::vector<std::string>& problems) const {
    for (std::size_t i = 1; i < lines_.size(); ++i) {
      if (lines_[i].find("parse inertial element") == std::string::npos) continue;
      problems.push_back("robot_description: " + lines_[i] + ": " + lines_[i - 1]);
    }
  }

 private:
  static constexpr std::size_t kMost = 1000;
  // Numerical: kMost
  std::vector<std::string> lines_;
};

/// Beyond these no figure of a machine lies, and no product of figures overflows.
constexpr double kMostOffset = 1e6;    // [m]
constexpr double kMostInertia = 1e18;  // [kg m2]
// Limit: kMostOffset, kMostInertia

bool within(double value, double most) { return std::abs(value) <= most; }  // false for NaN

bool within(const urdf::Vector3& p, double most) { return within(p.x, most) && within(p.y, most) && within(p.z, most); }

void checkInertia(const urdf::Link& link, std::vector<std::string>& problems) {
  const urdf::Inertial& body = *link.inertial;
  const char* name = link.name.c_str();
  checkRange("robot_description: mass of link " + link.name, body.mass, "kg", 0.0, figure::kMostMass, problems);
  if (!within(body.origin.position, kMostOffset)) {
    problems.push_back(
        format("robot_description: centre of mass of link %s: must be within %.0e m", name, kMostOffset));
  }
  Eigen::Matrix3d inertia;
  inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz, body.izz;
  if (!inertia.allFinite() || inertia.cwiseAbs().maxCoeff() > kMostInertia) {
    problems.push_back(
        format("robot_description: inertia of link %s: must be finite and at most %.0e kg m2", name, kMostInertia));
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
               name, moments[0], moments[1], moments[2]));
  }
}

void checkJoint(const urdf::Joint& joint, std::vector<std::string>& problems) {
  const char* name = joint.name.c_str();
  if (!within(joint.parent_to_joint_origin_transform.position, kMostOffset)) {
    problems.push_back(format("robot_description: origin of joint %s: must be within %.0e m", name, kMostOffset));
  }
  const urdf::Vector3& a = joint.axis;
  const double length = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
  const bool turns = joint.type != urdf::Joint::FIXED && joint.type != urdf::Joint::FLOATING;
  if (turns && !(length > 1e-6 && length < 1e6)) {
    problems.push_back(
        format("robot_description: axis of joint %s: length %.6g, must be from 1e-6 to 1e6", name, length));
  }
}

/// Refuses loops, in which a parser that walks from link to link would not end.
void checkIsTree(const urdf::ModelInterface& model, std::vector<std::string>& problems) {
  std::set<std::string> children;
  for (const auto& [name, joint] : model.joints_) {
    if (!children.insert(joint->child_link_name).second) {
      problems.push_back(format("robot_description: link %s: child of more than one joint, must be of one",
                                joint->child_link_name.c_str()));
    }
  }
  if (children.size() != model.joints_.size()) return;
  for (const auto& [name, link] : model.links_) {
    urdf::LinkConstSharedPtr before = link;
    std::size_t steps = 0;
    while (before && before->parent_joint && steps <= model.links_.size()) before = before->getParent(), ++steps;
    if (steps <= model.links_.size()) continue;
    problems.push_back(format("robot_description: link %s: hangs on itself, must hang on the root", name.c_str()));
    return;
  }
}

/// Breaks cyclic references, which would keep the links alive.
void release(const urdf::ModelInterface& model) {
  for (const auto& [name, link] : model.links_) link->child_links.clear();
}

urdf::ModelInterfaceSharedPtr parsed(const std::string& text, std::vector<std::string>& problems) {
  const std::string passed = urdfLimitPassed(text);
  if (!passed.empty()) {
    problems.push_back(passed);
    return nullptr;
  }
  const Errors errors;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& exception) {  // of numbers, in some versions of the parser
    problems.push_back(std::string("robot_description: cannot be read: ") + exception.what());
    return nullptr;
  }
  if (!model) problems.push_back("robot_description: cannot be read: " + errors.first());
  if (model) errors.addUnreadInertias(problems);
  return model;
}

}  // namespace

std::string urdfLimitPassed(const std::string& text) {
  if (text.size() > UrdfLimits::kBytes) {
    return format("robot_description: %zu bytes, must be at most %zu", text.size(), UrdfLimits::kBytes);
  }
  int depth = 0, links = 0, joints = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos;) {
    const Tag tag = tagAt(text, at);
    if (tag.kind == Tag::Kind::kBad) return "robot_description: cannot be read: a tag that does not end";
    // Closing what is not open changes nothing.
    if (tag.kind == Tag::Kind::kClose) depth = std::max(0, depth - 1);
    if (tag.kind == Tag::Kind::kOpen || tag.kind == Tag::Kind::kEmpty) {
      if (depth >= UrdfLimits::kDepth) return passed("tags within tags", UrdfLimits::kDepth);
      // Tags at other depths belong to a transmission or a sensor.
      if (depth == 1 && tag.name == "link" && ++links > UrdfLimits::kLinks) return passed("links", UrdfLimits::kLinks);
      if (depth == 1 && tag.name == "joint" && ++joints > UrdfLimits::kJoints) {
        return passed("joints", UrdfLimits::kJoints);
      }
    }
    if (tag.kind == Tag::Kind::kOpen) ++depth;
    at = text.find('<', tag.end);
  }
  return {};
}

RobotDescription::RobotDescription(const std::string& text) {
  const urdf::ModelInterfaceSharedPtr model = parsed(text, problems_);
  if (!model) return;
  const std::size_t before = problems_.size();
  checkIsTree(*model, problems_);
  if (problems_.size() != before) {
    release(*model);
    return;
  }
  for (const auto& [name, link] : model->links_) {
    if (link->inertial) checkInertia(*link, problems_);
  }
  for (const auto& [name, joint] : model->joints_) checkJoint(*joint, problems_);
  model_ = model;
}

}  // namespace hammer_loads
