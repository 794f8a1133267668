#include "hammer_loads/crank/zero_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr int kEvery = 8;                 // revolutions between evaluations after the first ones
constexpr double kSameTurn = 0.2;         // relative change of a revolution's time at start and stop
constexpr double kInertiaKnown = 0.5;     // standard deviation of the logarithm of Jc
constexpr double kStiffnessKnown = 30.0;  // standard deviation of K [N m/rad]
constexpr double kLeastEnergy = 1.0;      // [J]
constexpr double kLongestMove = 0.1;      // [rad] of the zero in one step of the fit
// Numerical: kLeastEnergy, kLongestMove
constexpr double kStated = 0.06;    // largest standard deviation of a zero that is reported [rad]
constexpr double kStepGain = 0.02;  // gain of the mean step
constexpr int kFineSteps = 5;
constexpr int kCandidates = 12;  // places of the blow whose fit is improved
// Prior: kInertiaKnown, kStiffnessKnown
// Limit: kStated
enum : Eigen::Index { kInertia, kEnergy, kTorque, kStiffness, kZero, kStart };

}  // namespace

void ZeroSearch::restart() noexcept {
  samples_ = passed_ = turns_ = 0;
  due_ = kTurnsToKnow;
  place_time_.reset();
  found_.reset();
}

void ZeroSearch::add(double angle, double step, const HullMotion& hull) noexcept {
  const double turned = samples_ > 0 ? CrankAngle::wrapToPi(angle - last_.back().angle) : 0.0;
  if (!(step > 0.0) || step > look_back::kHalfTurn || turned < -0.5 * kWidth * kPlaces / 8.0) samples_ = 0;
  if (samples_ == 0) {
    samples_ = 1, passed_ = 0;
    place_time_.reset();
    last_.back() = {CrankAngle::wrapToPi(angle), 0.0};
    return;
  }
  model_.setHullMotion(hull);
  step_ += kStepGain * (step - step_);
  std::move(last_.begin() + 1, last_.end(), last_.begin());
  last_.back() = {last_[2].angle + turned, last_[2].time + step};
  samples_ = std::min(samples_ + 1, 4);
  if (samples_ < 4) {
    place_ = static_cast<std::int64_t>(std::floor(last_[2].angle / kWidth));
    return;
  }
  const auto reached = static_cast<std::int64_t>(std::floor(last_[2].angle / kWidth));
  while (place_ < reached) {
    ++place_;
    pass(timeAt(static_cast<double>(place_) * kWidth), place_);
  }
}

/// Returns the time at a place between the second and third of the last samples, by a cubic if the steps are long.
double ZeroSearch::timeAt(double angle) const noexcept {
  const Point &from = last_[1], &to = last_[2];
  const bool grows = last_[1].angle - last_[0].angle > 1e-4 && last_[3].angle - last_[2].angle > 1e-4;
  if (!(to.angle - from.angle > 0.25 * kWidth) || !grows)
    return from.time + (angle - from.angle) / (to.angle - from.angle) * (to.time - from.time);
  double time = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) weight *= (angle - last_[j].angle) / (last_[i].angle - last_[j].angle);
    time += weight * last_[i].time;
  }
  return std::clamp(time, from.time, to.time);
}

void ZeroSearch::pass(double place_time, std::int64_t place) noexcept {
  const auto before = static_cast<std::size_t>(((place - 1) % kPlaces + kPlaces) % kPlaces);
  if (place_time_) {
    turn_[before] = place_time - *place_time_;
    ++passed_;
  }
  place_time_ = place_time;
  if (before != kPlaces / 2 - 1) return;  // half a revolution from the blow with a correct zero
  if (passed_ == kPlaces && !skips_) endTurn();
  skips_ = false;
  passed_ = 0;
}

