/// The hull wrench inside the step between two samples, where a series of samples misses its extremes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// Inputs of the wrench other than the crank's motion.
struct StepLoad {
  const HullModel& model;
  const DriveReaction& drive;
  const HullMotion& hull;  ///< over the step

  HullWrench at(const CrankEstimate& crank) const noexcept { return hullWrench(model, drive, motionOf(crank), hull); }
};

/// A part of a step without a blow.
struct SmoothSpan {
  double from{}, to{};          ///< after the step's start [s]
  CrankEstimate begin, finish;  ///< crank at both ends
};

/// Instants in a short span where a component of the wrench is least or largest, in order of time [s].
struct ExtremeInstants {
  std::size_t count{};
  std::array<double, 3> time;
};

/// Finds at most one per component. A component that rises at one end of the span and falls at the other has its
/// extreme where the cubic through values and slopes of both ends has it; error: some 1e-4 of the span.
ExtremeInstants extremeInstants(const StepLoad& load, const CrankStep& step, const SmoothSpan& span) noexcept;

/// Place of a wrench in a step: at a time after its start [s], or exactly on one side of a passage of the blow.
struct StepPlace {
  double time{};
  const CrankStep::Passage* passage{};  ///< null: at the time
  Side side{};                          ///< side of the passage

  std::optional<CrankPaths> paths(const CrankStep& step) const noexcept {
    return passage != nullptr && !passage->smooth ? step.pathsAtSide(*passage, side) : step.paths(time);
  }
};

/// Calls at(place, crank) in order of time where a component of the wrench is extreme inside the step, and on both
/// sides of each blow. Calls turn(time) between them where a blow may end a revolution. Times are after the step's
/// start [s]. One of two extremes closer than 1.25 ms may be missed; points on the way to them are given as well.
template <typename OnPlace, typename OnTurn>
void forEachStepExtreme(const StepLoad& load, const CrankStep& step, const OnPlace& at, const OnTurn& turn) noexcept {
  const auto alongSpan = [&](const SmoothSpan& span) {
    if (!(span.to > span.from)) return;
    const int count = partsOf(span.to - span.from, kPulseStep);
    SmoothSpan part{span.from, span.from, span.begin, span.begin};
    for (int i = 1; i <= count; ++i) {
      const bool last = i == count;
      part.from = part.to, part.begin = part.finish;
      part.to = last ? span.to : span.from + (span.to - span.from) * i / count;
      part.finish = last ? span.finish : step.at(part.to);
      const ExtremeInstants extremes = extremeInstants(load, step, part);
      for (std::size_t k = 0; k < extremes.count; ++k) at(StepPlace{extremes.time[k]}, step.at(extremes.time[k]));
      if (!last) at(StepPlace{part.to}, part.finish);
    }
  };
  SmoothSpan span{0.0, 0.0, step.at(0.0), {}};
  for (const CrankStep::Passage& passage : step) {
    const Side first = passage.forward ? Side::kBeforeBlow : Side::kAfterBlow;
    const Side second = passage.forward ? Side::kAfterBlow : Side::kBeforeBlow;
    const auto on = [&](Side side) { return passage.smooth ? step.at(passage.time) : step.atSide(passage, side); };
    span.to = passage.time;
    span.finish = on(first);
    alongSpan(span);
    at(StepPlace{passage.time, &passage, first}, span.finish);
    if (passage.may_strike) turn(passage.time);
    span.begin = on(second);
    span.from = passage.time;
    at(StepPlace{passage.time, &passage, second}, span.begin);
  }
  span.to = step.length();
  span.finish = step.at(span.to);
  alongSpan(span);
}

}  // namespace hammer_loads
