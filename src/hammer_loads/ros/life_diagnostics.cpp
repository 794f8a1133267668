#include <cmath>

#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/ros/node_diagnostics.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

using diagnostic_msgs::DiagnosticStatus;

std::optional<Warning> NodeDiagnostics::ledgerWarning() const {
  if (ledger_ == nullptr) return std::nullopt;
  const std::string problem = ledger_->state().problem;
  if (problem.empty()) return std::nullopt;
  return Warning{"ledger", "life_ledger: " + problem, true};
}

/// Describes the start of the count, its samples, their saturation and the state of the ledger.
void NodeDiagnostics::describeLife(Status& status) {
  const LifeFlow& life = bridge_.life();
  const LifeFollower& follower = life.follower();
  status.summary(DiagnosticStatus::OK, follower.since() ? "counting" : "waits for loads");
  for (const Warning& warning : life.warnings()) status.mergeSummary(DiagnosticStatus::WARN, warning.text);
  if (const auto warning = ledgerWarning()) status.mergeSummary(DiagnosticStatus::WARN, warning->text);
  if (follower.since()) status.add("counting since [s]", seconds(*follower.since()));
  status.add("period [s]", seconds(life.period()));
  const std::vector<life::SampleTally> tallies = life.tallies();
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    const std::string& channel = follower.recorder().channels()[i];
    status.add(channel + ": samples", tallies[i].counted);
    if (tallies[i].skipped > 0) status.add(channel + ": skipped", tallies[i].skipped);
    if (tallies[i].below > 0) status.add(channel + ": below full scale", tallies[i].below);
    if (tallies[i].above > 0) status.add(channel + ": above full scale", tallies[i].above);
    if (tallies[i].gaps > 0) status.add(channel + ": gaps", tallies[i].gaps);
  }
  status.add("ledger", ledger_ == nullptr ? "none" : ledger_->path());
  if (ledger_ != nullptr) status.add("pieces not in the ledger yet", ledger_->state().waiting);
}

/// Describes each limit with value, standard deviation and bounds; WARN or ERROR if one is exceeded.
void NodeDiagnostics::describeLimits(Status& status) {
  const LimitWatch& watch = *bridge_.limits();
  status.summary(DiagnosticStatus::OK, "no limit is exceeded");
  for (std::size_t i = 0; i < watch.limits().size(); ++i) {
    const Limit& limit = watch.limits()[i];
    const LimitState& state = watch.states()[i];
    const std::string unit = " [" + limit.unit + "]";
    if (state.level != AlarmLevel::kOk)
      status.mergeSummary(
          static_cast<std::uint8_t>(state.level),
          format("%s: %.4g %s is %s the limit %.4g %s", limit.name.c_str(), state.value, limit.unit.c_str(),
                 limit.is_least ? "below" : "above", state.limit, limit.unit.c_str()));
    status.add(limit.name + unit, state.value);
    if (!std::isnan(state.std)) status.add(limit.name + " std" + unit, state.std);
    if (!std::isnan(limit.warn)) status.add(limit.name + " warn" + unit, limit.warn);
    if (!std::isnan(limit.error)) status.add(limit.name + " error" + unit, limit.error);
    if (state.level != AlarmLevel::kOk) status.add(limit.name + " since [s]", seconds(state.since));
  }
}

/// Describes the agreement of the computed loads with the measured ones.
void NodeDiagnostics::describeReference(Status& status) {
  const ReferenceComparison& reference = bridge_.comparison();
  status.summary(DiagnosticStatus::OK, reference.received() > 0 ? "compared" : "no measured load");
  status.add("measured loads", reference.received());
  status.add("left out", reference.leftOut());
  for (std::size_t i = 0; i < ReferenceComparison::kComponents; ++i) {
    const ReferenceFigures figures = reference.figures(i);
    if (figures.samples == 0) continue;
    const std::string name = ReferenceComparison::kNames[i],
                      unit = " [" + life::unitOf(ReferenceComparison::kNames[i]) + "]";
    status.add(name + ": rms error" + unit, figures.rms_error);
    status.add(name + ": bias" + unit, figures.bias);
    status.add(name + ": scale", figures.scale);
    status.add(name + ": correlation", figures.correlation);
  }
}

}  // namespace hammer_loads
