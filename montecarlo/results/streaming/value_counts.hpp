/// Counts values in bins. The counts do not depend on the order of the values or on how they were split, and memory
/// does not grow with their number.
///
///   symbol  meaning
///   w       width of the narrowest bins: a power of two, about 1/8192 standard deviation of the values' densest part
///   o       origin in units of w: a whole number
///   j       floor(x/w) − o, a whole number, exact in doubles
///
/// Bins are one j wide for |j| < 2^17, i.e. 16 such deviations either way. Beyond, each octave [2^(17+i), 2^(18+i))
/// of j is cut into 2^max(16−i, 6) bins: coarser, but no value is lost. Scaling by a power of two is exact, so each
/// value is counted in the bin that contains it. So ranks at edges are known, an order statistic lies between the edges
/// of its bin, and its uncertainty is known. Ruled out: Greenwald–Khanna and t-digest sketches, because they depend on
/// the order of the values, and t-digest guarantees no error.
#pragma once

#include "montecarlo/results/streaming/state_file.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace wingspread {

struct Grid {
  int exponent = -20; ///< w = 2^exponent
  double origin = 0;  ///< o
  bool operator==(const Grid&) const = default;
};

/// The grid for the densest part of the values: their shortest interval that holds a fifth of them, or more if values
/// repeat.
/// @param values of the pilot; NaN and infinite ones are ignored
[[nodiscard]] Grid grid_of(std::vector<double> values);

class ValueCounts {
public:
  explicit ValueCounts(const Grid& grid);

  void add(double value) { ++(value == 0 ? zeros_ : page_of(index_of(value))); }
  /// @pre of the same grid
  void add(const ValueCounts& other);

  /// A bin, and the number of values below it.
  struct Bin {
    double lower, upper; ///< the values are in [lower, upper)
    long below, count;
  };
  /// The bins that hold values, from the lowest. Cost: a pass over all possible pages, some 2600.
  [[nodiscard]] std::vector<Bin> bins() const;
  [[nodiscard]] const Grid& grid() const { return grid_; }

  void write(StateWriter& to) const;
  void read(StateReader& from);

private:
  static constexpr std::size_t page_size = 256;
  using Page = std::array<std::int64_t, page_size>;

  [[nodiscard]] std::int64_t index_of(double value) const;
  [[nodiscard]] double lower_edge(std::int64_t index) const;
  [[nodiscard]] std::int64_t& page_of(std::int64_t index);

  Grid grid_;
  double per_width_; ///< 1/w
  std::vector<std::unique_ptr<Page>> pages_;
  std::int64_t zeros_ = 0; ///< counted apart: e.g. overtravel is often exactly 0
};

} // namespace wingspread
