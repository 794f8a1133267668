#include "hammer_loads/pipeline/driven_signal.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"
#include "hammer_loads/util/inline.h"

namespace hammer_loads {
namespace {

enum Part { kIntegral, kSmooth, kSlope, kCompliance, kBending = 6, kDamping = 9 };
// Intensities of the slope's random walk, times interval^3 (signal) or interval^5 (its integral), over the variance of
// the noise: from a hull that drifts slowly to one whose readings leave no uncertainty.
constexpr double kWalks[] = {1e-3, 1e-1, 1e1, 1e3};
constexpr double kWalksOfIntegral[] = {1e-5, 1e-3, 1e-1, 1e1};
// Numerical: kWalks, kWalksOfIntegral
constexpr double kFarOff = square(gate::kRare);  // in variances: limit of the contribution of a reading
constexpr double kComplianceWalk = 0.01;         // part of the first guess's deviation in a second: a pose that changes
// Prior: kComplianceWalk
// Relative error of a compliance from a description with masses right to 3 % and centres to 2 cm.
constexpr double kDescribed = 0.05;
// Prior: kDescribed
constexpr double kUnknownSlope = 1e3;   // [1/s] times the smooth part's deviation: vibration of up to 100 Hz
constexpr double kLeastNoise = 1e-3;    // part of the first guess, since its logarithm is needed
constexpr double kUnknownSignal = 1e3;  // ratio of the smooth part at the start to the noise
constexpr double kOfInterval = 0.05;    // weight of one reading in the mean
// Numerical: kUnknownSignal, kUnknownSlope, kLeastNoise, kOfInterval
constexpr double kFirstCounts = 10.0;  // weight of the first guess of the noise, in readings

/// Returns M F^T of rows of states. F predicts integral, smooth part and slope at the end of a step, of which the slope
/// acts during slope_step.
template <typename Rows>
HAMMER_LOADS_INLINE auto carried(const Rows& M, const DrivenSignal::Step& step, double slope_step) noexcept {
  const double h = step.length;
  const auto by = [&](Part part, const Eigen::Vector3d& of) { return M.template middleCols<3>(part).lazyProduct(of); };
  Eigen::Matrix<double, Rows::RowsAtCompileTime, 3> result;
  result.col(kIntegral) = M.col(kIntegral) + h * M.col(kSmooth) + slope_step * (h - 0.5 * slope_step) * M.col(kSlope) +
                          by(kCompliance, step.impulse) - by(kBending, h / 3.0 * step.way) - by(kDamping, step.way);
  result.col(kSmooth) =
      M.col(kSmooth) + slope_step * M.col(kSlope) - by(kBending, step.way) - by(kDamping, step.velocity);
  result.col(kSlope) = M.col(kSlope) - by(kBending, step.velocity);
  return result;
}

/// Returns M H^T of rows of states, where H yields the signal at a load.
template <typename Rows>
HAMMER_LOADS_INLINE auto signalsOf(const Rows& M, const Eigen::Vector3d& load) noexcept {
  Eigen::Matrix<double, Rows::RowsAtCompileTime, 1> result = M.col(kSmooth);
  result += M.template middleCols<3>(kCompliance).lazyProduct(load);
  return result;
}
HAMMER_LOADS_INLINE double signalIn(const DrivenSignal::State& x, const Eigen::Vector3d& load) noexcept {
  return x[kSmooth] + x.segment<3>(kCompliance).dot(load);
}

}  // namespace

DrivenSignal::DrivenSignal(const Settings& settings) noexcept : settings_(settings) {
  prior_ << settings.compliance, settings.stiffness, settings.damping;
  prior_ = prior_.cwiseAbs2().eval();
  for (std::size_t i = 0; i < kCandidates; ++i) {
    Candidate& c = candidates_[i];
    c.walk = settings.reads == Reads::kItself ? kWalks[i] : kWalksOfIntegral[i];
    c.x.setZero(), c.P.setZero();
    c.variance = square(settings.noise), c.quiet = c.variance;
    c.P.diagonal().tail<9>() = prior_ / c.variance;
  }
  best_ = kCandidates / 2;
}

void DrivenSignal::expect(const Eigen::Vector3d& compliance, const Eigen::Vector3d& most) noexcept {
  const Eigen::Vector3d change = compliance - expected_;
  const bool first = expected_.isZero(0.0);
  const Eigen::Vector3d variance = (kDescribed * (first ? most : change)).cwiseAbs2();
  for (Candidate& c : candidates_) {
    if (first) {
      c.P.middleRows<3>(kCompliance).setZero(), c.P.middleCols<3>(kCompliance).setZero();
      c.x.segment<3>(kCompliance).setZero();
    }
    c.P.diagonal().segment<3>(kCompliance) += variance / c.variance;
    c.x.segment<3>(kCompliance) += change;
  }
  prior_.head<3>() = (first ? variance : prior_.head<3>() + variance).eval();
  expected_ = compliance;
}

double DrivenSignal::Candidate::score() const noexcept { return std::log(variance) + log_spread; }

double DrivenSignal::readOf(const State& x, const Eigen::Vector3d& load) const noexcept {
  return settings_.reads == Reads::kIntegral ? x[kIntegral] : signalIn(x, load);
}

double DrivenSignal::walkOf(const Candidate& c) const noexcept {
  if (!(interval_ > 0.0)) return 0.0;  // unknown before the second reading
  const double cube = interval_ * interval_ * interval_;
  return c.walk / (settings_.reads == Reads::kItself ? cube : cube * square(interval_));
}

void DrivenSignal::begin(double reading, const Eigen::Vector3d& load) noexcept {
  const bool itself = settings_.reads == Reads::kItself;
  for (Candidate& c : candidates_) {
    c.x.head<3>().setZero();
    c.P.topRows<3>().setZero(), c.P.leftCols<3>().setZero();
    if (itself)
      c.x[kSmooth] = reading - load.dot(c.x.segment<3>(kCompliance));
    else
      c.x[kIntegral] = reading;
    // A measured rate does not determine the acceleration.
    const double smooth = itself ? square(kUnknownSignal) : square(kUnknownSignal * kUnknownSlope);
    c.P(kIntegral, kIntegral) = 1.0, c.P(kSmooth, kSmooth) = smooth;
    c.P(kSlope, kSlope) = smooth * square(kUnknownSlope);
  }
  if (itself && steady_time_ == 0.0) steady_ = reading, steady_time_ = look_back::kTurn;
  begun_ = true;
}

void DrivenSignal::carry(const Step& step, double slope_step, double walk, double unit, State& x,
                         Covariance& P) const noexcept {
  const double h = step.length, hh = h * h, q = walk * h;
  x.head<3>() = carried(x.transpose(), step, slope_step).transpose();
  const Eigen::Matrix<double, kStates, 3> PF = carried(P, step, h);
  P.leftCols<3>() = PF;
  P.topRows<3>() = PF.transpose();
  const Eigen::Matrix3d FPF = carried(P.topRows<3>(), step, h);
  P.topLeftCorner<3, 3>() = 0.5 * (FPF + FPF.transpose());
  P(kIntegral, kIntegral) += q * hh * hh / 20.0, P(kSmooth, kSmooth) += q * hh / 3.0, P(kSlope, kSlope) += q;
  const auto both = [&](int i, int j, double value) { P(i, j) += value, P(j, i) += value; };
  both(kIntegral, kSmooth, q * hh * h / 8.0), both(kIntegral, kSlope, q * hh / 6.0), both(kSmooth, kSlope, q * h / 2.0);
  P.diagonal().tail<9>() += h * square(kComplianceWalk) / unit * prior_;
}

void DrivenSignal::update(double reading, const Eigen::Vector3d& load, const UncertainSide& uncertain_side, bool counts,
                          Candidate& c) noexcept {
  const bool itself = settings_.reads == Reads::kItself;
  const State PH = itself ? signalsOf(c.P, load) : State(c.P.col(kIntegral));
  const double p = uncertain_side.probability, jump = c.x.segment<3>(kCompliance).dot(uncertain_side.added);
  const double S = 1.0 + readOf(PH, load) + p * (1.0 - p) * square(jump) / c.variance;
  const double off = reading - readOf(c.x, load) - p * jump;
  const State gain = PH / std::sqrt(S);  // products of its elements keep the covariance symmetric to the bit
  c.x += gain * (off / std::sqrt(S));
  c.P -= gain.lazyProduct(gain.transpose());
  const double size = square(off) / S;
  if (!counts) {
    c.quiet += (std::min(size, kFarOff * c.quiet) - c.quiet) / look_back::kManyReadings;
    return;
  }
  const double share = 1.0 / std::min(counted_ + kFirstCounts, look_back::kManyReadings);
  c.variance = std::max(c.variance + share * (std::min(size, kFarOff * c.variance) - c.variance),
                        square(kLeastNoise * settings_.noise));
  c.log_spread += share * (std::log(S) - c.log_spread);
  keepPrior(c);
}

/// Limits the variance of a compliance to that before any reading, which growing noise would exceed.
void DrivenSignal::keepPrior(Candidate& c) const noexcept {
  const Eigen::Array3d prior = prior_.head<3>(), now = c.variance * c.P.diagonal().segment<3>(kCompliance).array();
  if ((now <= prior).all()) return;
  const Eigen::Array3d part = (prior / now).min(1.0).sqrt();
  c.P.middleRows<3>(kCompliance).array().colwise() *= part;
  c.P.middleCols<3>(kCompliance).array().rowwise() *= part.transpose();
}

void DrivenSignal::advance(const Step& step) noexcept {
  for (Candidate& c : candidates_) carry(step, step.length, walkOf(c), c.variance, c.x, c.P);
}

void DrivenSignal::read(double reading, double step, const Eigen::Vector3d& load, const UncertainSide& uncertain_side,
                        bool counts) noexcept {
  if (!begun_) return begin(reading, load);
  interval_ = interval_ > 0.0 ? interval_ + kOfInterval * (step - interval_) : step;
  for (Candidate& c : candidates_) update(reading, load, uncertain_side, counts, c);
  if (settings_.reads == Reads::kItself)
    steady_ += std::min(1.0, step / steady_time_) * (readOf(best().x, load) - steady_);
  steady_time_ = std::min(steady_time_ + step, look_back::kTenTurns);
  if (!counts) return;
  counted_ += 1.0;
  const auto lower = [](const Candidate& a, const Candidate& b) { return a.score() < b.score(); };
  best_ =
      static_cast<std::size_t>(std::min_element(candidates_.begin(), candidates_.end(), lower) - candidates_.begin());
}

void DrivenSignal::Future::advance(const Step& step) noexcept {
  const double slope_step = std::clamp(signal_.interval_ - since_, 0.0, step.length);
  signal_.carry(step, slope_step, signal_.walkOf(signal_.best()), signal_.best().variance, x_, P_);
  since_ += step.length;
}

DrivenSignal::Value DrivenSignal::Future::at(const Eigen::Vector3d& load) const noexcept {
  const State PH = signalsOf(P_, load);
  const double unit = signal_.best().variance, moved = signal_.unfollowed(), interval = signal_.interval_;
  const bool itself = signal_.settings_.reads == Reads::kItself;
  const double of_signal = itself ? moved : interval > 0.0 ? moved / square(interval) : 0.0;
  return {signalIn(x_, load), x_[kIntegral], unit * signalIn(PH, load) + of_signal, unit * PH[kIntegral],
          unit * P_(kIntegral, kIntegral) + (itself ? 0.0 : moved)};
}

DrivenSignal::Swing DrivenSignal::swing(const State& x, double h, const Eigen::Vector3d& impulse,
                                        const Eigen::Vector3d& lasting) const noexcept {
  const Eigen::Vector3d compliance = x.segment<3>(kCompliance);
  const double smooth = x[kSmooth] - steady_;
  return {h * (smooth + 0.5 * h * x[kSlope]) + compliance.dot(impulse),
          h * h * (0.5 * smooth + h / 6.0 * x[kSlope]) + compliance.dot(lasting)};
}

double DrivenSignal::noise() const noexcept { return std::sqrt(best().variance); }

Eigen::Vector3d DrivenSignal::complianceDeviation() const noexcept {
  return (best().variance * best().P.diagonal().segment<3>(kCompliance)).cwiseSqrt();
}

}  // namespace hammer_loads
