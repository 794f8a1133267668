/// Tables of a ledger, checks whether a file is one, and changes of it within one transaction.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"

namespace hammer_loads::life {

constexpr int kLedgerVersion = 1;

/// False for an empty database; a problem for anything but that and a ledger of this version.
bool isLedger(Database& database);

/// Begins a transaction, as the only writer, in which the file is a ledger: a new or empty file gets its tables.
/// Anything else is left as it is, with a problem.
void beginAsLedger(Database& database);

/// A problem for the first value that no run can have written. Reads the whole ledger.
void checkLedger(Database& database);

/// Begins a transaction for reading; a problem for anything but a ledger of this version.
void beginReading(Database& database);

/// Channels of an epoch, in the order of LedgerMachine::channels. A problem for a grid or curve that none has.
std::vector<LedgerChannel> channelsOf(Database& database, std::int64_t epoch);

/// A run as the ledger has it.
struct RunRow {
  std::int64_t run{}, epoch{};
  std::int64_t pieces{};  ///< commits of its writer
  std::string name;
  std::string parameters{};  ///< parameters as in RunId
  std::uint64_t messages{};  ///< messages as in LifePiece, of all its pieces
};

/// Runs that have the name, or samples that have one of these marks and the same machine; in their order.
std::vector<RunRow> runsLike(Database& database, const std::string& name, const LedgerMachine& machine = {},
                             const std::vector<std::int64_t>& marks = {});
/// Returns true if all marks of the run are among these. Reads the marks of every run.
bool isCovered(Database& database, const RunRow& run, const std::vector<std::int64_t>& marks);

/// Removes the `replaced` runs and begins the run: at the place of the first of them if its epoch has the same machine
/// and grids, otherwise at the end, in a new epoch if the machine differs from the latest.
RunRow beginRun(Database& database, const LedgerMachine& machine, const RunId& id, const std::vector<RunRow>& replaced);
/// Removes a run, and its epoch if that has no other runs.
void removeRun(Database& database, const RunRow& run);

/// Adds counts of one day; the residue replaces the run's earlier one.
void addPiece(Database& database, const RunRow& run, const LifePiece& piece);
/// The run's row after a commit, and what is new of its marks.
void setRun(Database& database, const RunRow& run, std::int64_t pieces, std::uint64_t messages,
            const std::vector<std::int64_t>& marks);

}  // namespace hammer_loads::life
