/// A single state, with nothing but what doc/api.md names.
#include API_HEADER

int main() {
  using namespace hammer_loads;
  const auto mechanism = Mechanism::make({});
  if (!mechanism.value) return 0;  // lengths of 0 are no mechanism, which is a problem told
  const HullModel model(*mechanism.value, Level::kPulse);
  return model.nominalPulse().amplitude > 0.0 ? 0 : 1;
}
