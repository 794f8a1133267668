#include "hammer_loads/bench/elastic_table.h"

#include <algorithm>

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

using simulation::CrankTruth;
using simulation::MachineSettings;

constexpr double kFrom = 4.0;                       // [s]: the rod is known by then
constexpr double kLeftOut = 3.0;                    // before the end [s]
constexpr double kLargestLoad = 2e5, kFine = 1e-4;  // [N], [s]
constexpr int kGrid = 4096;
constexpr double kAfterFrom = 0.006, kAfterTo = 0.040;  // interval of the vibration, from the first touch [s]

/// Gathers one part of the turn.
struct Gathering {
  std::array<FigureErrors, 3> errors, truth;
  int count{};
  void add(const WrenchAt& estimate, const Eigen::Vector3d& right) {
    const double value[]{estimate.force_x, estimate.force_z, estimate.torque_y};
    const double deviation[]{estimate.force_x_std, estimate.force_z_std, estimate.torque_y_std};
    for (std::size_t i = 0; i < 3; ++i) {
      const double is = right[static_cast<Eigen::Index>(i)];
      errors[i].add(value[i] - is, deviation[i]), truth[i].add(is, 0.0);
    }
    ++count;
  }
  /// scale: of the root mean squares; that of the truth without one.
  PartErrors over(const std::optional<Eigen::Vector3d>& scale = {}) const {
    PartErrors e;
    e.count = count;
    for (std::size_t i = 0; i < 3; ++i) {
      e.scale[i] = scale ? (*scale)[static_cast<Eigen::Index>(i)] : truth[i].result().rms;
      const FigureErrors::Result result = errors[i].result(e.scale[i]);
      e.rms[i] = result.rms, e.covered[i] = result.covered;
    }
    return e;
  }
};

ElasticErrors judgeParts(const SessionRun& run, const simulation::Session& session, const MachineSettings& machine) {
  const std::vector<CrankTruth> truth = simulation::truthAt(machine, run.accepted);
  Gathering whole, strike, after;
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();
  const auto isJudged = [&](double time) { return time >= kFrom && time <= machine.duration - kLeftOut; };
  const auto readings =
      std::count_if(session.truth.begin(), session.truth.end(), [&](const CrankTruth& t) { return isJudged(t.time); });
  int wrenches = 0;
  auto published = run.wrenches.begin();
  for (std::size_t k = 0; k < run.accepted.size(); ++k) {
    const double time = run.accepted[k];
    const bool is_withheld = published == run.wrenches.end() || published->time != time;
    const WrenchAt wrench = is_withheld ? WrenchAt{} : *published++;
    if (!isJudged(time)) continue;
    const Eigen::Vector3d values = wrenchOf(truth[k]);
    largest = largest.cwiseMax(values.cwiseAbs());
    if (is_withheld) continue;
    ++wrenches;
    whole.add(wrench, values);
    if (truth[k].angle >= kPi) strike.add(wrench, values);
    const double since = sinceBlow(session.blows, time);
    if (since >= kAfterFrom && since <= kAfterTo) after.add(wrench, values);
  }
  ElasticErrors errors{whole.over(largest), strike.over(largest), after.over(), {}, {}, 0.0};
  errors.withheld = 1.0 - static_cast<double>(wrenches) / static_cast<double>(readings);
  return errors;
}

/// Judges the ledger's count of Fz against the truth at ten times the sample rate, as impacts in worn pins last 0.3 ms.
/// Withheld loads act on the hull all the same.
void judgeLedger(const Settings& settings, const PipelineSettings& pipeline, const simulation::Session& session,
                 const MachineSettings& machine, ElasticErrors& errors) {
  SessionPlayer player(settings.mechanism, pipeline, {}, session);
  life::LifeSettings counted;
  counted.channels = {{"hull_wrench/force_z", *life::LoadGrid::make(-kLargestLoad, kLargestLoad, kGrid).value}};
  std::optional<LifeFollower> ledger;
  const double to = machine.duration - kLeftOut;
  player.playTo(to, [&](double time, const SampleResult&) {
    if (time < kFrom) return;
    if (!ledger) ledger.emplace(player.pipeline, counted);
    ledger->follow();
  });
  std::vector<double> times;
  for (int i = 0; kFrom + i * kFine < to; ++i) times.push_back(kFrom + i * kFine);
  life::ExactCycles all, but_touches;
  for (const CrankTruth& t : simulation::truthAt(machine, times)) {
    all.add(t.load.force_z);
    if (!t.touches()) but_touches.add(t.load.force_z);
  }
  const life::LifePiece piece = ledger->take();
  errors.life = figureOf(piece.counts[0], but_touches);
  errors.life_with_touch = figureOf(piece.counts[0], all);
}

/// Everything a little, and a usual sensor.
void makeTogether(MachineSettings& s) {
  makeTypical(s);
  s.rod = {8e8, 0.3, 1e-4};
  s.strike.tool_spread = 1e-3;
  s.drive.ripple = 0.03;
  s.hammer.rocker_mass *= 1.015;
  s.hammer.rocker_inertia_about_pivot *= 0.99;
  s.hammer.crank_mass *= 1.02;
  s.hammer.rod_mass *= 0.98;
}

