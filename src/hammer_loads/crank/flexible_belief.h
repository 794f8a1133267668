/// Prediction, measurement and blow of a belief with a flexible coupling.
#pragma once

#include <optional>

#include "hammer_loads/crank/crank_belief.h"

namespace hammer_loads {

/// All variables of a belief with a motor of its own, in the order of FlexibleMatrix.
using FlexibleVariables = GaussianBelief<kFlexibleVariables, ConstantErrors::kSize>;

FlexibleVariables variablesOf(const CrankBelief& belief) noexcept;
void setVariables(const FlexibleVariables& all, CrankBelief& belief) noexcept;
void moveFlexible(const FlexibleVariables::Vector& change, CrankBelief& belief) noexcept;

/// The motor, on which the encoder sits, is where the crank is but for a twist of standard deviation
/// torque_deviation [N m] over the stiffness.
void beginMotor(const Coupling& coupling, double torque_deviation, CrankBelief& belief) noexcept;

/// The stiffness is as in doubt as at first, its estimate the given one.
void doubtStiffness(const Coupling& coupling, CrankBelief& belief) noexcept;

/// As the members of CrankBelief, for a belief with a motor of its own.
int predictFlexible(const ShaftModel& model, const CrankWalks& walks, const BlowPrior& prior, bool contact,
                    double most_speed, double dt, CrankBelief& belief, FlexibleMatrix* transition) noexcept;
/// drawn: the factor is another one than before.
void passLateFlexible(const ShaftModel& model, double factor, bool drawn, CrankBelief& belief,
                      FlexibleMatrix* transition) noexcept;
void correctFlexible(FlexibleRow row, double innovation, double variance, const ConstantErrors::Row& by_error,
                     const std::optional<ConstantErrors::Row>& of_constants, CrankBelief& belief) noexcept;
void widenFlexible(double factor, CrankBelief& belief) noexcept;
void forgetAngleFlexible(double variance, CrankBelief& belief) noexcept;
void forgetCouplingsOf(CrankBelief& belief) noexcept;
bool isSoundFlexible(double most_speed, const CrankBelief& belief) noexcept;

/// As motionUncertainty() of the crank, at a rigid one's place.
CrankUncertainty flexibleUncertainty(const ShaftModel& model, const CrankBelief& belief, double growth,
                                     const ConstantErrors::Matrix& root, double torque_part) noexcept;

}  // namespace hammer_loads
