/// Units of load channels and of figures of a run.
#pragma once

#include <string>

namespace hammer_loads::life {

/// Unit of topic/field, topic/name/field or stress/NAME by the comment of the message's field; "-" for no unit and for
/// an unknown name.
inline std::string unitOf(const std::string& channel) {
  if (channel.find("stress/") != std::string::npos) return "MPa";
  const std::string field = channel.substr(channel.rfind('/') + 1);
  const auto has = [&](const char* word) { return field.find(word) != std::string::npos; };
  if (has("impulse")) return "N s";
  if (has("force") || has("amplitude")) return "N";
  if (has("torque")) return "N m";
  return has("energy") ? "J" : "-";
}

}  // namespace hammer_loads::life
