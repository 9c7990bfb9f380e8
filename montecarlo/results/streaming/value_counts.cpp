#include "montecarlo/results/streaming/value_counts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace wingspread {
namespace {

constexpr int linear_bits = 17; // for |j| < 2^17 each j has its own bin
constexpr int most_bits = 16;   // the first octave beyond has 2^16 bins
constexpr int least_bits = 6;   // the last octaves have 2^6 bins each
constexpr int most_octaves = 1024 - linear_bits;
constexpr int least_exponent = -1000, most_exponent = 900;

constexpr int bits_of(int octave) { return std::max(most_bits - octave, least_bits); }

/// Number of bins in all octaves before this one.
constexpr std::int64_t bins_before(int octave) {
  const int falling = std::min(octave, most_bits - least_bits);
  const std::int64_t in_falling =
      (std::int64_t{1} << (most_bits + 1)) - (std::int64_t{1} << (most_bits + 1 - falling));
  return in_falling + (octave - falling) * (std::int64_t{1} << least_bits);
}

constexpr std::int64_t linear_bins = std::int64_t{1} << linear_bits;
constexpr std::int64_t one_side = linear_bins + bins_before(most_octaves + 1);

/// The bin of j ≥ 0.
std::int64_t bin_of(double j) {
  if (j < static_cast<double>(linear_bins)) return static_cast<std::int64_t>(j);
  const int octave = std::ilogb(j) - linear_bits;
  const double within = std::ldexp(j, bits_of(octave) - linear_bits - octave) -
                        std::ldexp(1.0, bits_of(octave)); // from 0 to less than 2^bits
  return linear_bins + bins_before(octave) + static_cast<std::int64_t>(within);
}

/// The least j of a bin; infinite after the last bin.
double least_of(std::int64_t bin) {
  if (bin <= linear_bins) return static_cast<double>(bin);
  const std::int64_t beyond = bin - linear_bins;
  int octave = 0;
  while (octave <= most_octaves && bins_before(octave + 1) <= beyond) ++octave;
  if (octave > most_octaves) return std::numeric_limits<double>::infinity();
  const double within = static_cast<double>(beyond - bins_before(octave));
  return std::ldexp(std::ldexp(1.0, bits_of(octave)) + within,
                    linear_bits + octave - bits_of(octave));
}

/// An interval of values: its middle, and the standard deviation of a normal law that has the same share of values in
/// an interval of this length about its mean.
struct Dense {
  double middle, deviation;
};

/// The shortest interval with a fifth of the values; with a larger share if a fifth of them are equal.
Dense densest(std::span<const double> sorted) {
  struct Share {
    double part, deviations; // deviations: length of a normal law's shortest interval with `part`
  };
  // 2 Φ⁻¹((1 + part)/2); for part 1 the range of 4096 normal values
  constexpr Share shares[] = {{0.2, 0.5067}, {0.5, 1.349}, {0.8, 2.563}, {1, 7}};
  for (const auto& [part, deviations] : shares) {
    const auto reach = static_cast<std::size_t>(
        std::max(1.0, std::floor(part * static_cast<double>(sorted.size() - 1))));
    double length = std::numeric_limits<double>::infinity(), middle = 0;
    for (std::size_t i = 0; i + reach < sorted.size(); ++i)
      if (sorted[i + reach] - sorted[i] < length) {
        length = sorted[i + reach] - sorted[i];
        middle = sorted[i] + length / 2;
      }
    if (length > 0 && std::isfinite(length)) return {middle, length / deviations};
  }
  return {sorted.front(), std::abs(sorted.front()) * 1e-3}; // all equal: as for one value
}

} // namespace

Grid grid_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return {};
  std::ranges::sort(values);
  // A single value has no scale. Heuristic: 1e-3 of the value; another scale gives coarser bins or more of them.
  const Dense dense =
      values.size() > 1 ? densest(values) : Dense{values[0], std::abs(values[0]) * 1e-3};
  const double deviation = dense.deviation > 0 ? dense.deviation : 1;
  constexpr int per_deviation = 13; // binary digits
  Grid grid;
  // Not finer than the spacing of doubles near the values, so that j is exact.
  const int finest = dense.middle == 0 ? least_exponent : std::ilogb(dense.middle) - 51;
  grid.exponent = std::clamp(std::max(std::ilogb(deviation) - per_deviation, finest),
                             least_exponent, most_exponent);
  grid.origin = std::floor(std::ldexp(dense.middle, -grid.exponent));
  return grid;
}

