/// The cost table's reference of the grapple, for the tests.
#pragma once

#include "hammer_loads/bench/explicit_curve.h"

namespace hammer_loads::test {

using accuracy::CurvePlace;
using accuracy::Digits50;
using accuracy::exactFoldNear;
using accuracy::exactPoseOf;
using accuracy::ExplicitPose;
using accuracy::explicitPose;
using accuracy::placeOf;
using accuracy::PsiJet;
using accuracy::PsiPoint;
using accuracy::Signs;

}  // namespace hammer_loads::test
