/// Writer of a recording's results as tables, from the messages of the hammer's outputs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/ros/bag_report.h"
#include "hammer_loads/ros/hammer_bridge.h"
#include "hammer_loads/ros/life_tables.h"
#include "hammer_loads/ros/number_fields.h"
#include "hammer_loads/tables/table_writer.h"
#include "hammer_loads/tables/turn_traces.h"

namespace hammer_loads {

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
