#include "montecarlo/analyses/sensitivity/sobol_indices.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/statistics/jackknife.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wingspread {
namespace {

/// A design's values by row: A, B, AB_1, …; an incomplete last row is ignored.
std::vector<std::span<const double>> rows_of(std::span<const double> values, std::size_t points) {
  std::vector<std::span<const double>> rows;
  for (std::size_t at = 0; at + points <= values.size(); at += points)
    rows.push_back(values.subspan(at, points));
  return rows;
}

bool is_incomplete(std::span<const double> row) {
  return std::ranges::any_of(row, [](double value) { return std::isnan(value); });
}

/// One row's terms of the sums (1) and (2), for one dispersion.
struct Terms {
  double product; ///< f_B (f_ABi − f_A)
  double change;  ///< f_ABi − f_A
  double square;  ///< its square
};

/// The terms of all rows. f is the output minus its mean over all rows.
struct Table {
  std::vector<double> sum, square; ///< f_A + f_B and f_A² + f_B² of each row
  std::vector<Terms> terms;        ///< by row, then dispersion
  std::size_t dispersions;
};

Table table_of(std::span<const std::span<const double>> rows, std::size_t dispersions,
               double mean) {
  Table table{{}, {}, {}, dispersions};
  for (const std::span<const double> row : rows) {
    const double a = row[0] - mean, b = row[1] - mean;
    table.sum.push_back(a + b);
    table.square.push_back(a * a + b * b);
    for (std::size_t i = 0; i < dispersions; ++i) {
      const double change = row[2 + i] - row[0];
      table.terms.push_back({b * change, change, change * change});
    }
  }
  return table;
}

struct Estimate {
  double first, total;
};

/// (1) and (2) of all dispersions over the listed rows, which may repeat. For (1) the mean m over the listed rows is
/// subtracted from f_B: Σ (f_B − m)(f_ABi − f_A).
std::vector<Estimate> estimates(const Table& table, std::span<const std::size_t> rows) {
  const double n = static_cast<double>(rows.size());
  std::vector<Terms> sums(table.dispersions, Terms{0, 0, 0});
  double sum = 0, square = 0;
  for (const std::size_t row : rows) {
    sum += table.sum[row];
    square += table.square[row];
    const Terms* terms = &table.terms[row * table.dispersions];
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i].product += terms[i].product;
      sums[i].change += terms[i].change;
      sums[i].square += terms[i].square;
    }
  }
  const double mean = sum / (2 * n), variance = square / (2 * n) - mean * mean;
  std::vector<Estimate> result;
  for (const Terms& t : sums)
    result.push_back(variance > 0 ? Estimate{(t.product - mean * t.change) / n / variance,
                                             t.square / n / (2 * variance)}
                                  : Estimate{undefined, undefined});
  return result;
}

/// Draws row numbers with replacement.
void resample(std::uint64_t seed, long number, std::vector<std::size_t>& rows) {
  // the stream's name has a control character, which no dispersion's name may contain
  RandomStream stream(seed, static_cast<std::uint64_t>(number),
                      stream_name("\x7F"
                                  "bootstrap"));
  for (std::size_t& row : rows)
    row = static_cast<std::size_t>(open_uniform(stream()) * static_cast<double>(rows.size()));
}

Bounds percentiles(const std::vector<double>& values, double confidence) {
  const std::vector<double> sorted = sorted_present(values);
  const double tail = (1 - confidence) / 2;
  if (sorted.empty()) return {};
  return {quantile(sorted, tail), quantile(sorted, 1 - tail)};
}

/// The estimates of all dispersions, for each of several selections of rows.
using Choices = std::vector<std::vector<Estimate>>;

Choices resampled(const Table& table, std::size_t rows, const SobolBounds& how) {
  Choices all;
  std::vector<std::size_t> chosen(rows);
  for (long k = 0; k < how.resamples; ++k) {
    resample(how.seed, k, chosen);
    all.push_back(estimates(table, chosen));
  }
  return all;
}

/// The estimates that leave out each replicate in turn; empty if there are fewer than two replicates.
Choices without_each(const Table& table, std::size_t rows, std::size_t replicates) {
  Choices all;
  if (replicates < 2 || rows < replicates) return all;
  for (std::size_t left_out = 0; left_out < replicates; ++left_out) {
    std::vector<std::size_t> chosen;
    for (std::size_t row = 0; row < rows; ++row)
      if (row % replicates != left_out) chosen.push_back(row);
    all.push_back(estimates(table, chosen));
  }
  return all;
}

std::vector<double> of_dispersion(const Choices& choices, std::size_t i, double Estimate::*index) {
  std::vector<double> values;
  for (const std::vector<Estimate>& each : choices) values.push_back(each[i].*index);
  return values;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool is_inert(std::span<const std::span<const double>> rows, std::size_t i) {
  return std::ranges::all_of(rows, [i](const auto& row) { return same(row[2 + i], row[0]); });
}

/// Sets the indices of a design without missing values.
void add_indices(std::span<const std::span<const double>> rows, double mean, const SobolBounds& how,
                 std::vector<SobolEffect>& effects) {
  const Table table = table_of(rows, effects.size(), mean);
  std::vector<std::size_t> every(rows.size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  const std::vector<Estimate> whole = estimates(table, every);
  const bool independent = how.replicates == 0;
  const Choices again =
      independent ? resampled(table, rows.size(), how)
                  : without_each(table, rows.size(), static_cast<std::size_t>(how.replicates));
  const auto index = [&](std::size_t i, double Estimate::*which) -> SobolIndex {
    const std::vector<double> values = of_dispersion(again, i, which);
    const double value = whole[i].*which;
    if (std::ssize(rows) < least_rows_for_bounds) return {value, {}};
    return {value, independent ? percentiles(values, how.confidence)
                               : jackknife_bounds(value, values, how.confidence)};
  };
  for (std::size_t i = 0; i < effects.size(); ++i) {
    effects[i].first = index(i, &Estimate::first);
    effects[i].total = index(i, &Estimate::total);
  }
}

} // namespace

SobolIndices sobol_indices(std::span<const double> values, std::size_t dispersions,
                           const SobolBounds& how) {
  const auto rows = rows_of(values, dispersions + 2);
  std::vector<double> base;
  for (const auto& row : rows)
    for (const double value : row.first(2))
      if (!std::isnan(value)) base.push_back(value);
  const Moments moments = wingspread::moments(base);
  SobolIndices result{
      std::ssize(rows), std::ranges::count_if(rows, is_incomplete), moments.mean, undefined, {}};
  const SobolIndex none{undefined, {}};
  for (std::size_t i = 0; i < dispersions; ++i)
    result.effects.push_back({none, none, is_inert(rows, i)});
  if (base.empty()) return result;
  const double n = static_cast<double>(base.size());
  result.variance = moments.std * moments.std * (n - 1) / n;
  if (result.incomplete == 0) add_indices(rows, moments.mean, how, result.effects);
  return result;
}

} // namespace wingspread
