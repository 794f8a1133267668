/// Hammer and boom as Python has them: parameters that were judged, and models of them.
#pragma once

#include <pybind11/numpy.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"
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

/// A value; copies share the model, which never changes.
class BoomModel {
 public:
  using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

  /// From a robot description and parameter files, as every command takes them with --urdf and --params.
  static Checked<BoomModel> fromFiles(const std::string& description, const std::vector<std::string>& files);

  std::vector<std::string> joints() const { return boom_->chain().jointNames(); }
  std::vector<std::string> sections() const;
  /// Natural frequencies at a pose [Hz], ascending. position: of each joint [rad]; a missing joint is at 0.
  std::vector<double> frequencies(const std::map<std::string, double>& position) const;
  /// Rows of load: time [s], never falling, force x, z [N] and moment y [N m] BY the hammer ON the hull at the origin
  /// of hammer_hull, axes of that frame. Rows of the result, without weight, from rest at the first time: torque of
  /// each joint [N m], then force x, z and moment y of each section. compliant: the joints vibrate on their cylinders'
  /// oil, else the boom is rigid.
  Array loads(const std::map<std::string, double>& position, const Array& load, bool compliant) const;

 private:
  Boom posed(const std::map<std::string, double>& position) const;

  std::shared_ptr<const Boom> boom_;
};

}  // namespace hammer_loads::python
