/// Robot descriptions and boom parameters that cannot be.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "boom/booms.h"

namespace hammer_loads::test {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  if (text.find(from) == std::string::npos) throw std::runtime_error("no " + from);
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

struct BadBoom {
  std::string what, urdf;
  std::string key, value;  ///< in place of that in config/boom_eo2621.yaml; empty: all as there
  std::string named;       ///< in the one line that refuses it
};

inline std::vector<BadBoom> badBooms() {
  const std::string good = shippedUrdf();
  return {
      {"no XML", "<robot name=\"cut\"><link", "", "", "robot_description: cannot be read"},
      {"no robot", "<machine/>", "", "", "robot_description: cannot be read"},
      {"missing link", replaced(good, "\"hammer_hull\"", "\"hull\""), "", "", "link hammer_hull: not in the model"},
      {"negative mass", replaced(good, "<mass value=\"230\"/>", "<mass value=\"-230\"/>"), "", "",
       "mass of link arm_link: -230 kg, must be"},
      {"joint not in the chain", good, "hammer_cylinder_joint", "hammer_crank_joint", "hammer_crank_joint"},
      {"cylinder that cannot close", good, "boom_cylinder_closed_length_m", "1.3", "boom_cylinder"},
  };
}

}  // namespace hammer_loads::test
