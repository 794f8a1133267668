/// The pulse of a turn, from the installed parameters.
#include <iostream>

#include "hammer_loads/hammer/turn_table.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"

int main(int argc, char** argv) {
  using namespace hammer_loads;
  const auto settings = loadFiles(argc > 1 ? argv[1] : configDirectory(), {});
  if (!settings.value) return 1;
  const Pipeline pipeline(settings.value->mechanism, settings.value->pipeline);
  const HullModel model(settings.value->mechanism, Level::kRocker);
  std::cout << summaryText(pulseOfTurn({model, 31.416, Gravity{}, 1.0, false}));
}
