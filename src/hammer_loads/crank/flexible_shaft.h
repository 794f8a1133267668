/// How crank and motor move on the two sides of a flexible coupling.
#pragma once

#include <Eigen/Core>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/crank_tracker.h"

namespace hammer_loads {

/// Order of its variables: those of ShaftMatrix, then angle and speed of the motor, CouplingLaw's two logarithms and
/// that of the coupling's damping.
using FlexibleMatrix = Eigen::Matrix<double, 10, 10>;
enum FlexibleRow : Eigen::Index { kMotorAngle = 5, kMotorSpeed, kStiffness, kOdds, kDamping };
constexpr int kFlexibleVariables = kOdds;  ///< a filter's: odds and damping are constants

CouplingLaw lawOf(const Coupling& coupling, const ShaftState& state) noexcept;
/// w' = (moment of the coupling + weight - Jk r alpha - J'/2 w^2)/(Jk + J) [rad/s2], Jk the drive inertia on the
/// crank's side.
double flexibleAcceleration(const Coupling& coupling, const ShaftLoad& load, const ShaftState& state) noexcept;
CrankEstimate flexibleEstimate(const Coupling& coupling, const ShaftLoad& load, const ShaftState& state) noexcept;
/// Of the motor: (tau - moment)/Jm - r alpha [rad/s2].
double motorAcceleration(const Coupling& coupling, const ShaftLoad& load, const ShaftState& state) noexcept;

/// As advance(), for a model with a coupling: what the blow does acts on the crank alone, angle and speed of the motor
/// are continuous. transition: null, or multiplied by d(variables after)/d(variables before), the blow's factor where a
/// blow is passed. How many blows were passed.
///
/// Steps as advance()'s, but of at most 0.4 rad of the coupling's own oscillation: per step Runge-Kutta is wrong by
/// 1e-4 rad of its phase, the linearisation's exponential by 1e-4.
int advanceFlexible(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state,
                    FlexibleMatrix* transition) noexcept;

/// As passBlow(), for a model with a coupling.
void passBlowFlexible(const ShaftModel& model, double factor, ShaftState& state, FlexibleMatrix* transition) noexcept;

}  // namespace hammer_loads
