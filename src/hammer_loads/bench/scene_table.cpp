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

  double timeOf(StampNs stamp) const { return seconds(stamp - machine.start_stamp); }
  bool isJudged(double time) const { return time >= kKnownFrom && time <= machine.duration - kBefore; }
  void take(const SampleResult& result) {
    for (std::size_t i = 0; i < result.turn_ends; ++i) takeBlow(result.ends[i]);
    if (result.refusal) return;
    for (const WrenchOutput& output : result.outputs)
      if (isJudged(timeOf(output.stamp)) && std::abs(output.interval - kSlow) < 1e-4) means.push_back(output);
  }
  void takeBlow(const TurnEnd& end) {
    const double time = timeOf(end.stamp);
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
        times.push_back(timeOf(mean.stamp) + mean.interval * ((i + 0.5) / kInMean - 1.0));
    const std::vector<simulation::CrankTruth> truth = simulation::truthAt(machine, times);
    std::array<FigureErrors, 3> errors;
    Eigen::Vector3d largest = Eigen::Vector3d::Zero();
    auto at = truth.begin();
    for (const WrenchOutput& mean : means) {
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      bool touches = false;
      for (int i = 0; i < kInMean; ++i, ++at) {
        right += wrenchOf(*at);
        touches = touches || at->touches();
      }
      if (touches) continue;
      right /= kInMean;
      largest = largest.cwiseMax(right.cwiseAbs());
      const Eigen::Vector3d error = vectorOf(mean.wrench) - right, stated = vectorOf(mean.deviation.wrench());
      for (Eigen::Index k = 0; k < 3; ++k) errors[static_cast<std::size_t>(k)].add(error[k], stated[k]);
    }
    std::array<FigureErrors::Result, 3> result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = errors[k].result(largest[static_cast<Eigen::Index>(k)]);
    return result;
  }
};

}  // namespace

SceneErrors sceneErrors(const Settings& settings, const ElasticKind& kind, Level level) {
  const simulation::Session session = simulation::recordSession(kind.machine);
  PipelineSettings pipeline = settings.pipeline;
  pipeline.level = level;
  pipeline.output = OutputKind::kMean;
  pipeline.output_rate = 1.0 / kSlow;
  SessionPlayer player(settings.mechanism, pipeline, {}, session);
  Judge judge{kind.machine, session, {}, {}, {}};
  player.playTo(kInfinity, [&](double, const SampleResult& result) { judge.take(result); });
  return {judge.slow(), judge.energy.result(), judge.restitution.result()};
}

Table sceneTable(const Settings& settings, const std::vector<ElasticRow>& elastic) {
  Table table(4);
  const auto cell = [&](const char* header, const char* pattern, double value) {
    table.cell(header, format(pattern, value));
  };
  const auto field = [&](const char* key, const FigureErrors::Result& f) {
    table.field(key, format("{\"rms\": %.4g, \"stated\": %.4g, \"covered\": %.4g}", f.rms, f.stated, f.covered));
  };
  const std::vector<ElasticKind> kinds = elasticKinds(settings.mechanism.parameters());
  for (const ElasticRow& row : elastic) {
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const ElasticKind& k) { return k.name == row.machine; });
    const auto [slow, energy, restitution] = sceneErrors(settings, *kind, row.level);
    const auto& [x, z, moment] = slow;
    const LifeFigure& life = row.errors.life;
    table.beginRow();
    table.text("machine", "machine", row.machine);
    table.text("level", "level", nameOf(row.level));
    table.cell("means of 1/60 s: rms Fx, Fz, moment", percents(2, {x.rms, z.rms, moment.rms}));
    table.cell("stated", percents(2, {x.stated, z.stated, moment.stated}));
    table.cell("within two standard deviations", percents(0, {x.covered, z.covered, moment.covered}));
    field("slow_x", x), field("slow_z", z), field("slow_y", moment);
    cell("damage-equivalent range of Fz", "%+.1f %%", 100.0 * life.error);
    cell("stated", "%.1f %%", 100.0 * std::hypot(life.own, life.common));
    table.field("life", json(life));
    cell("energy: mean error", "%+.1f %%", 100.0 * energy.bias), table.number("energy_bias", energy.bias);
    cell("rms", "%.1f %%", 100.0 * energy.rms);
    cell("stated", "%.1f %%", 100.0 * energy.stated);
    cell("within", "%.0f %%", 100.0 * energy.covered);
    field("energy", energy);
    cell("restitution: mean error", "%+.3f", restitution.bias), table.number("restitution_bias", restitution.bias);
    cell("rms", "%.3f", restitution.rms);
    cell("stated", "%.3f", restitution.stated);
    cell("within", "%.0f %%", 100.0 * restitution.covered);
    field("restitution", restitution);
  }
  return table;
}

}  // namespace hammer_loads::accuracy
