/// Changes of a ledger within one transaction.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"

namespace hammer_loads::life {

/// A run as the ledger has it.
struct RunRow {
  std::int64_t run{}, epoch{}, pieces{};
  bool ended{};
  std::string name;
  bool apart{};              ///< false: counted by version 1, in one sum with others
  std::string parameters{};  ///< as RunId::parameters
  std::uint64_t messages{};  ///< as LifePiece::messages, of all its pieces
};

std::optional<RunRow> findRun(Database& database, const std::string& name);

/// Runs that have the name, or samples that have one of these marks and the same machine; in their order.
std::vector<RunRow> runsLike(Database& database, const LedgerMachine& machine, const RunId& id,
                             const std::vector<std::int64_t>& marks);
/// Whether all marks of the run are among these.
bool holdsMarksOf(Database& database, const RunRow& run, const std::vector<std::int64_t>& marks);

/// Begins an epoch where the machine is another one, and adds the run.
RunRow beginRun(Database& database, const LedgerMachine& machine, const RunId& id);
/// Takes these out and begins the run, at the place of the first one where its epoch is of the same machine and grids.
RunRow replaceRuns(Database& database, const LedgerMachine& machine, const RunId& id, const std::vector<RunRow>& runs);

/// Takes a run out; an epoch without runs goes, too.
void removeRun(Database& database, const RunRow& run);
/// Takes its counts out.
void emptyRun(Database& database, std::int64_t run);

/// Counts of one day; the residue takes the place of the run's earlier one.
void addPiece(Database& database, const RunRow& run, const LifePiece& piece);
void setRun(Database& database, const RunRow& run, std::int64_t pieces, std::uint64_t messages, bool ended);
void addMarks(Database& database, const RunRow& run, const std::vector<std::int64_t>& marks, std::size_t from);

}  // namespace hammer_loads::life
