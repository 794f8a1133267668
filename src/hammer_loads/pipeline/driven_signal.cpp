#include "hammer_loads/pipeline/driven_signal.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

enum Part { kIntegral, kSmooth, kSlope, kCompliance };
// Of slopes' walk times interval^3 (of a signal) or interval^5 (of its integral) over the noise's variance: from a hull
// that drifts to one whose readings leave no doubt.
constexpr double kWalks[] = {1e-3, 1e-1, 1e1, 1e3};
constexpr double kWalksOfIntegral[] = {1e-5, 1e-3, 1e-1, 1e1};
constexpr double kMemoryOfReadings = 1000.0;          // readings
constexpr double kFarOff = 9.0;                // of variances: a reading that is farther off counts as this
constexpr double kComplianceWalk = 0.02;    // of the first guess's deviation in a second: a pose that changes
constexpr double kUnknownSlope = 1e3;       // [1/s] times the smooth part's deviation: vibration of up to 100 Hz
constexpr double kLeastNoise = 1e-3;        // of the first guess: a logarithm is taken of it
constexpr double kUnknownSignal = 1e3;            // of the noise: smooth part at the start

}  // namespace

DrivenSignal::DrivenSignal(const Settings& settings) noexcept : settings_(settings) {
  for (std::size_t i = 0; i < kCandidates; ++i) {
    Candidate& c = candidates_[i];
    c.walk = settings.reads == Reads::kItself ? kWalks[i] : kWalksOfIntegral[i];
    c.x.setZero(), c.P.setZero();
    c.variance = square(settings.noise);
    for (int k = 0; k < 3; ++k) c.P(kCompliance + k, kCompliance + k) = square(settings.compliance[k] / settings.noise);
  }
  best_ = kCandidates / 2;
}

double DrivenSignal::Candidate::score() const noexcept { return std::log(variance) + log_spread; }

DrivenSignal::State DrivenSignal::rowOf(const Eigen::Vector3d& load) const noexcept {
  State row = State::Zero();
  if (settings_.reads == Reads::kIntegral) {
    row[kIntegral] = 1.0;
  } else {
    row[kSmooth] = 1.0, row.tail<3>() = load;
  }
  return row;
}

double DrivenSignal::walkOf(const Candidate& c) const noexcept {
  const double cube = interval_ * interval_ * interval_;
  return c.walk / (settings_.reads == Reads::kItself ? cube : cube * square(interval_));
}

void DrivenSignal::begin(double reading, const Eigen::Vector3d& load) noexcept {
  const bool itself = settings_.reads == Reads::kItself;
  for (Candidate& c : candidates_) {
    c.x.head<3>().setZero();
    c.P.topRows<3>().setZero(), c.P.leftCols<3>().setZero();
    if (itself) c.x[kSmooth] = reading - load.dot(c.x.tail<3>());
    else c.x[kIntegral] = reading;
    // Of a rate that is read the acceleration is not.
    const double smooth = itself ? square(kUnknownSignal) : square(kUnknownSignal * kUnknownSlope);
    c.P(kIntegral, kIntegral) = 1.0, c.P(kSmooth, kSmooth) = smooth;
    c.P(kSlope, kSlope) = smooth * square(kUnknownSlope);
  }
  begun_ = true;
}

void DrivenSignal::advance(double h, double slope_step, const Eigen::Vector3d& impulse, double walk, State& x,
                           Covariance& P) const noexcept {
  Covariance F = Covariance::Identity();
  F(kIntegral, kSmooth) = h, F(kIntegral, kSlope) = slope_step * (h - 0.5 * slope_step);
  F(kSmooth, kSlope) = slope_step;
  F.block<1, 3>(kIntegral, kCompliance) = impulse.transpose();
  x = F * x;
  F(kIntegral, kSlope) = 0.5 * h * h, F(kSmooth, kSlope) = h;
  P = F * P * F.transpose();
  const double hh = h * h, q = walk * h;
  P(kIntegral, kIntegral) += q * hh * hh / 20.0, P(kSmooth, kSmooth) += q * hh / 3.0, P(kSlope, kSlope) += q;
  const auto both = [&](int i, int j, double value) { P(i, j) += value, P(j, i) += value; };
  both(kIntegral, kSmooth, q * hh * h / 8.0), both(kIntegral, kSlope, q * hh / 6.0), both(kSmooth, kSlope, q * h / 2.0);
  for (int k = 0; k < 3; ++k)
    P(kCompliance + k, kCompliance + k) += h * square(kComplianceWalk * settings_.compliance[k] / settings_.noise);
}

void DrivenSignal::update(double reading, const Eigen::Vector3d& load, bool counts, Candidate& c) noexcept {
  const State row = rowOf(load);
  const State PH = c.P * row;
  const double S = row.dot(PH) + 1.0, off = reading - row.dot(c.x);
  c.x += PH * (off / S);
  c.P -= PH * PH.transpose() / S;
  if (!counts) return;
  const double share = 1.0 / std::min(counted_ + 10.0, kMemoryOfReadings);
  const double size = std::min(square(off) / S, kFarOff * c.variance);
  c.variance = std::max(c.variance + share * (size - c.variance), square(kLeastNoise * settings_.noise));
  c.log_spread += share * (std::log(S) - c.log_spread);
}

void DrivenSignal::read(double reading, double step, const Eigen::Vector3d& load, const Eigen::Vector3d& impulse,
                        bool counts) noexcept {
  if (!begun_) return begin(reading, load);
  interval_ = interval_ > 0.0 ? interval_ + 0.05 * (step - interval_) : step;
  for (Candidate& c : candidates_) {
    advance(step, step, impulse, walkOf(c), c.x, c.P);
    update(reading, load, counts, c);
  }
  if (!counts) return;
  counted_ += 1.0;
  const auto lower = [](const Candidate& a, const Candidate& b) { return a.score() < b.score(); };
  best_ = static_cast<std::size_t>(std::min_element(candidates_.begin(), candidates_.end(), lower) -
                                   candidates_.begin());
}

DrivenSignal::Value DrivenSignal::foretell(double step, const Eigen::Vector3d& load,
                                           const Eigen::Vector3d& impulse) const noexcept {
  State x = best().x;
  Covariance P = best().P;
  advance(step, std::min(step, interval_), impulse, walkOf(best()), x, P);
  State row = State::Zero();
  row[kSmooth] = 1.0, row.tail<3>() = load;
  const State PH = P * row;
  const double unit = best().variance;
  return {row.dot(x), x[kIntegral], unit * row.dot(PH), unit * PH[kIntegral], unit * P(kIntegral, kIntegral)};
}

double DrivenSignal::noise() const noexcept { return std::sqrt(best().variance); }

Eigen::Vector3d DrivenSignal::complianceDeviation() const noexcept {
  return (best().variance * best().P.diagonal().tail<3>()).cwiseSqrt();
}

}  // namespace hammer_loads
