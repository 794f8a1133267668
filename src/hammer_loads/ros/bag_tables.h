/// Writer of a recording's results as tables, from the messages of the hammer's outputs.
#pragma once

#include <hammer_loads/Alarms.h>
#include <hammer_loads/LoadCycles.h>
#include <hammer_loads/TurnLoads.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/pipeline/budget.h"
#include "hammer_loads/ros/bag_report.h"
#include "hammer_loads/ros/hammer_bridge.h"
#include "hammer_loads/tables/table_writer.h"
#include "hammer_loads/tables/turn_traces.h"

namespace hammer_loads {

/// Turn loads, load cycles and alarms of a recording as tables.
class LifeTables {
 public:
  /// The writer must outlive it.
  explicit LifeTables(TableWriter& writer) : writer_(&writer) {}

  /// Begins the run of this number. The bridge must outlive the run.
  void begin(HammerBridge& bridge, std::int64_t run);
  /// Writes the end of a run.
  void end(const HammerBridge& bridge);

 private:
  void takeTurn(const TurnLoads& message);
  void takeAlarms(const Alarms& message);
  void writeBudget();
  void write(const BudgetFigure& figure);
  void writeReference(const ReferenceComparison& comparison);
  void writeCount(std::size_t number, const ChannelCycles& message, const life::CountedChannel& channel);

  struct RaisedAlarm {
    Alarm alarm;
    ros::Time until;        ///< stamp of the last revolution at this level
    std::uint64_t turns{};  ///< judged revolutions at this level
  };

  TableWriter* writer_;
  std::int64_t run_{};
  std::optional<BudgetRecorder> budget_;
  std::vector<RaisedAlarm> alarms_;
  LoadCycles cycles_;  ///< last message, which covers the run so far
};

/// Numbers of a message that consists of a header and scalar fields. Their names come from the message's definition, so
/// that a new field becomes a new column.
class NumberFields {
 public:
  /// definition: text of the message's definition. Throws std::invalid_argument if a field is no number.
  explicit NumberFields(const std::string& definition);

  std::vector<TableColumn> columns() const;
  /// Returns the numbers in the order of the columns, valid until the next call. Integers are exact up to 2^53.
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

class BagTables {
 public:
  /// file: an empty file. inputs: the recording's bags, hashed here. Throws std::runtime_error if one cannot be read.
  BagTables(const std::string& file, const std::vector<std::string>& inputs);

  /// Begins a run. The bridge must outlive the run.
  void begin(HammerBridge& bridge);
  /// Ends a run. samples: number of its messages with crank samples.
  void end(const HammerBridge& bridge, std::uint64_t samples);
  /// Completes the tables after the last run. warnings: those of all runs and of the recording.
  void finish(const std::vector<BagWarning>& warnings);

  /// Returns the reason why the file cannot be written, one line without its name; empty without a problem.
  const std::string& problem() const { return writer_.problem(); }

 private:
  /// Stamps of the first and last published sample [ns], and the time between samples without gaps [s].
  struct Published {
    std::optional<StampNs> first, last;
    double duration{};
  };
  void takeSample(const HullLoads& message);
  void takePulse(const Pulse& message, const Pipeline& pipeline);
  void takeHealth(std::uint64_t turn, const BoomFollower& boom);
  void addParameters(const Settings& settings, const std::string& yaml);
  void addRefusals(const SampleCounts& counts);
  void addTrace(const char* kind, const TurnTrace& trace);

  std::string input_sha256_;
  NumberFields pulse_, blow_;
  TableWriter writer_;
  LifeTables life_{writer_};
  std::int64_t run_{};  ///< number of the current run, from 1
  Published published_;
  TurnTraces traces_;
  double longest_step_{};  ///< largest interval of samples that is no gap [s]
};

}  // namespace hammer_loads
