/// Results of runs into a SQLite file, in one transaction.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/tables/channel_record.h"
#include "hammer_loads/tables/run_record.h"
#include "hammer_loads/tables/table_schema.h"
#include "hammer_loads/tables/turn_traces.h"

namespace hammer_loads {

/// Values of a turn's or a blow's columns, in their order.
struct TurnRow {
  std::uint64_t turn{};
  std::int64_t stamp{};  ///< [ns]
  const std::vector<double>& values;
};

/// Oil of a boom's cylinder or vibration mode at the end of a revolution; cylinder: its name; mode: from 1.
struct BoomCylinderRow {
  std::uint64_t turn{};
  std::string cylinder;
  double joint_angle{};             ///< [rad]
  double stiffness{}, deviation{};  ///< over that of the boom file, standard [-]
  bool doubtful{};                  ///< something else than oil damps the boom
};
struct BoomModeRow {
  std::uint64_t turn{};
  std::int64_t mode{};
  double frequency{}, frequency_std{};  ///< [Hz]
  double damping{}, damping_std{};      ///< [-]
};

/// An alarm from the turn that raised it to the last one of the same level.
struct AlarmRow {
  std::string name, unit;
  std::int64_t level{};
  double value{}, std{}, limit{};  ///< value: farthest beyond the limit
  std::int64_t since{}, until{};   ///< stamps of those turns [ns]
  std::uint64_t turns{};
};

/// One component of the computed load beside a measured one (ReferenceFigures).
struct ReferenceRow {
  std::string component, unit;
  std::uint64_t samples{};
  double rms{}, rms_error{}, bias{}, scale{}, correlation{}, within_two_std{};
};

/// No function throws: problem() returns the first error, after which all calls have no effect.
class TableWriter {
 public:
  /// The file must be empty.
  TableWriter(const std::string& file, std::vector<TableColumn> turn, std::vector<TableColumn> blow);

  /// Run numbers begin with 1. The columns `turn` are the rows' own.
  void turn(std::int64_t run, const TurnRow& row);
  void blow(std::int64_t run, const TurnRow& row);
  void turnLoad(std::int64_t run, const TurnLoad& load);
  /// number: as in the turns' loads.
  void channel(std::int64_t run, std::int64_t number, const ChannelRecord& record);
  void boomCylinder(std::int64_t run, const BoomCylinderRow& row);
  void boomMode(std::int64_t run, const BoomModeRow& row);
  void alarm(std::int64_t run, const AlarmRow& row);
  void reference(std::int64_t run, const ReferenceRow& row);
  void budget(std::int64_t run, const BudgetRow& row);
  void traces(std::int64_t run, const TurnTraces& traces);
  void run(std::int64_t run, const RunRecord& record);
  /// Ends the transaction: all of the file is written.
  void finish();

  /// First error in one line, without the file's name; empty without an error.
  const std::string& problem() const { return database_.problem(); }

 private:
  using Statement = life::Database::Statement;
  struct TurnTable {
    TurnTable(life::Database& database, const std::string& name, std::vector<TableColumn> columns);
    void add(std::int64_t run, const TurnRow& row);
    std::vector<TableColumn> columns;
    Statement insert;
  };

  void count(std::int64_t run, std::int64_t channel, const ChannelRecord& record);
  void trace(std::int64_t run, const std::string& kind, const TurnTrace& trace);

  life::Database database_;
  std::optional<TurnTable> turns_, blows_;
  std::optional<Statement> turn_load_, boom_cylinder_, boom_mode_;
};

}  // namespace hammer_loads
