/// The cost table's reference, for the tests.
#pragma once

#include "hammer_loads/bench/newton_euler.h"

namespace hammer_loads::test {

using accuracy::NewtonEuler;
using accuracy::Real;
using accuracy::realPi;
using accuracy::Reference;
using accuracy::Vector;

}  // namespace hammer_loads::test
