/// Computes a single state using only names from doc/api.md.
#include API_HEADER

int main() {
  using namespace hammer_loads;
  const auto mechanism = Mechanism::make({});
  if (!mechanism.value) return 0;  // lengths of 0 are no mechanism, which is reported as a problem
  const HullModel model(*mechanism.value, Level::kPulse);
  return model.nominalPulse().amplitude > 0.0 ? 0 : 1;
}
