#include "hammer_loads/calibration/linkage_fit.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <unsupported/Eigen/NonLinearOptimization>
#include <utility>

#include "hammer_loads/calibration/positive_system.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads::calibration {
namespace {

using Unknowns = LinkageUnknowns;
using Vector = LinkageUnknowns::Vector;

constexpr std::size_t kLeastTableRows = 12;  // nine unknowns and some degrees of freedom
constexpr std::size_t kMostRows = 400;       // rows used of a longer table
constexpr int kPieces = 40;                  // parts of the table; each difference spans one part
constexpr double kDifferences = 6.0;         // weight of differences: the lengths serve the lever arm
constexpr int kStarts = 300;
constexpr int kBest = 16;            // number of starts whose fit is completed
constexpr double kLeastLink = 0.05;  // least length of a link, and lever of the driven pin, on a machine [m]
constexpr double kAnyPlace = 1.0;    // standard deviation of the position of an unmeasured pin, about the joint [m]
constexpr double kAnyLink = 0.4;     // mean and standard deviation of a link's length [m]
constexpr double kReading = 1e-4;    // least residual of a stroke [m]
// Numerical: kLeastTableRows, kMostRows, kPieces, kDifferences, kStarts, kBest, kLeastLink, kAnyPlace, kAnyLink,
// kReading

BucketLinkage linkageOf(const Vector& x, double branch, double sense) {
  return {{x.segment<2>(Unknowns::kBaseX), x.segment<2>(Unknowns::kGuideX), x.segment<2>(Unknowns::kRodX), sense},
          {x[Unknowns::kGuideX], x[Unknowns::kGuideZ], std::abs(x[Unknowns::kGuide]), std::abs(x[Unknowns::kCoupler]),
           branch}};
}

/// Residuals of rows and of the prior over their standard deviations.
class Problem {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  double branch{1.0};
  double noise{1e-3};  ///< standard deviation of a stroke [m]

  Problem(const StrokeTable& table, const LinkageBasis& basis) : sense_(basis.sense) {
    const std::size_t every = 1 + table.stroke.size() / kMostRows;
    for (std::size_t i = 0; i < table.stroke.size(); i += every)
      rows_.push_back({std::cos(table.angle[i]), std::sin(table.angle[i]), table.stroke[i]});
    std::sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.stroke < b.stroke; });
    for (int i = 0; i < Unknowns::kCount; ++i) {
      const bool link = i == Unknowns::kGuide || i == Unknowns::kCoupler, closed = i == Unknowns::kClosed;
      const auto& measured = basis.measured[static_cast<std::size_t>(i)];
      mean_[i] = measured.value_or(link ? kAnyLink : closed ? 1.0 : 0.0);
      deviation_[i] = measured ? basis.tape_std : link ? kAnyLink : kAnyPlace;
    }
  }

  int inputs() const { return Unknowns::kCount; }
  int values() const { return 2 * static_cast<int>(rows_.size()) - apart() + Unknowns::kCount; }
  /// Returns the number of rows between the two of a difference.
  int apart() const { return std::max(1, static_cast<int>(rows_.size()) / kPieces); }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& f) const {
    const BucketLinkage linkage = linkageOf(x, branch, sense_);
    const auto rows = static_cast<Eigen::Index>(rows_.size()), between = rows - apart();
    for (Eigen::Index i = 0; i < rows; ++i) f[i] = residual(linkage, x, rows_[static_cast<std::size_t>(i)]) / noise;
    f.segment(rows, between) = kDifferences * (f.segment(apart(), between) - f.head(between));
    for (int i = 0; i < Unknowns::kCount; ++i) f[f.size() - Unknowns::kCount + i] = (x[i] - mean_[i]) / deviation_[i];
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& J) const {
    constexpr double kLengthStep = 1e-6;  // [m]
    // Numerical: kLengthStep
    Eigen::VectorXd up(values()), down(values());
    for (int i = 0; i < Unknowns::kCount; ++i) {
      Eigen::VectorXd moved = x;
      moved[i] = x[i] + kLengthStep, (*this)(moved, up);
      moved[i] = x[i] - kLengthStep, (*this)(moved, down);
      J.col(i) = (up - down) / (2.0 * kLengthStep);
    }
    return 0;
  }

  Vector drawn(std::mt19937& random) const {
    std::normal_distribution<> normal;
    Vector x;
    for (int i = 0; i < Unknowns::kCount; ++i) x[i] = mean_[i] + 0.7 * deviation_[i] * normal(random);
    const BucketLinkage linkage = linkageOf(x, branch, sense_);
    double mean = 0.0;
    for (const Row& row : rows_) mean += linkage.at(row.cosine, row.sine).length - row.stroke;
    if (deviation_[Unknowns::kClosed] == kAnyPlace) x[Unknowns::kClosed] = mean / static_cast<double>(rows_.size());
    return x;
  }
  double cost(const Vector& x) const {
    Eigen::VectorXd f(values());
    (*this)(x, f);
    return f.squaredNorm();
  }
  bool closes(const Vector& x) const {
    const BucketLinkage linkage = linkageOf(x, branch, sense_);
    const double least = std::min(
        {std::abs(x[Unknowns::kGuide]), std::abs(x[Unknowns::kCoupler]), x.segment<2>(Unknowns::kRodX).norm()});
    if (least < kLeastLink) return false;
    return std::all_of(rows_.begin(), rows_.end(),
                       [&](const Row& row) { return linkage.at(row.cosine, row.sine).closed; });
  }
  /// Returns the residuals of the rows alone, rms and largest [m].
  std::array<double, 2> left(const Vector& x) const {
    const BucketLinkage linkage = linkageOf(x, branch, sense_);
    double sum = 0.0, worst = 0.0;
    for (const Row& row : rows_) {
      const double r = std::abs(residual(linkage, x, row));
      sum += r * r, worst = std::max(worst, r);
    }
    return {std::sqrt(sum / static_cast<double>(rows_.size())), worst};
  }
  Eigen::VectorXd arms(const Vector& x) const {
    const BucketLinkage linkage = linkageOf(x, branch, sense_);
    Eigen::VectorXd arm(static_cast<Eigen::Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      arm[static_cast<Eigen::Index>(i)] = linkage.at(rows_[i].cosine, rows_[i].sine).arm;
    return arm;
  }

 private:
  struct Row {
    double cosine, sine, stroke;
  };
  /// Returns the stroke's residual; for links that do not reach each other, ten times the missing length is added.
  static double residual(const BucketLinkage& linkage, const Eigen::VectorXd& x, const Row& row) {
    const BucketLinkagePosition at = linkage.at(row.cosine, row.sine);
    double off = at.length - x[Unknowns::kClosed] - row.stroke;
    if (at.closed) return off;
    const double reach = linkage.reach(at);
    const double lacks = std::max({0.0, linkage.leastReach() - reach, reach - linkage.mostReach()});
    return off + std::copysign(10.0 * lacks, off);
  }

  std::vector<Row> rows_;
  Vector mean_, deviation_;
  double sense_;
};

