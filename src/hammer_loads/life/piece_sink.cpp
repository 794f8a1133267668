#include "hammer_loads/life/piece_sink.h"

#include <dlfcn.h>

namespace hammer_loads::life {

Checked<std::unique_ptr<LiveLedger>> loadLedger(const std::string& path) {
  Checked<std::unique_ptr<LiveLedger>> result;
  void* const library = dlopen("libhammer_loads_ledger.so", RTLD_NOW | RTLD_LOCAL);
  void* const make = library == nullptr ? nullptr : dlsym(library, "hammerLoadsMakeLedger");
  if (make == nullptr)
    result.problems.push_back("life_ledger: cannot be loaded: " + std::string(dlerror()));
  else
    result.value.emplace(reinterpret_cast<LiveLedger* (*)(const std::string&)>(make)(path));
  return result;
}

}  // namespace hammer_loads::life
