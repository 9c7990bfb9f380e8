/// Exact sums of powers and products of columns. The moments and Pearson correlations from them do not depend on the
/// order of the runs.
///
///   z = (x − s) 2^−e   with shift s near the values' median and scale 2^e near their standard deviation, so that a
///                      mean far from 0 costs no digits
#pragma once

#include "montecarlo/foundation/statistics/pairwise_correlation.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/results/streaming/exact_sum.hpp"

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace wingspread {

/// Maps a column's values to z.
struct Scale {
  double shift = 0, per_unit = 1; ///< 2^−e
  [[nodiscard]] double of(double value) const { return (value - shift) * per_unit; }
  bool operator==(const Scale&) const = default;
};

/// The shift is the median of the values, the scale the power of two next below their standard deviation.
/// @param values of the pilot; those that are not finite are ignored
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

/// Pearson correlations of columns x with columns y, each pair over the runs in which both have a value.
///
/// Stores the sums of each column over all runs, and for each pair the sums over the runs in which only one of the two
/// has a value. These runs are few, so a pair costs little time.
class CoMoments {
public:
  CoMoments() = default;
  CoMoments(std::size_t xs, std::size_t ys);

  /// @param x, y the z values of one run; NaN if missing
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
    Column x, y; ///< sums of x over the runs without y; of y over the runs without x
  };

  std::vector<Column> x_, y_;
  std::vector<Pair> pairs_; ///< by x and then y
};

} // namespace wingspread
