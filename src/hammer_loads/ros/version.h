/// Version and revision of the build.
#pragma once

#include "hammer_loads/settings/version.h"

namespace hammer_loads {

const char* packageRevision();  ///< revision of the source, as git describes it

}  // namespace hammer_loads
