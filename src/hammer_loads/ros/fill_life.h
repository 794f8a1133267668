/// Messages of turn loads and load cycles. Names and room are filled once.
#pragma once

#include <hammer_loads/LoadCycles.h>
#include <hammer_loads/TurnLoads.h>

#include <string>
#include <vector>

#include "hammer_loads/life/ledger_machine.h"
#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/turn_loads.h"
#include "hammer_loads/pipeline/sample_result.h"

namespace hammer_loads {

void prepareTurnLoads(const std::vector<std::string>& channels, TurnLoads& message);
/// No allocation.
void fillTurnLoads(const TurnEnd& end, const life::TurnLoads& turn, TurnLoads& message);

/// total: since the count began, at `since`. machine: source of the channels' S-N curves. Not for the hot path.
void fillLoadCycles(StampNs since, const life::LifePiece& total, const life::LedgerMachine& machine,
                    LoadCycles& message);

}  // namespace hammer_loads
