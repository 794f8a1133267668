/// Tables of a ledger, and what makes a file one.
#pragma once

#include "hammer_loads/life/database.h"

namespace hammer_loads::life {

constexpr int kLedgerVersion = 3;

/// Begins a transaction in which the file is a ledger of this version: a new or empty file gets its tables, an older
/// ledger is upgraded. Anything else is left as it is, with a problem.
void beginAsLedger(Database& database);

/// Begins a transaction for reading; a problem for anything but a ledger of this version or an older one.
void beginReading(Database& database);

}  // namespace hammer_loads::life
