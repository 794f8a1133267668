#include "hammer_loads/ros/version.h"

namespace hammer_loads {

const char* packageRevision() { return HAMMER_LOADS_REVISION; }

}  // namespace hammer_loads
