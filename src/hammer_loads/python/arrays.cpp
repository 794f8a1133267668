#include "hammer_loads/python/arrays.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads::python {

namespace {

/// Beginning of a value as Python shows it.
std::string shown(const py::handle& value) {
  constexpr std::size_t kMost = 60;
  const std::string text = onOneLine(py::repr(value).cast<std::string>());
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

}  // namespace

StateArrays::StateArrays(const std::vector<Quantity>& quantities) {
  bool alike = true;  // then NumPy need not be asked
  for (const auto& [name, quantity] : quantities) {
    Array array = Array::ensure(quantity);  // clears Python's error
    if (!array) raise({std::string(name) + ": " + shown(quantity) + ", must be a number or an array of numbers"});
    arrays_.push_back(std::move(array));
    const Array& added = arrays_.back();
    const std::vector<py::ssize_t> shape(added.shape(), added.shape() + added.ndim());
    if (shape.empty()) continue;
    if (shape_.empty()) shape_ = shape;
    alike = alike && shape == shape_;
  }
  if (!alike) {
    const py::module_ numpy = py::module_::import("numpy");
    py::tuple all(arrays_.size());
    for (std::size_t i = 0; i < arrays_.size(); ++i) all[i] = arrays_[i];
    shape_ = numpy.attr("broadcast")(*all).attr("shape").cast<std::vector<py::ssize_t>>();
    for (Array& array : arrays_) {
      if (array.ndim() != 0) array = Array(numpy.attr("broadcast_to")(array, shape_));
    }
  }
  for (const py::ssize_t length : shape_) count_ *= static_cast<std::size_t>(length);
  for (const Array& array : arrays_) data_.push_back(array.data());
}

const double* StateArrays::from(std::size_t quantity, std::size_t first, std::size_t most,
                                std::vector<double>& scratch) const {
  if (!isNumber(quantity)) return data_[quantity] + first;
  scratch.assign(most, *data_[quantity]);
  return scratch.data();
}

bool StateArrays::overlap(const double* values, std::size_t length) const {
  for (std::size_t i = 0; i < data_.size(); ++i) {
    const std::less<const double*> before;
    const auto own = static_cast<std::size_t>(arrays_[i].size());
    if (before(data_[i], values + length) && before(values, data_[i] + own)) return true;
  }
  return false;
}

ResultArrays::ResultArrays(std::vector<py::ssize_t> shape, std::size_t count, py::object out)
    : shape_(std::move(shape)), count_(count), out_(std::move(out)) {
  if (out_.is_none()) {
    std::vector<py::ssize_t> all = shape_;
    all.insert(all.begin(), static_cast<py::ssize_t>(count));
    memory_ = py::array_t<double>(all);
  } else if (!py::isinstance<py::dict>(out_)) {
    raise({"out: must be a dictionary of arrays"});
  }
}

double* ResultArrays::add(const char* name) {
  using Exact = py::array_t<double, py::array::c_style>;
  Exact array;
  if (out_.is_none()) {
    if (data_.size() == count_) throw std::logic_error(std::string(name) + ": more arrays than memory was taken for");
    const auto length = static_cast<std::size_t>(memory_.size()) / count_;
    array = Exact(shape_, memory_.mutable_data() + data_.size() * length, memory_);
  } else {
    const py::dict given = out_;
    const bool there = given.contains(name) && Exact::check_(given[name]);
    if (there) array = py::reinterpret_borrow<Exact>(given[name]);
    const bool fits = there && array.writeable() && static_cast<std::size_t>(array.ndim()) == shape_.size() &&
                      std::equal(shape_.begin(), shape_.end(), array.shape());
    if (!fits) raise({std::string("out: ") + name + ": must be a writeable array of float64 in the results' shape"});
  }
  double* data = array.mutable_data();
  data_.push_back(data);
  arrays_[name] = std::move(array);
  return data;
}

void ResultArrays::demandApartFrom(const StateArrays& states) const {
  if (out_.is_none() || states.count() == 0) return;
  std::vector<const double*> sorted = data_;
  std::sort(sorted.begin(), sorted.end(), std::less<>());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool shared = i > 0 && static_cast<std::size_t>(sorted[i] - sorted[i - 1]) < states.count();
    if (shared || states.overlap(sorted[i], states.count())) raise({"out: shares memory with another array"});
  }
}

double numberOf(const std::string& name, const py::handle& value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();
  raise({name + ": " + shown(value) + ", must be a number"});
}

void raise(const std::vector<std::string>& problems) {
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw py::value_error(text);
}

}  // namespace hammer_loads::python
