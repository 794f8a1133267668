#include "hammer_loads/ros/life_diagnostics.h"

#include <cmath>

#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

using diagnostic_msgs::DiagnosticStatus;

std::optional<Warning> ledgerWarning(const life::LiveLedger* ledger) {
  if (ledger == nullptr) return std::nullopt;
  const std::string problem = ledger->state().problem;
  if (problem.empty()) return std::nullopt;
  return Warning{"ledger", "life_ledger: " + problem, true};
}

void describeLife(const LifeFlow& life, const life::LiveLedger* ledger,
                  diagnostic_updater::DiagnosticStatusWrapper& status) {
  const LifeFollower& follower = life.follower();
  status.summary(DiagnosticStatus::OK, follower.since() ? "counting" : "waits for loads");
  for (const Warning& warning : life.warnings()) status.mergeSummary(DiagnosticStatus::WARN, warning.text);
  if (const auto warning = ledgerWarning(ledger)) status.mergeSummary(DiagnosticStatus::WARN, warning->text);
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
  status.add("ledger", ledger == nullptr ? "none" : ledger->path());
  if (ledger != nullptr) status.add("pieces not in the ledger yet", ledger->state().waiting);
}

void describeLimits(const LimitWatch& watch, diagnostic_updater::DiagnosticStatusWrapper& status) {
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

void describeReference(const ReferenceComparison& reference, diagnostic_updater::DiagnosticStatusWrapper& status) {
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
