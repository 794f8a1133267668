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
};

std::optional<RunRow> findRun(Database& database, const std::string& name);

/// Ends what never ended, begins an epoch where the machine is another one, and adds the run.
RunRow beginRun(Database& database, const LedgerMachine& machine, const std::string& name);

/// Counts of one day; the residue takes the place of the run's earlier one.
void addPiece(Database& database, const RunRow& run, const LifePiece& piece);

void setPieces(Database& database, const RunRow& run, std::int64_t pieces);

/// Joins the run's residue to that of all before it.
void endRun(Database& database, const RunRow& run);

}  // namespace hammer_loads::life
