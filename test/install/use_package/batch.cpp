/// Computes many states using only names from doc/api.md.
#include API_HEADER

int main() {
  using namespace hammer_loads;
  const auto mechanism = Mechanism::make({});
  if (!mechanism.value) return 0;
  const double angle = 1.0, speed = 30.0, acceleration = 0.0;
  double x, z, torque;
  hullWrenches(HullModel(*mechanism.value, Level::kRocker), {&angle, &speed, &acceleration, 1}, {}, {&x, &z, &torque});
  return 0;
}
