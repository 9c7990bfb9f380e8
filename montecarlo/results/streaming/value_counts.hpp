/// How often values fell where: counts that do not depend on the order of the values or on how they were shared out,
/// in memory that does not grow with their number.
///
///   symbol  meaning
///   w       width of the narrowest bins: a power of two, about 1/8192 of the standard deviation of the values' densest part
///   o       origin, where it lies, in units of w: a whole number
///   j       floor(x/w) − o, a whole number, exact in doubles
///
/// Bins are one j wide for |j| < 2^17, which is 16 such deviations either way; beyond, each octave [2^(17+i), 2^(18+i)) of j
/// is cut into 2^max(16−i, 6) of them: ever coarser, never lost. Edges are exact: a value lies in [lower, upper) of its bin
/// by comparison with them. So ranks at edges are known, and an order statistic lies between those of its bin: what is not
/// known is said with every number that is taken from it. (Sketches that promise a rank error, as those of Greenwald and
/// Khanna or t-digests, depend on the order of the values, and t-digests promise none.)
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

/// By the densest part of a pilot's values: its shortest stretch that holds a fifth of them, or more where values repeat.
/// @param values any; NaN and infinite ones are left out
[[nodiscard]] Grid grid_of(std::vector<double> values);

class ValueCounts {
public:
  explicit ValueCounts(const Grid& grid);

  void add(double value) { ++(value == 0 ? zeros_ : page_of(index_of(value))); }
  /// @pre of the same grid
  void add(const ValueCounts& other);

  /// A bin, and how many values lie below it.
  struct Bin {
    double lower, upper; ///< the values are in [lower, upper)
    long below, count;
  };
  /// Those with values in them, from the lowest on. Cost: that of all bins there can be, some 2600 pages.
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
  std::int64_t zeros_ = 0; ///< counted apart: what does not happen is often a 0
};

} // namespace wingspread