ValueCounts::ValueCounts(const Grid& grid)
    : grid_(grid), per_width_(std::ldexp(1.0, -grid.exponent)),
      pages_(static_cast<std::size_t>(2 * one_side) / page_size + 1) {}

/// The bin's index, ≥ 0. Bins are mirrored: j < 0 lies as far below the middle as −1 − j lies above.
std::int64_t ValueCounts::index_of(double value) const {
  constexpr double largest = std::numeric_limits<double>::max();
  const double j = std::clamp(std::floor(value * per_width_) - grid_.origin, -largest, largest);
  return j < 0 ? one_side - 1 - bin_of(-1 - j) : one_side + bin_of(j);
}

double ValueCounts::lower_edge(std::int64_t index) const {
  const double j = index >= one_side ? least_of(index - one_side) : -least_of(one_side - index);
  return std::ldexp(j + grid_.origin, grid_.exponent);
}

std::int64_t& ValueCounts::page_of(std::int64_t index) {
  const auto place = static_cast<std::size_t>(index);
  std::unique_ptr<Page>& page = pages_[place / page_size];
  if (!page) page = std::make_unique<Page>();
  return (*page)[place % page_size];
}

void ValueCounts::add(const ValueCounts& other) {
  zeros_ += other.zeros_;
  for (std::size_t p = 0; p < pages_.size(); ++p) {
    if (!other.pages_[p]) continue;
    if (!pages_[p]) pages_[p] = std::make_unique<Page>();
    for (std::size_t i = 0; i < page_size; ++i) (*pages_[p])[i] += (*other.pages_[p])[i];
  }
}

std::vector<ValueCounts::Bin> ValueCounts::bins() const {
  std::vector<Bin> found;
  long below = 0, zeros = zeros_;
  const auto add = [&](double lower, double upper, long count) {
    if (count > 0) found.push_back({lower, upper, below, count});
    below += count;
  };
  // 0 is an edge, unless it lies so far out that a wide bin straddles it: then zeros are counted in that bin.
  constexpr double above_zero = std::numeric_limits<double>::denorm_min();
  const auto add_zeros = [&] { add(0, above_zero, std::exchange(zeros, 0)); };
  for (std::size_t p = 0; p < pages_.size(); ++p)
    for (std::size_t i = 0; pages_[p] && i < page_size; ++i) {
      const long count = (*pages_[p])[i];
      if (count == 0) continue;
      const auto index = static_cast<std::int64_t>(p * page_size + i);
      const double lower = lower_edge(index), upper = lower_edge(index + 1);
      if (lower >= 0) add_zeros();
      const bool straddles = lower < 0 && upper > 0;
      add(lower == 0 ? above_zero : lower, upper,
          count + (straddles ? std::exchange(zeros, 0) : 0));
    }
  add_zeros();
  return found;
}

void ValueCounts::write(StateWriter& to) const {
  to.put(static_cast<std::int32_t>(grid_.exponent));
  to.put(grid_.origin);
  to.put(zeros_);
  to.put(static_cast<std::uint64_t>(
      std::ranges::count_if(pages_, [](const auto& page) { return page != nullptr; })));
  for (std::size_t p = 0; p < pages_.size(); ++p) {
    if (!pages_[p]) continue;
    to.put(static_cast<std::uint32_t>(p));
    for (const std::int64_t count : *pages_[p]) to.put(count);
  }
}

void ValueCounts::read(StateReader& from) {
  Grid grid;
  grid.exponent = from.get<std::int32_t>();
  grid.origin = from.get<double>();
  *this = ValueCounts(grid);
  zeros_ = from.get<std::int64_t>();
  for (std::size_t left = from.get_count(sizeof(Page)); left > 0; --left) {
    const std::size_t p = from.get<std::uint32_t>();
    if (p >= pages_.size() || pages_[p]) throw from.broken("pages of counts");
    pages_[p] = std::make_unique<Page>();
    for (std::int64_t& count : *pages_[p]) count = from.get<std::int64_t>();
  }
}

} // namespace wingspread
