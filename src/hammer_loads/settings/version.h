/// Version of the package.
#pragma once

namespace hammer_loads {

const char* packageVersion();  ///< e.g. 0.1.0; defined in load.cpp

}  // namespace hammer_loads
