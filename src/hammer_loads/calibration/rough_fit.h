/// From a first guess to where a fit settles.
#pragma once

#include <vector>

#include "hammer_loads/calibration/joint_fit.h"

namespace hammer_loads::calibration {

struct RoughFit {
  JointFit fit;
  Globals other{Globals::Zero()};  ///< how far away another one is that explains the readings as well; 0: none does
};

/// A coupling bends the energy by which the first guess has the zero, and one frequency may look like another: then a
/// few blows are fitted from many places beside the guess, and all of them from the best ones.
RoughFit fitRoughly(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& guess,
                    const Noise& noise, const Free& free, const Progress& progress = {});

}  // namespace hammer_loads::calibration
