/// The log's part of a node's diagnostics.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

void describeLog(const BagLog& log, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace hammer_loads
