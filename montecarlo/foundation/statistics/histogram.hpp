/// Histograms of a sample.
#pragma once

#include <span>
#include <variant>
#include <vector>

namespace wingspread {

/// The data decide the number of bins.
struct AutoBins {};
/// AutoBins, or a fixed number of bins > 0.
using Bins = std::variant<AutoBins, int>;

/// Most automatic bins. Heuristic: more cannot be told apart in a table or chart.
inline constexpr int most_auto_bins = 200;

/// Bin i is [edges[i], edges[i + 1]); the last one is closed, so that every value is in one bin.
struct Histogram {
  std::vector<double> edges; ///< increasing, one more than there are bins; empty without values
  std::vector<long> counts;  ///< per bin; their sum is the sample's size

  [[nodiscard]] long total() const;
  /// count / (total · width): Σ density · width = 1.
  [[nodiscard]] double density(std::size_t bin) const;
};

/// The number of bins. Fixed: as many as asked for. AutoBins: ⌈(max − min)/h⌉ with h = 2 IQR n^(−1/3) (D. Freedman,
/// P. Diaconis, Z. Wahrsch. verw. Geb. 57 (1981) 453–476); Sturges' ⌈log2 n⌉ + 1 if the IQR is 0; at most
/// `most_auto_bins`; one if all values are equal.
/// @param spread max − min
/// @param iqr    X_(⌈3n/4⌉) − X_(⌈n/4⌉)
[[nodiscard]] int count_bins(const Bins& bins, long n, double spread, double iqr);

/// Histogram of sorted values, smallest first, over [min, max] in count_bins() bins of equal width. A range too narrow
/// for that many distinct edges has fewer bins. If all values equal v, the range is [v − w, v + w] with w = |v|/2, or
/// 1/2 for v = 0. A value that equals an inner edge counts in the bin above that edge.
/// Cost O(bins · log n).
[[nodiscard]] Histogram histogram(std::span<const double> sorted, const Bins& bins);

} // namespace wingspread
