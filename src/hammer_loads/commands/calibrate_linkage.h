/// calibrate --linkage: a table of stroke and angle in, the lengths of a bucket linkage out.
#pragma once

namespace hammer_loads {

/// First line of its file, by which the command recognises it.
constexpr const char* kLinkageYamlBegins = "# Bucket linkage fitted by calibrate --linkage to";

/// Returns true if the command line asks for it.
bool asksForLinkage(int argc, const char* const* argv);
/// Exit code.
int calibrateLinkage(int argc, const char* const* argv);

}  // namespace hammer_loads
