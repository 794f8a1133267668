/// calibrate --linkage: a table of stroke and angle in, the lengths of a bucket linkage out.
#pragma once

namespace hammer_loads {

/// How its file begins: by that the command knows it again.
constexpr const char* kLinkageYamlBegins = "# Bucket linkage fitted by calibrate --linkage to";

/// Whether the command line asks for it.
bool asksForLinkage(int argc, const char* const* argv);
/// Exit code.
int calibrateLinkage(int argc, const char* const* argv);

}  // namespace hammer_loads
