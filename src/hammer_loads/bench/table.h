/// A table of doc/accuracy.md with the same figures in JSON.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {

/// Parts of one as a cell: "1.2, 3.4 %".
template <typename Parts = std::initializer_list<double>>
std::string percents(int digits, const Parts& parts) {
  std::string text;
  for (const double part : parts) text += format("%s%.*f", text.empty() ? "" : ", ", digits, 100.0 * part);
  return text + " %";
}

/// Rows of columns: the header of a column in Markdown, its key in JSON. Every row has the columns of the first one.
class Table {
 public:
  /// digits: significant digits of numbers in JSON.
  explicit Table(int digits) : digits_(digits) {}

  void beginRow() { markdown_.emplace_back("|"), json_.emplace_back(); }
  /// Column of Markdown alone; of the first row with its header.
  void cell(const std::string& header, const std::string& text) {
    if (markdown_.size() == 1) header_ += padded(header), line_ += "---|";
    markdown_.back() += padded(text);
  }
  /// Columns of JSON alone: any JSON value; a number, null where it is not finite.
  void field(const char* key, const std::string& json) {
    json_.back() += format("%s\"%s\": ", json_.back().empty() ? "" : ", ", key) + json;
  }
  void number(const char* key, double value) {
    field(key, std::isfinite(value) ? format("%.*g", digits_, value) : "null");
  }
  /// Columns of both.
  void text(const char* header, const char* key, const std::string& value) {
    cell(header, value), field(key, '"' + value + '"');
  }
  void percent(const char* header, const char* key, int digits, double part, const char* unknown = "withheld") {
    cell(header, std::isfinite(part) ? accuracy::percents(digits, {part}) : unknown), number(key, part);
  }

  /// Several parts in one column of Markdown.
  void percents(const char* header, int digits, const std::vector<std::pair<const char*, double>>& parts) {
    std::vector<double> values;
    for (const auto& [key, part] : parts) values.push_back(part), number(key, part);
    cell(header, accuracy::percents(digits, values));
  }

  std::string markdown() const { return '|' + header_ + "\n|" + line_ + '\n' + joined(markdown_, "\n") + '\n'; }
  std::string json() const { return json_.empty() ? "[\n]" : "[\n  {" + joined(json_, "},\n  {") + "}\n]"; }

 private:
  static std::string padded(const std::string& text) { return text.empty() ? " |" : ' ' + text + " |"; }

  int digits_;
  std::string header_, line_;
  std::vector<std::string> markdown_, json_;
};

}  // namespace hammer_loads::accuracy
