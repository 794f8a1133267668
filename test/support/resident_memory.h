/// Whether a process grows.
#pragma once

#include <unistd.h>

#include <fstream>
#include <numeric>
#include <string>
#include <vector>

namespace hammer_loads::test {

/// Resident memory of a process [byte]; 0 if there is none.
inline double residentMemory(const std::string& process = "self") {
  std::ifstream file("/proc/" + process + "/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

class MemoryRecord {
 public:
  void add(double bytes) { samples_.push_back(bytes); }
  double firstQuarter() const { return mean(0, samples_.size() / 4); }
  double lastQuarter() const { return mean(samples_.size() - samples_.size() / 4, samples_.size()); }
  double growth() const { return lastQuarter() / firstQuarter() - 1.0; }  ///< relative

 private:
  double mean(std::size_t from, std::size_t to) const {
    const auto begin = samples_.begin();
    return std::accumulate(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(to), 0.0) /
           static_cast<double>(to - from);
  }
  std::vector<double> samples_;
};

}  // namespace hammer_loads::test
