/// Check whether an existing bag may be replaced.
#pragma once

#include <string>
#include <vector>

namespace hammer_loads {

/// Reason why an existing file must stay; empty: it is a bag of this package's outputs alone, as process_bag writes it.
/// A recording of inputs or a node's log must stay.
std::string whyBagMustStay(const std::string& file, const std::vector<std::string>& input_topics);

}  // namespace hammer_loads
