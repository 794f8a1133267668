/// Bags of this package's outputs: which of them may be replaced.
#pragma once

#include <string>
#include <vector>

namespace hammer_loads {

/// Why an existing file must stay; empty: it is a bag of this package's outputs and of nothing else, as process_bag
/// writes it. A recording of inputs is none, a node's log neither.
std::string whyBagMustStay(const std::string& file, const std::vector<std::string>& input_topics);

}  // namespace hammer_loads