void settle(Problem& problem, Vector& x, int most) {
  Eigen::LevenbergMarquardt<Problem> solver(problem);
  solver.parameters.maxfev = most;
  solver.parameters.xtol = solver.parameters.ftol = 1e-12;
  Eigen::VectorXd at = x;
  solver.minimize(at);
  if (at.allFinite()) x = at;
}

struct Candidate {
  Vector x;
  double branch{}, cost{};
};

std::vector<Candidate> candidates(Problem& problem, const Progress& progress) {
  std::mt19937 random(1);
  std::vector<Candidate> all;
  for (int i = 0; i < kStarts; ++i) {
    problem.branch = i % 2 == 0 ? 1.0 : -1.0;
    Vector x = problem.drawn(random);
    settle(problem, x, 60);
    if (problem.closes(x)) all.push_back({x, problem.branch, problem.cost(x)});
    report(progress, 0.7 * (i + 1.0) / kStarts);
  }
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  if (all.size() > kBest) all.resize(kBest);
  return all;
}

/// Fits with the remaining noise, which decides the weight of the prior.
void refine(Problem& problem, Candidate& candidate) {
  problem.branch = candidate.branch;
  for (int round = 0; round < 4; ++round) {
    settle(problem, candidate.x, 2000);
    problem.noise = std::max(kReading, problem.left(candidate.x)[0]);
  }
  candidate.cost = problem.closes(candidate.x) ? problem.left(candidate.x)[0] : kInfinity;
}

/// Selects, among fits whose residuals are within the readings' accuracy, the one nearest to the prior.
const Candidate& mostProbable(Problem& problem, std::vector<Candidate>& all) {
  const auto less = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
  problem.noise = std::max(kReading, std::min_element(all.begin(), all.end(), less)->cost);
  for (Candidate& c : all) {
    problem.branch = c.branch;
    if (std::isfinite(c.cost)) c.cost = problem.cost(c.x);
  }
  return *std::min_element(all.begin(), all.end(), less);
}

