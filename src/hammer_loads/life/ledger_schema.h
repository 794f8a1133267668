/// Tables of a ledger, checks whether a file is one, and changes of it within one transaction.
#pragma once

#include <cstdint>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/life_settings.h"

namespace hammer_loads::life {

/// False for an empty database; a problem for anything but that and a ledger of this version.
bool isLedger(Database& database);

/// Begins a transaction, as the only writer, in which the file is a ledger: a new or empty file gets its tables.
/// Anything else is left as it is, with a problem.
void beginAsLedger(Database& database);

/// A problem for the first value that no run can have written. Reads the whole ledger.
void checkLedger(Database& database);

/// Channels of an epoch, in the order of LedgerMachine::channels. A problem for a grid or curve that none has.
std::vector<CountedChannel> channelsOf(Database& database, std::int64_t epoch);

}  // namespace hammer_loads::life
