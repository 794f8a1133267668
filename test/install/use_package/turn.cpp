/// Prints the pulse of a revolution from the installed parameters.
#include <iostream>

#include "hammer_loads/hammer/turn_table.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"

int main() {
  using namespace hammer_loads;
  const auto settings = loadFiles(configDirectory(), {});
  if (!settings.value) return 1;
  const Pipeline pipeline(settings.value->mechanism, settings.value->pipeline);
  std::cout << summaryText(pulseOfTurn({HullModel(settings.value->mechanism, Level::kRocker), 31.416, {}, 1.0, false}));
}
