/// One hammer as Python has it: parameters that were judged, and models of them at each level.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/hammer/batch.h"
#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/turn_table.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads::python {

/// A value; copies share the mechanism.
class Hammer {
 public:
  /// From parameter files over the shipped ones, as every command takes them with --params.
  static Checked<Hammer> fromFiles(const std::vector<std::string>& files);
  /// With other values of the hammer file's keys, in the keys' units.
  Checked<Hammer> changed(const std::map<std::string, double>& values) const;

  const Mechanism& mechanism() const { return *mechanism_; }
  const std::map<std::string, double>& parameters() const { return parameters_; }  ///< in force, by the file's keys
  const std::vector<std::string>& notes() const { return notes_; }
  Level level() const { return level_; }       ///< level of the parameters
  double gravity() const { return gravity_; }  ///< [m/s2]

 private:
  std::shared_ptr<const Mechanism> mechanism_;
  std::map<std::string, double> parameters_;
  std::vector<std::string> notes_;
  Level level_{};
  double gravity_{};
};

}  // namespace hammer_loads::python
