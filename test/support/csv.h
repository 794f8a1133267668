/// Reads a table of numbers with a header line.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace hammer_loads::test {

/// Rows of strings, so that a reader decides the precision; number() gives the nearest double.
class Csv {
 public:
  explicit Csv(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> header = split(line);
    for (std::size_t i = 0; i < header.size(); ++i) columns_[header[i]] = i;
    while (std::getline(file, line)) {
      if (!line.empty()) rows_.push_back(split(line));
    }
  }
  std::size_t size() const { return rows_.size(); }
  /// Names in alphabetical order.
  std::vector<std::string> columns() const {
    std::vector<std::string> names;
    for (const auto& [name, place] : columns_) names.push_back(name);
    return names;
  }
  const std::string& text(std::size_t row, const std::string& column) const {
    return rows_.at(row).at(columns_.at(column));
  }
  double number(std::size_t row, const std::string& column) const { return std::stod(text(row, column)); }
  /// Largest size in a column.
  double peak(const std::string& column) const {
    double peak = 0.0;
    for (std::size_t i = 0; i < size(); ++i) peak = std::max(peak, std::abs(number(i, column)));
    return peak;
  }

 private:
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> parts;
    std::stringstream stream(line);
    for (std::string part; std::getline(stream, part, ',');) {
      while (!part.empty() && (part.back() == '\r' || part.back() == ' ')) part.pop_back();
      parts.push_back(part);
    }
    return parts;
  }

  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// From test/data.
inline Csv dataCsv(const std::string& name) { return Csv(std::string(HAMMER_LOADS_TEST_DATA) + "/" + name); }

}  // namespace hammer_loads::test
