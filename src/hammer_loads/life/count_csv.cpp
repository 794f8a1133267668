#include "hammer_loads/life/count_csv.h"

#include <cstdlib>

#include "hammer_loads/util/format.h"

namespace hammer_loads::life {

std::string shortNumber(double value) {
  std::string text;
  for (int digits = 15; digits <= 17; ++digits) {
    text = format("%.*g", digits, value);
    if (std::strtod(text.c_str(), nullptr) == value) break;
  }
  return text;
}

std::string csvText(const std::vector<RangeMean>& cycles) {
  std::string text = "range,mean,count\n";
  for (const RangeMean& c : cycles)
    text += shortNumber(c.range) + ',' + shortNumber(c.mean) + ',' + shortNumber(c.count) + '\n';
  return text;
}

}  // namespace hammer_loads::life
