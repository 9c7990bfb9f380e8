/// Ranks of a campaign's draws over selected runs, and their rank correlations with an output.
#pragma once

#include "montecarlo/foundation/statistics/rank_correlation.hpp"
#include "montecarlo/foundation/statistics/ranked_column.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <vector>

namespace wingspread {

using Rows = std::vector<bool>;       ///< which runs are kept
inline constexpr int all_threads = 0; ///< as of thread_count (thread_pool.hpp)

/// The ranks of the draws over selected runs, and their partial correlations.
class RankedDraws {
public:
  RankedDraws(const std::vector<RankedColumn>& draws, const Rows& keep)
      : ranks_(ranks_of(draws, keep)), partial_(ranks_, all_threads) {}

  [[nodiscard]] const PartialCorrelations& partial() const { return partial_; }
  [[nodiscard]] const std::vector<Spilled<double>>& ranks() const { return ranks_; }

  struct Coefficients {
    std::vector<double> spearman, partial;
    double unexplained = undefined; ///< 1 − R² of the output's ranks
  };
  /// @param ranks of the output, in the kept runs
  [[nodiscard]] Coefficients with(const std::vector<double>& ranks) const {
    Coefficients found;
    for (const Spilled<double>& draw : ranks_) {
      found.spearman.push_back(pearson(draw, ranks));
      draw.release();
    }
    found.partial = partial_.given(found.spearman);
    found.unexplained = partial_.unexplained(found.spearman);
    return found;
  }

  /// Standard errors of Spearman's coefficients with the output (rank_correlation_error).
  [[nodiscard]] std::vector<double> errors(const std::vector<double>& ranks) const {
    std::vector<double> found;
    for (const Spilled<double>& draw : ranks_) {
      found.push_back(rank_correlation_error({draw.begin(), draw.end()}, ranks));
      draw.release();
    }
    return found;
  }

private:
  static std::vector<Spilled<double>> ranks_of(const std::vector<RankedColumn>& draws,
                                               const Rows& keep) {
    std::vector<Spilled<double>> ranks;
    for (const RankedColumn& draw : draws) ranks.emplace_back(draw.ranks_where(keep));
    return ranks;
  }

  std::vector<Spilled<double>> ranks_;
  PartialCorrelations partial_;
};

} // namespace wingspread
