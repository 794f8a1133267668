#include "hammer_loads/ros/number_fields.h"

#include <cstring>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace hammer_loads {
namespace {

struct Kind {
  double (*read)(const std::uint8_t* bytes);
  std::size_t size;
  bool is_integer;
};

template <typename T>
constexpr Kind kindOf() {
  return {[](const std::uint8_t* bytes) {
            T value;
            std::memcpy(&value, bytes, sizeof value);
            return static_cast<double>(value);
          },
          sizeof(T), std::is_integral_v<T>};
}

const std::map<std::string, Kind>& kinds() {
  static const std::map<std::string, Kind> kinds{
      {"float64", kindOf<double>()},       {"float32", kindOf<float>()},       {"bool", kindOf<std::uint8_t>()},
      {"int8", kindOf<std::int8_t>()},     {"uint8", kindOf<std::uint8_t>()},  {"int16", kindOf<std::int16_t>()},
      {"uint16", kindOf<std::uint16_t>()}, {"int32", kindOf<std::int32_t>()},  {"uint32", kindOf<std::uint32_t>()},
      {"int64", kindOf<std::int64_t>()},   {"uint64", kindOf<std::uint64_t>()}};
  return kinds;
}

}  // namespace

NumberFields::NumberFields(const std::string& definition) {
  // A field's comment is "# [unit] description"; further lines of the description begin with spaces.
  static const std::regex kComment(R"([^#]*#\s*(?:\[([^\]]*)\]\s*)?(.*))"), kFurther(R"(\s+#.*)");
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line) && line.rfind("====", 0) != 0;) {
    if (!fields_.empty() && std::regex_match(line, kFurther))
      fields_.back().column.description += ' ' + line.substr(line.find('#') + 2);
    const std::string code = line.substr(0, line.find('#'));
    std::istringstream words(code);
    std::string type, name;
    if (!(words >> type >> name) || name == "header" || code.find('=') != std::string::npos) continue;  // =: a constant
    const auto kind = kinds().find(type);
    if (kind == kinds().end()) throw std::invalid_argument("field " + name + " of type " + type + " is no number");
    TableColumn column{name, kind->second.is_integer, "-", {}};
    if (std::smatch found; std::regex_match(line, found, kComment)) {
      if (found[1].matched) column.unit = found[1];
      column.description = found[2];
    }
    fields_.push_back({column, kind->second.read, kind->second.size});
  }
  values_.resize(fields_.size());
}

std::vector<TableColumn> NumberFields::columns() const {
  std::vector<TableColumn> columns;
  for (const Field& field : fields_) columns.push_back(field.column);
  return columns;
}

void NumberFields::read(std::size_t header_size) {
  const std::uint8_t* at = bytes_.data() + header_size;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    values_[i] = fields_[i].read(at);
    at += fields_[i].size;
  }
}

}  // namespace hammer_loads
