/// Streaming order statistics of one quantity: the values themselves are not stored, but counted in bins, and the most
/// extreme ones are kept.
#pragma once

#include "montecarlo/results/streaming/extremes.hpp"
#include "montecarlo/results/streaming/value_counts.hpp"

namespace wingspread {

/// Number of largest values, and of smallest values, that are kept with their runs. Enough for an upper tolerance limit
/// at p = 0.9973 up to 10⁶ runs, and at p = 0.99999 up to 4·10⁸ runs.
inline constexpr std::size_t kept_extremes = 4096;

/// An order statistic: exact if it is among the kept extremes, else interpolated in its bin.
struct OrderStatistic {
  double value;        ///< exact, or interpolated by rank as if values were even in the bin
  double lower, upper; ///< the order statistic lies within; both equal `value` if exact
  long rank_error = 0; ///< the rank of value is at most this far off
};

class Population {
public:
  explicit Population(const Grid& grid);

  /// @param value finite
  void add(double value, long run) {
    ++count_;
    counts_.add(value);
    lowest_.add(value, run);
    highest_.add(value, run);
  }
  /// @pre of the same grid
  void add(const Population& other);

  [[nodiscard]] long count() const { return count_; }
  /// NaN without values.
  [[nodiscard]] double min() const;
  [[nodiscard]] double max() const;
  [[nodiscard]] const Extremes& lowest() const { return lowest_; }
  [[nodiscard]] const Extremes& highest() const { return highest_; }
  [[nodiscard]] const ValueCounts& counts() const { return counts_; }

  void write(StateWriter& to) const;
  void read(StateReader& from);

private:
  long count_ = 0;
  ValueCounts counts_;
  Extremes lowest_, highest_;
};

/// A population sorted once, for several queries.
class RankedPopulation {
public:
  explicit RankedPopulation(const Population& population);

  [[nodiscard]] long count() const { return count_; }
  [[nodiscard]] double min() const { return lowest_.front().value; }
  [[nodiscard]] double max() const { return highest_.front().value; }
  /// @param rank 1 for the smallest. @pre 1 ≤ rank ≤ count
  [[nodiscard]] OrderStatistic at(long rank) const;
  [[nodiscard]] const std::vector<ValueCounts::Bin>& bins() const { return bins_; }

private:
  long count_;
  std::vector<RunValue> lowest_, highest_;
  std::vector<ValueCounts::Bin> bins_;
};

} // namespace wingspread
