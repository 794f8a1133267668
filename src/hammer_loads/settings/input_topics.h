/// Which topics a run was computed from. A node adds their resolved names to its parameters in `run_info`, so that
/// process_bag finds them in the node's log.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/settings/parameter_map.h"

namespace hammer_loads {

/// Resolved names; empty: not known.
struct InputTopics {
  std::string crank, joint_states, hull_imu;
  std::string cylinder_pressures{};  ///< prefix: its topics are /NAME/bore and /NAME/rod below it, per cylinder
};

/// Takes the keys `input_topic_crank`, `input_topic_joint_states`, `input_topic_hull_imu` and
/// `input_topic_cylinder_pressures`, none of them required, out of the parameters.
InputTopics takeInputTopics(ParameterMap& parameters, std::vector<std::string>& problems);

/// The same keys as YAML, one a line; none for a topic that is not known.
std::string yamlOf(const InputTopics& topics);

}  // namespace hammer_loads
