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

/// A figure and the contribution of each source to its variance.
struct BudgetFigure {
  struct Source {
    std::string name;  ///< a key of the parameter files, "readings", or an effect that a model level neglects
    double variance{};
  };
  std::string quantity;
  double value{}, deviation{};  ///< mean over the run, and standard deviation of one revolution's value
  std::vector<Source> sources;  ///< only those with a contribution
};

/// Collects the contributions to pulse, blow and ranges of the hull's loads over all revolutions of a run.
class BudgetRecorder {
 public:
  explicit BudgetRecorder(const Pipeline& pipeline);

  /// Takes the pipeline's last sample or the ends of Pipeline::end(). No allocation.
  void follow() noexcept;
  /// Returns the budgets of pulse and blow; empty before a revolution has ended.
  std::vector<BudgetFigure> figures() const;
  /// Returns relative variances of a hull channel's ranges; empty before a revolution has ended.
  std::vector<BudgetFigure::Source> ofRange(std::size_t channel) const;

 private:
  using Columns = NumberError::Columns;
  using Unknown = Eigen::Array<double, UnknownForce::kSources, 1>;
  struct Sum {
    std::uint64_t count{};
    double value{}, own{}, rod{};  ///< sums of values, and of variances
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
  /// Extreme sample of a revolution, and the sample that is most extreme with its own standard deviation added
  /// (life::TurnExtremes).
  struct Extreme {
    End end{}, reach{};
    double reached{};  ///< value of reach plus its deviation [channel's unit], times the sign
    double sign{1.0};  ///< -1: the least

    void add(const End& sample) noexcept;
    End known() const noexcept;  ///< the sample with the variances of the revolution's extreme
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
