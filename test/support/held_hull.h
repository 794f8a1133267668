/// Settings for simulated machines whose hull is held.
#pragma once

#include "hammer_loads/settings/load.h"

namespace hammer_loads::test {

/// The deviations do not count what an unmeasured hull might do.
inline Settings heldHull(Settings settings) {
  if (settings.pipeline.hull_motion == HullMotionSource::kUnmeasured)
    settings.pipeline.hull_motion = HullMotionSource::kFixed;
  return settings;
}

}  // namespace hammer_loads::test
