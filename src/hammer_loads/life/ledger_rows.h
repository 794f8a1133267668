/// Rows that both the writer and the reader of a ledger need.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"

namespace hammer_loads::life {

struct ChannelRow {
  std::int64_t id{};
  LedgerChannel channel;
};

/// Of an epoch, in the order of LedgerMachine::channels. A problem for a grid or curve that none has.
std::vector<ChannelRow> channelsOf(Database& database, std::int64_t epoch);

}  // namespace hammer_loads::life
