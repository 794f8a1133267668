#include "hammer_loads/pipeline/filter_settings.h"

#include <cmath>

#include "hammer_loads/linkage/blow_inertia.h"

namespace hammer_loads {

CrankFilterSettings filterSettings(const Mechanism& mechanism, const PipelineSettings& s) {
  const double inertia = mechanism.parameters().rocker_inertia_about_pivot;
  CrankFilterSettings filter;
  filter.sensor = s.crank_sensor;
  filter.zero_std = std::abs(s.crank_sensor.gain()) * s.crank_zero_std;
  filter.angle_resolution = s.crank_angle_resolution;
  filter.angle_noise = s.crank_angle_noise;
  filter.timing_noise = s.crank_timing_noise;
  filter.constant_deviations[ConstantErrors::kLatency] = s.crank_latency_std;
  filter.speed_noise = s.crank_speed_noise;
  filter.torque_walk = s.torque_walk * inertia;
  filter.speed_walk = s.speed_walk;
  filter.inertia_walk = s.inertia_walk;
  filter.initial_torque_std = s.initial_torque_std * inertia;
  filter.initial_inertia_std = s.initial_inertia_std;
  filter.max_speed = s.max_crank_speed;
  filter.blow_factor = blowInertia(mechanism, rigid(s.level), mechanism.parameters().drive_inertia).smoothFactor();
  return filter;
}

}  // namespace hammer_loads
