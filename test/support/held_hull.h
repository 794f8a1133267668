/// Settings for simulated machines whose hull is held and whose encoder has a known zero.
#pragma once

#include "hammer_loads/settings/load.h"
#include "support/known_zero.h"

namespace hammer_loads::test {

/// The deviations do not count what an unmeasured hull might do, and the zero is known as by `calibrate`.
inline Settings heldHull(Settings settings) {
  if (settings.pipeline.hull_motion == HullMotionSource::kUnmeasured)
    settings.pipeline.hull_motion = HullMotionSource::kFixed;
  settings.pipeline.crank_zero_std = kKnownZeroStd;
  return settings;
}

}  // namespace hammer_loads::test
