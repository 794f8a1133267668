/// Torques of the load on the joints from the pressures of their cylinders.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// Two predictors: the oil's torque in the vibration plus the smoothed residual of the readings, and the line through
/// the last two readings. The one with the smaller past errors is used. The line is better if the oil differs from the
/// file, the vibration if readings are rare or the hull lands on rock. No allocation.
class MeasuredTorques {
 public:
  /// ModeIdentifier::oilInnovationRatio() from which on the readings do not follow the boom's motion, as when stamps
  /// lag.
  static constexpr double kContradicted = 1.0;

  struct Torque {
    double value{};      ///< torque of the load on the cylinder's joint [N m]
    double deviation{};  ///< standard deviation from errors of the last predictions; larger if the readings
                         ///< contradict the vibration (kContradicted), by their difference or as for an unknown lag, or
                         ///< if the next reading is overdue [N m]
    double constant{};   ///< further standard deviation due to constants: seal friction, offsets [N m]
    double lasting{};    ///< part of `constant` that stays while the operator drives the joint one way [N m]
    CylinderPosition at;  ///< position from the joint's sensor
  };

  struct Instant {
    StampNs stamp{};
    double noise{};  ///< standard deviation of the stamp [s]
  };
  /// Takes new readings; call after they have updated the vibration. steady: weight and motion [N m]; position: from
  /// the joint sensors. The known friction of the seals (from the boom file) is subtracted according to the rods'
  /// direction of motion and vibration.
  void follow(const Boom& boom, const JointVector& position, const JointVector& steady, const JointVector& motion,
              const Instant& instant, const CylinderPressures& pressures) noexcept;
  /// Returns the torque, index as in Boom::cylinders(); empty without both pressures or at a zero moment arm.
  const std::optional<Torque>& of(std::size_t cylinder) const noexcept { return torque_[cylinder]; }

 private:
  static constexpr double kSwingTime = Vibration::kSwingTime;
  /// Mean over some 1 s, and mean square about it [N m, N2 m2].
  struct Swing {
    RunningMean<> mean{kSwingTime, 0.0, kSwingTime}, square{mean};
    void begin(double torque) noexcept { mean = RunningMean<>(kSwingTime, torque, kSwingTime); }
    void add(double torque, double step) noexcept {
      mean.add(torque, step);
      square.add((torque - mean.mean()) * (torque - mean.mean()), step);
    }
  };
  struct Track {
    std::uint64_t readings{};  ///< number of readings taken
    double position{kNaN};     ///< position of the joint from its sensor
    CylinderPosition at;       ///< cylinder at that position
    StampNs stamp{};           ///< stamp of the last reading
    double interval{};         ///< time between the last two readings [s]
    bool goes_on{};            ///< known at the last sample
    double way{};              ///< see Seals
    double torque{};           ///< torque of the last reading [N m]
    double model{};  ///< torque of weight, motion and oil at that reading, with the vibration updated by it [N m]
    double rest{}, last{}, before{};  ///< reading minus model: filtered, last and previous [N m]
    double gain{1.0};                 ///< filter gain of the last reading
    RunningMean<> one_square{look_back::kReadings},
        two_square{look_back::kReadings};  ///< mean squares of its change over one reading and over two [N2 m2]
    double slope{};                        ///< slope of the line through the last two readings [N m/s]
    Swing swing, unexplained;              ///< oscillation of the torque, and of reading minus model
    RunningMean<> oil_square{look_back::kReadings},
        line_square{look_back::kReadings};  ///< mean squared errors of both predictors at a reading [N2 m2]
  };
  /// Uncertainty of the pressures' stamps.
  struct StampUncertainty {
    double delay{}, delay_std{};  ///< [s]
    double stamp_noise{};         ///< noise of the sample's stamp [s]
    double lag{};   ///< unknown delay of readings that do not fit, as a part of the oscillation's mean square
    bool misfit{};  ///< true if the delay is known and the readings do not fit
  };
  /// Torque of weight, motion and oil at the sample [N m] and its rate [N m/s].
  struct Model {
    double now{}, rate{};
  };
  static StampUncertainty stampUncertainty(const Vibration& vibration, double stamp_noise) noexcept;
  static Torque torqueNow(const Track& track, double age, const Model& model, const StampUncertainty& stamps) noexcept;
  void addConstants(const Boom& boom, std::size_t cylinder, double motion, double step, Torque& torque) noexcept;
  static void addTorque(Track& track, StampNs stamp, double torque, double model, double model_before) noexcept;
  static void followRest(Track& track, double rest) noexcept;

  std::array<Track, kMaxJoints> tracks_;
  std::array<std::optional<Torque>, kMaxJoints> torque_;
  Vibration::OilTorque model_;  ///< with weight and motion, at the last sample
  JointVector read_;            ///< part of the model that pressures would show at that time [N m]
  StampNs sample_{};
};

}  // namespace hammer_loads
