/// Warnings to the user about the inputs: what is missing and what is inconsistent.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {

struct Warning {
  const char* key;   ///< equal for equal causes
  std::string text;  ///< one line: what, how much, what to do
  bool now{};        ///< still the case; otherwise it was at some time since the start
  bool awaited{};    ///< true for an input that has not come yet: it may begin later than the crank
};

/// Returns true if a warning of this key means that the crank's readings are not those of such a machine.
bool isContradiction(std::string_view key) noexcept;

/// Returns the warnings, most important first; empty when all is well. Not for the hot path.
std::vector<Warning> warningsOf(const Pipeline& pipeline);

}  // namespace hammer_loads
