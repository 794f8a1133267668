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

  /// A run of this number begins; the bridge must outlive it.
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
    ros::Time until;        ///< stamp of the last turn of this level
    std::uint64_t turns{};  ///< judged turns of this level
  };

  TableWriter* writer_;
  std::int64_t run_{};
  std::optional<BudgetRecorder> budget_;
  std::vector<RaisedAlarm> alarms_;
  LoadCycles cycles_;  ///< the last message: all of the run so far
};

/// The numbers of a message that consists of a header and single numbers, by the names in its definition, so that a new
/// field of the message becomes a new column.
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

class BagTables {
 public:
  /// file: empty. inputs: the recording's bags, hashed here. Throws std::runtime_error where one cannot be read.
  BagTables(const std::string& file, const std::vector<std::string>& inputs);

  /// A run begins; the bridge must outlive it.
  void begin(HammerBridge& bridge);
  /// Ends a run after this many messages with crank samples.
  void end(const HammerBridge& bridge, std::uint64_t samples);
  /// After the last run; warnings: of all runs and of the recording.
  void finish(const std::vector<BagWarning>& warnings);

  /// Reason why the file cannot be written, one line without its name; empty without a problem.
  const std::string& problem() const { return writer_.problem(); }

 private:
  /// Stamps of published samples [ns], and the time between them, gaps left out [s].
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
  std::int64_t run_{};  ///< number of the run at work, from 1
  Published published_;
  TurnTraces traces_;
  double longest_step_{};  ///< between samples of one piece [s]
};

}  // namespace hammer_loads
