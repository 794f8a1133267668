/// The numbers of a message by the names in its definition, so that a new field of the message becomes a new column.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/tables/table_schema.h"

namespace hammer_loads {

/// Fields of a message that consists of a header and single numbers.
class NumberFields {
 public:
  /// definition: of the message. Throws std::invalid_argument for another kind of message.
  explicit NumberFields(const std::string& definition);

  std::vector<TableColumn> columns() const;
  /// In the order of the columns; integers are exact up to 2^53. Valid until the next call.
  template <typename Message>
  const std::vector<double>& valuesOf(const Message& message) {
    bytes_.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    ros::serialization::serialize(stream, message);
    read(ros::serialization::serializationLength(message.header));
    return values_;
  }

 private:
  struct Field {
    TableColumn column;
    double (*read)(const std::uint8_t* bytes);
    std::size_t size;
  };
  void read(std::size_t header_size);

  std::vector<Field> fields_;
  std::vector<std::uint8_t> bytes_;
  std::vector<double> values_;
};

template <typename Message>
NumberFields numberFieldsOf() {
  return NumberFields(ros::message_traits::definition<Message>());
}

}  // namespace hammer_loads
