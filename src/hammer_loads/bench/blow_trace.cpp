#include "hammer_loads/bench/blow_trace.h"

#include <algorithm>

#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kRodKnown = 5.0;                        // [s]
constexpr double kTraceFrom = -0.005, kTraceTo = 0.045;  // [s]
constexpr int kFineSteps = 500;

ForceTrace estimated(const simulation::Session& session, const simulation::MachineSettings& machine,
                     const Settings& settings, Level level, double touch) {
  PipelineSettings pipeline = settings.pipeline;
  pipeline.level = level;
  ForceTrace trace;
  for (const WrenchAt& w : runSession(session, machine.start_stamp, settings.mechanism, pipeline).wrenches) {
    if (w.time < touch + kTraceFrom || w.time > touch + kTraceTo) continue;
    trace.time.push_back(w.time - touch);
    trace.force_z.push_back(w.force_z), trace.deviation.push_back(w.force_z_std);
  }
  return trace;
}

ForceTrace fine(const simulation::MachineSettings& machine, double touch) {
  std::vector<double> times;
  for (int i = 0; i <= kFineSteps; ++i) times.push_back(touch + kTraceFrom + i * (kTraceTo - kTraceFrom) / kFineSteps);
  ForceTrace trace;
  for (const simulation::CrankTruth& truth : simulation::truthAt(machine, times))
    trace.time.push_back(truth.time - touch), trace.force_z.push_back(truth.load.force_z);
  return trace;
}

std::string list(const char* name, const std::vector<double>& values, double unit) {
  std::string text;
  for (const double value : values) text += format("%s%.5g", text.empty() ? "" : ", ", value / unit);
  return format("\"%s\": [", name) + text + "]";
}

std::string jsonOf(const ForceTrace& trace) {
  return "{" + list("time_ms", trace.time, 1e-3) + ", " + list("force_z", trace.force_z, 1.0) + ", " +
         list("deviation_N", trace.deviation, 1.0) + "}";
}

}  // namespace

BlowTrace blowTrace(const Settings& settings) {
  const ElasticKind kind = elasticKinds(settings.mechanism.parameters())[1];
  const simulation::Session session = simulation::recordSession(kind.machine);
  const double touch = std::find_if(session.blows.begin(), session.blows.end(), [](const simulation::BlowTruth& blow) {
                         return blow.time > kRodKnown;
                       })->time;
  const auto at = [&](Level level) { return estimated(session, kind.machine, settings, level, touch); };
  return {kind.name, fine(kind.machine, touch), at(Level::kLinkage), at(Level::kElastic)};
}

std::string json(const BlowTrace& trace) {
  return "{\"machine\": \"" + trace.machine + "\", \"truth\": " + jsonOf(trace.truth) +
         ",\n  \"linkage\": " + jsonOf(trace.linkage) + ",\n  \"elastic\": " + jsonOf(trace.elastic) + "}";
}

}  // namespace hammer_loads::accuracy