void ZeroSearch::endTurn() noexcept {
  double all = 0.0;
  for (const double time : turn_) all += time;
  if (turns_ > 0 && std::abs(all - turn_time_) > kSameTurn * all) turns_ = 0, due_ = kTurnsToKnow;
  ++turns_;
  const double weight = 1.0 / std::min(turns_, look_back::kTurnsToKnow);
  turn_time_ = turns_ == 1 ? all : turn_time_ + weight * (all - turn_time_);
  for (std::size_t i = 0; i < kPlaces; ++i)
    times_[i] = turns_ == 1 ? turn_[i] : times_[i] + weight * (turn_[i] - times_[i]);
  if (turns_ < due_) return;
  due_ = turns_ < kEvery ? turns_ + 1 : turns_ + kEvery;
  if (wanted_) evaluate();
}

ZeroSearch::Table ZeroSearch::tableAt(double zero) const noexcept {
  Table table;
  for (int i = 0; i <= 2 * kPlaces; ++i) {
    const double offset = CrankAngle::wrapToPi(0.5 * i * kWidth - kTwoPi - zero);
    const ShaftLoad load = model_(CrankAngle::fromOffset(offset));
    table.inertia[static_cast<std::size_t>(i)] = load.inertia;
    if (i % 2 == 1) table.weight[static_cast<std::size_t>(i / 2)] = load.weight_torque;
  }
  return table;
}

/// Calls use(Stretch) for the stretches between places that are compared, in order; blow: place of the blow.
template <typename Use>
void ZeroSearch::forEachStretch(int blow, const Table& table, const Use& use) const noexcept {
  double all = 0.0;
  for (int k = kFrom; k < to_; ++k) all += time(blow, k);
  const double mean_speed = (to_ - kFrom) * kWidth / all;
  Stretch s;
  double ahead = 0.0, elapsed = 0.0;
  for (int k = kFrom; k < to_; ++k) {
    s.place = static_cast<std::size_t>(k);
    s.took = time(blow, k), s.angle = (k - kFrom) * kWidth;
    if (k > kFrom) {
      s.work += 0.5 * (table.weight[s.place - 1] + table.weight[s.place]) * kWidth;
      elapsed += 0.5 * (time(blow, k - 1) + s.took);
      const double next = mean_speed * elapsed - s.angle;
      s.by_supply += 0.5 * (ahead + next) * kWidth;
      ahead = next;
    }
    use(s);
  }
}

/// Linear least squares of the energy halfway between places; blow: place of the blow.
ZeroSearch::Vector ZeroSearch::guess(int blow, const Table& table) const noexcept {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d score = Eigen::Vector4d::Zero();
  forEachStretch(blow, table, [&](const Stretch& s) {
    const double speed = kWidth / s.took, inertia = table.inertia[2 * s.place + 1], half_square = 0.5 * speed * speed;
    const double weight = 1.0 / ((inertia + drive_inertia_) * half_square * speed);
    const Eigen::Vector4d row(-half_square * drive_inertia_, 1.0, s.angle, s.by_supply);
    information += square(weight) * row * row.transpose();
    score += square(weight) * (inertia * half_square - s.work) * row;
  });
  const Eigen::Vector4d x = information.ldlt().solve(score);
  Vector unknowns = Vector::Zero();
  unknowns[kInertia] = std::log(std::clamp(x[0], 0.2, 5.0));
  unknowns[kEnergy] = x[1], unknowns[kTorque] = x[2], unknowns[kStiffness] = x[3];
  return unknowns;
}

