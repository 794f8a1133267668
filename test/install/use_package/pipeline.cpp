/// Computes loads from samples using only names from doc/api.md.
#include API_HEADER

int main() {
  using namespace hammer_loads;
  const auto mechanism = Mechanism::make({});
  if (!mechanism.value) return 0;
  const Pipeline pipeline(*mechanism.value, PipelineSettings{});
  return pipeline.counts().accepted == 0 ? 0 : 1;
}
