/// Powers and products of columns, summed without rounding: moments and Pearson's correlations that do not depend on the
/// order of the runs.
///
///   z = (x − s) 2^−e   with a shift s and a scale 2^e near the values' own: no digits are lost to a mean far from 0
#pragma once

#include "montecarlo/foundation/statistics/pairwise_correlation.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/results/streaming/exact_sum.hpp"

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace wingspread {

/// z of a column's values.
struct Scale {
  double shift = 0, per_unit = 1; ///< 2^−e
  [[nodiscard]] double of(double value) const { return (value - shift) * per_unit; }
  bool operator==(const Scale&) const = default;
};

/// By a pilot's values: their mean, and their standard deviation's power of two.
/// @param values any; those that are not finite are left out
[[nodiscard]] Scale scale_of(std::span<const double> values);

/// n and Σz, Σz², Σz³, Σz⁴.
struct PowerSums {
  long count = 0;
  std::array<ExactSum, 4> powers;

  void add(double z) {
    ++count;
    const double squared = z * z;
    powers[0].add(z);
    powers[1].add(squared);
    powers[2].add(squared * z);
    powers[3].add(squared * squared);
  }
  void add(const PowerSums& other);
  /// @param min, max of the values
  [[nodiscard]] Moments moments(const Scale& scale, double min, double max) const;
  void write(StateWriter& to) const;
  void read(StateReader& from);
};

/// Of each of some columns x with each of others y: over the runs in which both have a value.
///
/// Sums over the runs in which y has none are kept in place of those in which it has one, for they are fewer.
class CoMoments {
public:
  CoMoments() = default;
  CoMoments(std::size_t xs, std::size_t ys);

  /// @param x, y z's of one run; NaN where there is none
  void add(std::span<const double> x, std::span<const double> y);
  void add(const CoMoments& other);
  [[nodiscard]] Correlation of(std::size_t x, std::size_t y) const;

  void write(StateWriter& to) const;
  void read(StateReader& from);

private:
  struct Column {
    long count = 0;
    ExactSum sum, squares;
  };
  struct Pair {
    ExactSum products;
    Column x, y; ///< of x where y is missing; of y where x is
  };

  std::vector<Column> x_, y_;
  std::vector<Pair> pairs_; ///< by x and then y
};

} // namespace wingspread