/// Makes one Gauss-Newton step; the returned squares are those before the step.
ZeroSearch::Fit ZeroSearch::step(int blow, const Table& table, const Vector& x, bool with_zero) const noexcept {
  const double drive = drive_inertia_ * std::exp(x[kInertia]);
  Fit fit;
  Vector row = Vector::Zero(), score = Vector::Zero();
  row[kStart] = 1.0;
  double rest = -x[kStart];
  const auto add = [&] {
    fit.information += row * row.transpose();
    score += rest * row;
    fit.squares += square(rest);
  };
  add();
  forEachStretch(blow, table, [&](const Stretch& s) {
    const std::size_t i = 2 * s.place;
    const double begin = std::sqrt(table.inertia[i] + drive), middle = std::sqrt(table.inertia[i + 1] + drive),
                 end = std::sqrt(table.inertia[i + 2] + drive);
    const double energy =
        std::max(kLeastEnergy, x[kEnergy] + x[kTorque] * s.angle + x[kStiffness] * s.by_supply + s.work);
    const double root = 1.0 / std::sqrt(2.0 * energy), expected = kWidth * root * (begin + 4.0 * middle + end) / 6.0;
    const double by_energy = -0.5 * expected / energy;
    row[kInertia] += kWidth * root * drive * (1.0 / begin + 4.0 / middle + 1.0 / end) / 12.0;
    row[kEnergy] += by_energy;
    row[kTorque] += by_energy * s.angle;
    row[kStiffness] += by_energy * s.by_supply;
    if (with_zero) row[kZero] -= root * (end - begin);
    rest += s.took - expected;
    add();
  });
  const double variance = std::max(fit.squares / (to_ - kFrom - kUnknowns), 1e-12);
  fit.information /= variance;
  score /= variance;
  fit.information(kInertia, kInertia) += 1.0 / square(kInertiaKnown);
  score[kInertia] -= x[kInertia] / square(kInertiaKnown);
  fit.information(kStiffness, kStiffness) += 1.0 / square(kStiffnessKnown);
  score[kStiffness] -= x[kStiffness] / square(kStiffnessKnown);
  if (!with_zero) fit.information(kZero, kZero) += 1.0;
  Vector change = fit.information.ldlt().solve(score);
  change[kZero] = std::clamp(change[kZero], -kLongestMove, kLongestMove);
  change[kInertia] = std::clamp(change[kInertia], -kInertiaKnown, kInertiaKnown);
  fit.unknowns = x + change;
  return fit;
}

/// Returns the standard deviation of the zero [rad]; infinite if the fit has none.
double ZeroSearch::deviationOfZero(const Fit& fit) const noexcept {
  Vector unit = Vector::Zero();
  unit[kZero] = 1.0;
  const double variance = fit.information.ldlt().solve(unit)[kZero];
  return variance > 0.0 && fit.unknowns.allFinite() ? std::sqrt(variance) : kInfinity;
}

void ZeroSearch::evaluate() noexcept {
  found_.reset();
  ++evaluations_;
  // Samples beyond the blow distort the times of the places before it.
  to_ = kPlaces - 1 - static_cast<int>(step_ / turn_time_ * kPlaces);
  if (to_ < kFrom + kPlaces / 4) return;
  for (const double time : times_)
    if (!(time > 0.0)) return;
  const Table table = tableAt(0.0);
  std::array<std::pair<double, int>, kPlaces> places;  // squares of a first guess, place of the blow
  std::array<Vector, kPlaces> unknowns;
  for (int i = 0; i < kPlaces; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Fit fit = step(i, table, guess(i, table), false);
    places[k] = {std::isfinite(fit.squares) ? fit.squares : kInfinity, i};
    unknowns[k] = fit.unknowns;
  }
  std::partial_sort(places.begin(), places.begin() + kCandidates, places.end());
  int blow = 0;
  Fit best;
  best.squares = kInfinity;
  for (int c = 0; c < kCandidates; ++c) {
    const int i = places[static_cast<std::size_t>(c)].second;
    const Vector x = step(i, table, unknowns[static_cast<std::size_t>(i)], false).unknowns;
    const Fit fit = step(i, table, x, false);
    if (!(fit.squares < best.squares)) continue;
    best = fit;
    best.unknowns = x;
    blow = i;
  }
  Vector x = best.unknowns;
  for (int n = 0; n <= kFineSteps; ++n) {
    best = step(blow, tableAt(x[kZero]), x, true);
    if (n < kFineSteps) x = best.unknowns;
  }
  const double deviation = deviationOfZero(best);
  if (deviation < kStated) found_ = Found{CrankAngle::wrapToPi(blow * kWidth + x[kZero]), deviation};
}

}  // namespace hammer_loads
