/// Uncertainty budget of a run's figures (JCGM 100, 5.1.2: one contribution to the variance for each source).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "hammer_loads/pipeline/channel_values.h"
#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {

/// A figure and what each source adds to its variance.
struct BudgetFigure {
  struct Source {
    std::string name;  ///< a key of the parameter files, "readings", or what a level leaves out
    double variance{};
  };
  std::string quantity;
  double value{}, deviation{};  ///< mean over the run, and the standard deviation of one turn's
  std::vector<Source> sources;  ///< without those that add nothing
};

/// Collects the contributions to pulse, blow and ranges of the hull's loads over all turns of a run.
class BudgetRecorder {
 public:
  explicit BudgetRecorder(const Pipeline& pipeline);

  /// Takes the pipeline's last sample or the ends of Pipeline::end(). No allocation.
  void follow() noexcept;
  /// Budgets of pulse and blow; empty before a revolution has ended.
  std::vector<BudgetFigure> figures() const;
  /// Relative variances of the ranges of a hull channel, of kHullChannels; all zero before a turn has ended.
  std::vector<BudgetFigure::Source> ofRange(std::size_t channel) const;

 private:
  using Columns = NumberError::Columns;
  using Unknown = Eigen::Array<double, UnknownForce::kSources, 1>;
  struct Sum {
    std::uint64_t count{};
    double value{}, own{}, rod{};  ///< the latter of variances
    Columns columns{Columns::Zero()};

    void add(double number, const NumberError& error) noexcept;
  };
  struct End {
    double own() const noexcept { return readings + rod + unknown.sum(); }

    double value{};
    Columns columns{Columns::Zero()};
    double readings{}, rod{};          ///< variances
    Unknown unknown{Unknown::Zero()};  ///< variances by source of UnknownForce
  };
  /// Extreme sample of a revolution, and the sample that may be the extreme by one of its own deviations
  /// (life::TurnExtremes).
  struct Extreme {
    End end{}, reach{};
    double reached{};  ///< value of reach plus its deviation [channel's unit], times the sign
    double sign{1.0};  ///< -1: the least

    void add(const End& sample) noexcept;
    End known() const noexcept;  ///< the sample, its variances those of the turn's extreme
  };
  /// Range of one channel: of the present revolution, and sums over revolutions weighted by the range.
  struct Range {
    Extreme least, greatest;
    bool begun{};
    double square{}, readings{}, rod{};
    Unknown unknown{Unknown::Zero()};
    Columns columns{Columns::Zero()};

    void add(const End& sample) noexcept;
    void endTurn() noexcept;
  };
  void sample(const SampleResult& result) noexcept;
  std::vector<BudgetFigure::Source> sources(const Columns& columns, double readings, double rod,
                                            const Unknown& unknown = Unknown::Zero()) const;

  const Pipeline* pipeline_;
  std::array<std::string, kLoadColumns> names_;
  std::array<Range, kHullChannels> ranges_;
  Sum amplitude_, impulse_, turn_impulse_x_, turn_impulse_z_, energy_, restitution_;
};

}  // namespace hammer_loads
