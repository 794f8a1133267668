/// A node's report of its load cycles, limits and reference.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <optional>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/pipeline/limit_watch.h"
#include "hammer_loads/pipeline/reference.h"
#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/ros/life_flow.h"

namespace hammer_loads {

/// Since when, how often, saturation, state of the ledger (null: none is kept).
void describeLife(const LifeFlow& life, const life::LiveLedger* ledger,
                  diagnostic_updater::DiagnosticStatusWrapper& status);

/// Each limit with value, standard deviation and bounds; WARN or ERROR where one is exceeded.
void describeLimits(const LimitWatch& watch, diagnostic_updater::DiagnosticStatusWrapper& status);

/// Agreement of the computed loads with the measured ones.
void describeReference(const ReferenceComparison& reference, diagnostic_updater::DiagnosticStatusWrapper& status);

/// Warning of pieces that the ledger cannot accept at present, if there are any.
std::optional<Warning> ledgerWarning(const life::LiveLedger* ledger);

}  // namespace hammer_loads
