/// NumPy arrays in and out.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace hammer_loads::python {

namespace py = pybind11;

/// Several quantities of N states: arrays of one shape, numbers that count for all states, or what NumPy broadcasts to
/// one shape.
class StateArrays {
 public:
  /// A value with the name of its argument.
  using Quantity = std::pair<const char*, py::object>;

  /// ValueError where one is not of numbers, or the shapes do not go together.
  explicit StateArrays(const std::vector<Quantity>& quantities);

  std::size_t count() const { return count_; }
  /// Of the results: the shape that all quantities have together; of numbers alone none.
  const std::vector<py::ssize_t>& shape() const { return shape_; }
  bool isNumber(std::size_t quantity) const { return arrays_[quantity].size() == 1 && count_ != 1; }
  /// Whether some of them lie in these values.
  bool overlap(const double* values, std::size_t length) const;
  /// `most` values or fewer from `first` on: in place, or the number repeated in `scratch`. No Python object is
  /// touched.
  const double* from(std::size_t quantity, std::size_t first, std::size_t most, std::vector<double>& scratch) const;

 private:
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  std::vector<Array> arrays_;
  std::vector<const double*> data_;
  std::vector<py::ssize_t> shape_;
  std::size_t count_{1};
};

/// Arrays of one shape, by name, in the order in which they are added: new ones in one piece of memory, which costs a
/// tenth of as many pieces where they are large and made again and again, or those of `out`, an earlier result.
class ResultArrays {
 public:
  /// count: of the arrays that will be added.
  ResultArrays(std::vector<py::ssize_t> shape, std::size_t count, py::object out = py::none());
  /// ValueError where `out` has no array of this name that fits.
  double* add(const char* name);
  /// ValueError where two results, or a result and a state, share memory.
  void demandApartFrom(const StateArrays& states) const;
  py::dict take() { return std::move(arrays_); }

 private:
  std::vector<py::ssize_t> shape_;
  std::size_t count_;
  py::object out_;
  py::array_t<double> memory_;
  std::vector<const double*> data_;
  py::dict arrays_;
};

/// A number that a caller gives under a name; ValueError where it is none.
double numberOf(const std::string& name, const py::handle& value);

/// Python's ValueError: the problems as the commands write them, a line each.
[[noreturn]] void raise(const std::vector<std::string>& problems);

}  // namespace hammer_loads::python
