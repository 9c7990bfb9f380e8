/// The values of one number over many runs: their order statistics, as far as they are known without the values.
#pragma once

#include "montecarlo/results/streaming/extremes.hpp"
#include "montecarlo/results/streaming/value_counts.hpp"

namespace wingspread {

/// So many of the largest and of the smallest values are kept, with their runs: what an upper tolerance limit takes at
/// p = 0.9973 up to 10⁶ runs, at p = 0.99999 up to 4·10⁸.
inline constexpr std::size_t kept_extremes = 4096;

/// An order statistic: exact where it is among the extremes that are kept, else by the bin that it lies in.
struct OrderStatistic {
  double value;        ///< in a bin by its rank, as if its values were spread evenly
  double lower, upper; ///< it lies within these; equal to the value where that is exact
  long rank_error = 0; ///< the value's own rank is at most so far off
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

/// A population sorted, to be asked several times.
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
