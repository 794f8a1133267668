#include "hammer_loads/bench/scene_table.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kSlow = 1.0 / 60.0;               // [s]
constexpr int kInMean = 168;                       // points of the truth in a mean, some 0.1 ms apart
constexpr double kKnownFrom = 4.0, kBefore = 3.0;  // after the start, before the end [s]
constexpr double kOneBlow = 0.02;                  // [s]

/// Truth and estimate of what a session is judged by.
struct Judge {
  const simulation::MachineSettings& machine;
  const simulation::Session& session;
  std::vector<WrenchOutput> means;
  FigureErrors energy, restitution;

  double seconds(StampNs stamp) const { return 1e-9 * static_cast<double>(stamp - machine.start_stamp); }
  bool isJudged(double time) const { return time >= kKnownFrom && time <= machine.duration - kBefore; }
  void take(const SampleResult& result) {
    for (std::size_t i = 0; i < result.turn_ends; ++i) takeBlow(result.ends[i]);
    if (result.refusal) return;
    for (const WrenchOutput& output : result.outputs)
      if (isJudged(seconds(output.stamp)) && std::abs(output.interval - kSlow) < 1e-4) means.push_back(output);
  }
  void takeBlow(const TurnEnd& end) {
    const double time = seconds(end.stamp);
    const auto blow = std::find_if(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& truth) {
      return std::abs(truth.time - time) < kOneBlow;
    });
    if (!isJudged(time) || blow == session.blows.end() || end.blow.impossible) return;
    const simulation::Strike& strike = blow->strike;
    energy.addRelative(end.blow.energy, strike.energy, end.blow.energy_std);
    restitution.add(end.blow.restitution + strike.rocker_speed_after / strike.rocker_speed_before,
                    end.blow.restitution_std);
  }
  std::array<FigureErrors::Result, 3> slow() const {
    std::vector<double> times;
    for (const WrenchOutput& mean : means)
      for (int i = 0; i < kInMean; ++i)
        times.push_back(seconds(mean.stamp) + mean.interval * ((i + 0.5) / kInMean - 1.0));
    const std::vector<simulation::CrankTruth> truth = simulation::truthAt(machine, times);
    std::array<FigureErrors, 3> errors;
    Eigen::Vector3d largest = Eigen::Vector3d::Zero();
    auto at = truth.begin();
    for (const WrenchOutput& mean : means) {
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      bool touches = false;
      for (int i = 0; i < kInMean; ++i, ++at) {
        right += Eigen::Vector3d(at->load.force_x, at->load.force_z, at->load.torque_y + at->drive_reaction_y);
        touches = touches || at->touches();
      }
      if (touches) continue;
      right /= kInMean;
      largest = largest.cwiseMax(right.cwiseAbs());
      const Eigen::Vector3d error = vectorOf(mean.wrench) - right, said = vectorOf(mean.deviation.wrench);
      for (Eigen::Index k = 0; k < 3; ++k) errors[static_cast<std::size_t>(k)].add(error[k], said[k]);
    }
    std::array<FigureErrors::Result, 3> result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = errors[k].result(largest[static_cast<Eigen::Index>(k)]);
    return result;
  }
};

}  // namespace

SceneRow sceneRow(const Settings& settings, const ElasticKind& kind, Level level) {
  const simulation::Session session = simulation::recordSession(kind.machine);
  PipelineSettings pipeline = settings.pipeline;
  pipeline.level = level;
  pipeline.output = OutputKind::kMean;
  pipeline.output_rate = 1.0 / kSlow;
  SessionPlayer player(settings.mechanism, pipeline, {}, session);
  Judge judge{kind.machine, session, {}, {}, {}};
  player.playTo(kInfinity, [&](double, const SampleResult& result) { judge.take(result); });
  SceneRow row{kind.name, level, judge.slow(), {}, judge.energy.result(), judge.restitution.result()};
  row.energy_bias = judge.energy.bias(), row.restitution_bias = judge.restitution.bias();
  return row;
}

std::vector<SceneRow> sceneTable(const Settings& settings, const std::vector<ElasticRow>& elastic) {
  const std::vector<ElasticKind> kinds = elasticKinds(settings.mechanism.parameters());
  std::vector<SceneRow> rows;
  for (const ElasticRow& row : elastic) {
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const ElasticKind& k) { return k.name == row.machine; });
    rows.push_back(sceneRow(settings, *kind, row.level));
    rows.back().life = row.errors.life;
  }
  return rows;
}

std::string markdown(const std::vector<SceneRow>& rows) {
  std::string text =
      "| machine | level | means of 1/60 s: rms Fx, Fz, moment | stated | within two standard deviations | "
      "damage-equivalent range of Fz | stated | energy: mean error | rms | stated | within | restitution: mean error | "
      "rms | stated | within |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  const auto each = [](const SceneRow& row, double FigureErrors::Result::*part, int digits) {
    return format("%.*f, %.*f, %.*f %% | ", digits, 100.0 * (row.slow[0].*part), digits, 100.0 * (row.slow[1].*part),
                  digits, 100.0 * (row.slow[2].*part));
  };
  for (const SceneRow& r : rows) {
    text += "| " + r.machine + " | " + nameOf(r.level) + " | " + each(r, &FigureErrors::Result::rms, 2) +
            each(r, &FigureErrors::Result::said, 2) + each(r, &FigureErrors::Result::covered, 0);
    text += format("%+.1f %% | %.1f %% | ", 100.0 * r.life.error, 100.0 * std::hypot(r.life.own, r.life.common));
    text += format("%+.1f %% | %.1f %% | %.1f %% | %.0f %% | ", 100.0 * r.energy_bias, 100.0 * r.energy.rms,
                   100.0 * r.energy.said, 100.0 * r.energy.covered);
    text += format("%+.3f | %.3f | %.3f | %.0f %% |\n", r.restitution_bias, r.restitution.rms, r.restitution.said,
                   100.0 * r.restitution.covered);
  }
  return text;
}

std::string json(const std::vector<SceneRow>& rows) {
  const auto figure = [](const char* name, const FigureErrors::Result& r) {
    return format("\"%s\": {\"rms\": %.4g, \"stated\": %.4g, \"covered\": %.4g}", name, r.rms, r.said, r.covered);
  };
  std::string text = "[";
  for (const SceneRow& r : rows)
    text += format("%s\n  {\"machine\": \"%s\", \"level\": \"%s\", ", &r == rows.data() ? "" : ",", r.machine.c_str(),
                   nameOf(r.level)) +
            figure("slow_x", r.slow[0]) + ", " + figure("slow_z", r.slow[1]) + ", " + figure("slow_y", r.slow[2]) +
            ", \"life\": " + json(r.life) + ", " + figure("energy", r.energy) + ", " +
            figure("restitution", r.restitution) +
            format(", \"energy_bias\": %.4g, \"restitution_bias\": %.4g}", r.energy_bias, r.restitution_bias);
  return text + "\n]";
}

}  // namespace hammer_loads::accuracy