/// Force z on the hull [N] by the time from the first touch [s]; of an estimate with its standard deviation [N].
struct ForceTrace {
  std::vector<double> time, force_z, deviation;
};

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

double sinceBlow(const std::vector<simulation::BlowTruth>& blows, double time) {
  const auto next = std::upper_bound(blows.begin(), blows.end(), time,
                                     [](double t, const simulation::BlowTruth& b) { return t < b.time; });
  return next == blows.begin() ? kInfinity : time - std::prev(next)->time;
}

std::vector<ElasticKind> elasticKinds(const HammerParameters& hammer, std::uint64_t seed) {
  MachineSettings base = simulation::workingMo100();
  base.hammer = hammer;
  base.level = Level::kLinkage;
  base.seed = seed;
  const auto rod = [&](double stiffness, double damping_ratio, double play) {
    MachineSettings s = base;
    s.rod = {stiffness, damping_ratio, play};
    return s;
  };
  MachineSettings lively = rod(1e9, 0.6, 0.0);  // the rocker keeps 0.55 of its speed, in a contact of 1.3 ms
  lively.strike.contact_stiffness = 1.2e8, lively.strike.rock_strength = 3e5;
  MachineSettings together = base;
  makeTogether(together);
  return {{"elastic damped: 1e9 N/m, 0.6", rod(1e9, 0.6, 0.0)},
          {"elastic average: 1e9 N/m, 0.2", rod(1e9, 0.2, 0.0)},
          {"elastic dead: 1e9 N/m, 3", rod(1e9, 3.0, 0.0)},
          {"elastic dead, clearance 0.2 mm", rod(1e9, 3.0, 2e-4)},
          {"elastic, 0.3, clearance 0.5 mm", rod(1e9, 0.3, 5e-4)},
          {"elastic, lively rock: 1e9 N/m, 0.6", lively},
          {"elastic together", together}};
}

ElasticErrors elasticErrors(const Settings& settings, const ElasticKind& kind, Level level) {
  const simulation::Session session = simulation::recordSession(kind.machine);
  PipelineSettings pipeline = settings.pipeline;
  pipeline.level = level;
  const SessionRun run = runSession(session, kind.machine.start_stamp, settings.mechanism, pipeline);
  ElasticErrors errors = judgeParts(run, session, kind.machine);
  judgeLedger(settings, pipeline, session, kind.machine, errors);
  return errors;
}

std::vector<ElasticRow> elasticTable(const Settings& settings, const MachineChoice& choice) {
  std::vector<ElasticRow> rows;
  for (const ElasticKind& kind : elasticKinds(settings.mechanism.parameters(), choice.seed)) {
    for (const Level level : {Level::kRocker, Level::kLinkage, Level::kElastic})
      if (choice.has(kind.name + ' ' + nameOf(level)))
        rows.push_back({kind.name, level, elasticErrors(settings, kind, level)});
  }
  return rows;
}

Table tableOf(const std::vector<ElasticRow>& rows) {
  Table table(4);
  const auto add = [&](const char* part, int digits, const PartErrors& e, const char* rms) {
    const auto three = [](const std::array<double, 3>& v) { return format("[%.6g, %.6g, %.6g]", v[0], v[1], v[2]); };
    table.cell(rms, percents(digits, e.rms));
    table.cell("within two standard deviations", percents(0, e.covered));
    table.field(part, "{\"rms\": " + three(e.rms) + ", \"covered\": " + three(e.covered) +
                          ", \"scale\": " + three(e.scale) + format(", \"samples\": %d}", e.count));
  };
  for (const ElasticRow& row : rows) {
    const ElasticErrors& e = row.errors;
    table.beginRow();
    table.text("machine", "machine", row.machine);
    table.text("level", "level", nameOf(row.level));
    table.percent("withheld", "withheld", 1, e.withheld);
    table.field("life", json(e.life));
    table.field("life_with_touch", json(e.life_with_touch));
    add("whole", 2, e.whole, "whole revolution: rms Fx, Fz, moment");
    add("strike", 2, e.strike, "180 to 360 deg: rms");
    add("after", 0, e.after, "6 to 40 ms after the blow: rms over the truth's");
    table.cell("true Fz there", format("%.0f N rms", e.after.scale[1]));
  }
  return table;
}

std::string blowTrace(const Settings& settings) {
  const ElasticKind kind = elasticKinds(settings.mechanism.parameters())[1];
  const simulation::Session session = simulation::recordSession(kind.machine);
  const double touch = std::find_if(session.blows.begin(), session.blows.end(), [](const simulation::BlowTruth& blow) {
                         return blow.time > kRodKnown;
                       })->time;
  const auto at = [&](Level level) { return jsonOf(estimated(session, kind.machine, settings, level, touch)); };
  return "{\"machine\": \"" + kind.name + "\", \"truth\": " + jsonOf(fine(kind.machine, touch)) +
         ",\n  \"linkage\": " + at(Level::kLinkage) + ",\n  \"elastic\": " + at(Level::kElastic) + "}";
}

}  // namespace hammer_loads::accuracy
