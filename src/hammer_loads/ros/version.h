/// Version and revision of the build.
#pragma once

namespace hammer_loads {

const char* packageVersion();   ///< e.g. 0.1.0
const char* packageRevision();  ///< revision of the source, as git describes it

}  // namespace hammer_loads
