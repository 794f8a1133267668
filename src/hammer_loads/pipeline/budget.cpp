#include "hammer_loads/pipeline/budget.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kSensor = static_cast<std::size_t>(ConstantErrors::kTable);

}  // namespace

BudgetRecorder::BudgetRecorder(const Pipeline& pipeline) : pipeline_(&pipeline) {
  for (std::size_t i = 0; i < kSensor; ++i)
    names_[i] = kUnknowns[i].key != nullptr ? kUnknowns[i].key : kUnknowns[i].name;
  const std::vector<std::string> of_hammer = pipeline.hammerColumns();
  std::copy(of_hammer.begin(), of_hammer.end(), names_.begin() + kSensor);
  names_[kInertiaColumn] = "drive_inertia_kg_m2", names_[kHullColumn] = "hull_mass_kg";
}

void BudgetRecorder::Sum::add(double number, const NumberError& error) noexcept {
  if (!std::isfinite(number) || !std::isfinite(error.own) || !error.columns.allFinite()) return;
  ++count;
  value += number;
  own += square(error.own), rod += square(error.rod);
  columns += error.columns;
}

void BudgetRecorder::Extreme::add(const End& sample) noexcept {
  if (sign * sample.value > sign * end.value) end = sample;
  const double reaches = sign * sample.value + std::sqrt(sample.own());
  if (reaches > reached) reached = reaches, reach = sample;
}

BudgetRecorder::End BudgetRecorder::Extreme::known() const noexcept {
  const double beyond = square(reached - sign * end.value), own = reach.own();
  if (!(beyond > end.own()) || !(own > 0.0)) return end;
  return {end.value, end.columns, beyond * reach.readings / own, beyond * reach.rod / own,
          beyond / own * reach.unknown};
}

void BudgetRecorder::Range::add(const End& sample) noexcept {
  if (!std::exchange(begun, true)) {
    constexpr double kNothing = -std::numeric_limits<double>::infinity();
    least = {sample, sample, kNothing, -1.0}, greatest = {sample, sample, kNothing, 1.0};
  }
  least.add(sample), greatest.add(sample);
}

void BudgetRecorder::Range::endTurn() noexcept {
  const End low = least.known(), high = greatest.known();
  const double range = high.value - low.value;
  if (begun && range > 0.0) {
    square += range * range;
    readings += range * std::sqrt(high.readings + low.readings);
    rod += range * std::sqrt(high.rod + low.rod);
    unknown += range * (high.unknown + low.unknown).sqrt();
    columns += range * (high.columns - low.columns);
  }
  begun = false;
}

void BudgetRecorder::sample(const SampleResult& result) noexcept {
  const SampleResult::OfExtreme extreme = result.ofExtreme();
  const Eigen::Vector3d load = vectorOf(result.wrench), all = vectorOf(extreme.deviation),
                        common = vectorOf(result.deviation.common()), rod = vectorOf(extreme.ring);
  for (std::size_t i = 0; i < kHullChannels; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!std::isfinite(all[row])) continue;
    End end{load[row], result.load_columns.row(row).cast<double>(), 0.0, square(rod[row]), extreme.unknown.row(row)};
    end.readings = std::max(0.0, square(all[row]) - square(common[row]) - end.own());
    ranges_[i].add(end);
  }
}

void BudgetRecorder::follow() noexcept {
  const SampleResult& result = pipeline_->result();
  for (std::size_t i = 0; i < result.turn_ends; ++i) {
    const TurnEnd& end = result.ends[i];
    for (Range& range : ranges_) range.endTurn();
    if (!end.blow.impossible) {
      energy_.add(end.blow.energy, end.blow_errors.energy);
      restitution_.add(end.blow.restitution, end.blow_errors.restitution);
    }
    if (!end.pulse) continue;
    amplitude_.add(end.pulse->amplitude, end.pulse_errors.amplitude);
    impulse_.add(end.pulse->impulse, end.pulse_errors.impulse);
    turn_impulse_x_.add(end.pulse->turn_impulse_x, end.pulse_errors.turn_impulse_x);
    turn_impulse_z_.add(end.pulse->turn_impulse_z, end.pulse_errors.turn_impulse_z);
  }
  if (result.isPublished()) sample(result);
}

/// Returns the sources of a variance. Rows with the same name are parts of one source.
std::vector<BudgetFigure::Source> BudgetRecorder::sources(const Columns& columns, double readings, double rod,
                                                          const Unknown& unknown) const {
  std::vector<BudgetFigure::Source> sources;
  const auto add = [&](const std::string& name, double variance) {
    if (!(variance > 0.0)) return;
    const auto found = std::find_if(sources.begin(), sources.end(), [&](const auto& s) { return s.name == name; });
    if (found != sources.end()) {
      found->variance += variance;
    } else {
      sources.push_back({name, variance});
    }
  };
  for (std::size_t i = 0; i < names_.size(); ++i) add(names_[i], square(columns[static_cast<Eigen::Index>(i)]));
  add("readings", readings);
  add("rod_stiffness_N_m", rod);
  for (Eigen::Index i = 0; i < UnknownForce::kSources; ++i) add(UnknownForce::kKeys[i], unknown[i]);
  return sources;
}

std::vector<BudgetFigure> BudgetRecorder::figures() const {
  std::vector<BudgetFigure> figures;
  const auto add = [&](const char* quantity, const Sum& sum) {
    if (sum.count == 0) return;
    const double part = 1.0 / static_cast<double>(sum.count);
    const Columns columns = part * sum.columns;
    figures.push_back({quantity, part * sum.value, std::sqrt(columns.squaredNorm() + part * sum.own),
                       sources(columns, part * (sum.own - sum.rod), part * sum.rod)});
  };
  add("pulse/turn_impulse_x", turn_impulse_x_);
  add("pulse/turn_impulse_z", turn_impulse_z_);
  add("pulse/impulse", impulse_);
  add("pulse/amplitude", amplitude_);
  add("blow/energy", energy_);
  add("blow/restitution", restitution_);
  return figures;
}

std::vector<BudgetFigure::Source> BudgetRecorder::ofRange(std::size_t channel) const {
  const Range& range = ranges_[channel];
  if (!(range.square > 0.0)) return {};
  return sources(range.columns / range.square, square(range.readings / range.square), square(range.rod / range.square),
                 (range.unknown / range.square).square());
}

}  // namespace hammer_loads
