/// A simulated session through the pipeline, judged by its truth.
#pragma once

#include "hammer_loads/bench/session_errors.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::accuracy {

struct SessionRun {
  std::vector<WrenchAt> wrenches;  ///< at the stamps they are published with
  std::vector<double> accepted;    ///< stamps of these and of the samples withheld beside the blow [s]
  std::vector<BlowAt> blows;
  SampleCounts counts;
};

/// Reads a session into a pipeline, joint states in their place between the crank samples. start: stamp of t = 0 [ns].
SessionRun runSession(const simulation::Session& session, std::int64_t start, const Mechanism& mechanism,
                      const PipelineSettings& settings);

/// The blows' energy as a table's cell, and in JSON: null where none is known.
std::string energyCell(const SessionErrors& errors, int digits);
std::string energyJson(const SessionErrors& errors);

/// Judged from 3 s after the start to 3 s before the end, without the two turns after each drop-out.
SessionErrors judge(const SessionRun& run, const simulation::Session& session,
                    const simulation::MachineSettings& machine);

/// Judges by the truth at the published stamps, for sessions whose stamps are refitted. shift: of all stamps against
/// the instants, which no sequence shows [s].
SessionErrors judgeAtStamps(const SessionRun& run, const simulation::Session& session,
                            const simulation::MachineSettings& machine, double shift);

}  // namespace hammer_loads::accuracy
