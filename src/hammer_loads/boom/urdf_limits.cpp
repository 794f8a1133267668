#include "hammer_loads/boom/urdf_limits.h"

#include <algorithm>
#include <string_view>

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

}  // namespace hammer_loads