void fillEstimates(const Problem& problem, const LinkageBasis& basis, const std::string& cylinder, LinkageFit& fit) {
  Eigen::MatrixXd J(problem.values(), problem.inputs());
  problem.df(fit.value, J);
  const Eigen::MatrixXd covariance = inverseOf(Eigen::MatrixXd(J.transpose() * J));
  Eigen::MatrixXd by_arm(problem.arms(fit.value).size(), problem.inputs());
  for (int i = 0; i < Unknowns::kCount; ++i) {
    Vector up = fit.value, down = fit.value;
    up[i] += 1e-5, down[i] -= 1e-5;
    by_arm.col(i) = (problem.arms(up) - problem.arms(down)) / 2e-5;
  }
  const Eigen::VectorXd arms = problem.arms(fit.value);
  const auto rows = static_cast<double>(arms.size());
  fit.arm = arms.norm() / std::sqrt(rows);
  fit.arm_std = std::sqrt((by_arm * covariance).cwiseProduct(by_arm).sum() / rows);
  std::vector<std::string> names;
  for (int i = 0; i < Unknowns::kCount; ++i) {
    const auto& measured = basis.measured[static_cast<std::size_t>(i)];
    names.push_back(cylinder + "_" + Unknowns::kKeys[static_cast<std::size_t>(i)]);
    fit.estimates.push_back({names.back(), "m", fit.value[i], std::sqrt(covariance(i, i)),
                             measured ? basis.tape_std : kAnyPlace,
                             measured ? format("measured %.6g", *measured) : "not measured"});
  }
  addCorrelations(covariance, names, fit);
}

}  // namespace

BucketLinkage LinkageFit::linkage(double sense) const { return linkageOf(value, branch, sense); }

std::optional<StrokeTable> readStrokeTable(const std::string& csv, std::string& problem) {
  StrokeTable table;
  std::istringstream lines(csv);
  std::string line;
  bool headed = false;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::vector<std::string> cells = csvCells(line);
    if (cells[0].empty() ? cells.size() == 1 : cells[0].front() == '#') continue;
    if (!std::exchange(headed, true)) {
      if (cells == std::vector<std::string>{"stroke_m", "angle_rad"}) continue;
      problem = format("line %zu: %.40s, must be the header stroke_m,angle_rad", number, line.c_str());
      return {};
    }
    const std::optional<double> stroke = decimalNumber(cells[0]), angle = decimalNumber(cells.back());
    if (cells.size() != 2 || !stroke || !angle || std::abs(*stroke) > 100.0 || std::abs(*angle) > 7.0) {
      constexpr char kRule[] = "line %zu: %.40s, must be two numbers: a stroke up to 100 m, an angle up to 7 rad";
      problem = format(kRule, number, line.c_str());
      return {};
    }
    table.stroke.push_back(*stroke), table.angle.push_back(*angle);
  }
  if (table.stroke.size() >= kLeastTableRows) return table;
  problem = format("%zu rows, must be at least %zu over the whole stroke", table.stroke.size(), kLeastTableRows);
  return {};
}

LinkageFit fitLinkage(const StrokeTable& table, const LinkageBasis& basis, const std::string& cylinder,
                      const Progress& progress) {
  LinkageFit fit;
  Problem problem(table, basis);
  std::vector<Candidate> best = candidates(problem, progress);
  if (best.empty()) {
    fit.problem = "no linkage of two links reaches all angles of the table";
    return fit;
  }
  for (std::size_t i = 0; i < best.size(); ++i) {
    problem.noise = 1e-3;
    refine(problem, best[i]);
    report(progress, 0.7 + 0.3 * (static_cast<double>(i) + 1.0) / static_cast<double>(best.size()));
  }
  const Candidate& found = mostProbable(problem, best);
  problem.branch = found.branch;
  problem.noise = std::max(kReading, problem.left(found.x)[0]);
  fit.value = found.x, fit.branch = found.branch, fit.rows = table.stroke.size();
  for (const int length : {Unknowns::kGuide, Unknowns::kCoupler}) fit.value[length] = std::abs(fit.value[length]);
  const auto [left, worst] = problem.left(fit.value);
  fit.left = left, fit.worst = worst;
  fillEstimates(problem, basis, cylinder, fit);
  const auto known = [&](int x) {
    return basis.measured[static_cast<std::size_t>(x)] && basis.measured[static_cast<std::size_t>(x) + 1];
  };
  if (!known(Unknowns::kBaseX) && !known(Unknowns::kGuideX) && !known(Unknowns::kRodX))
    fit.remarks.push_back(
        "the table does not show how all pins are turned about the joint together: levers are right, "
        "directions of pin forces are not; measure both coordinates of one pin");
  return fit;
}

}  // namespace hammer_loads::calibration
