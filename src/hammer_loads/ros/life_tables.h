/// Turn loads, load cycles and alarms of a recording as tables.
#pragma once

#include <hammer_loads/Alarms.h>
#include <hammer_loads/LoadCycles.h>
#include <hammer_loads/TurnLoads.h>

#include <cstdint>

#include "hammer_loads/pipeline/budget.h"
#include "hammer_loads/ros/hammer_bridge.h"
#include "hammer_loads/tables/table_writer.h"

namespace hammer_loads {

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
  void writeCount(std::size_t number, const ChannelCycles& message, const life::LedgerChannel& channel);

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

}  // namespace hammer_loads
