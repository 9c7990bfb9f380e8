#include "montecarlo/sensitivity/sobol_indices.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wingspread {
namespace {

/// The rows that have all their values.
std::vector<std::span<const double>> complete_rows(std::span<const double> values,
                                                   std::size_t points) {
  std::vector<std::span<const double>> rows;
  for (std::size_t at = 0; at + points <= values.size(); at += points) {
    const std::span<const double> row = values.subspan(at, points);
    if (std::ranges::none_of(row, [](double value) { return std::isnan(value); }))
      rows.push_back(row);
  }
  return rows;
}

/// What a row adds to the sums over rows, for one dispersion.
struct Terms {
  double product; ///< f_B (f_ABi − f_A)
  double change;  ///< f_ABi − f_A
  double square;  ///< its square
};

/// All rows' terms, with f taken from its mean over all rows.
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

/// (1) and (2) of all dispersions over the rows listed, which may repeat.
/// The rows' own mean is taken out of f_B: with m that mean, f_B − m in place of f_B.
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

/// The numbers of rows drawn with replacement.
void resample(std::uint64_t seed, long number, std::vector<std::size_t>& rows) {
  // no dispersion's name: those hold no control characters
  RandomStream stream(seed, static_cast<std::uint64_t>(number),
                      stream_name("\x7F"
                                  "bootstrap"));
  for (std::size_t& row : rows)
    row = static_cast<std::size_t>(open_uniform(stream()) * static_cast<double>(rows.size()));
}

Interval percentiles(std::vector<double> values, double confidence) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::ranges::sort(values);
  const double tail = (1 - confidence) / 2;
  return {quantile(values, tail), quantile(values, 1 - tail)};
}

bool is_inert(std::span<const std::span<const double>> rows, std::size_t i) {
  return std::ranges::all_of(rows, [i](const auto& row) { return row[2 + i] == row[0]; });
}

} // namespace

SobolIndices sobol_indices(std::span<const double> values, std::size_t dispersions,
                           const Bootstrap& bootstrap) {
  const auto rows = complete_rows(values, dispersions + 2);
  std::vector<double> base;
  for (const auto& row : rows) base.insert(base.end(), {row[0], row[1]});
  const Moments moments = wingspread::moments(base);
  const long all = static_cast<long>(values.size() / (dispersions + 2));
  SobolIndices result{std::ssize(rows), all - std::ssize(rows), moments.mean, undefined, {}};
  if (rows.empty()) {
    const SobolIndex none{undefined, {undefined, undefined}};
    result.effects.assign(dispersions, {none, none, true});
    return result;
  }
  const double n = static_cast<double>(base.size());
  result.variance = moments.std * moments.std * (n - 1) / n;
  const Table table = table_of(rows, dispersions, moments.mean);
  std::vector<std::size_t> chosen(rows.size());
  for (std::size_t row = 0; row < chosen.size(); ++row) chosen[row] = row;
  const std::vector<Estimate> whole = estimates(table, chosen);
  std::vector<std::vector<double>> first(dispersions), total(dispersions);
  for (long k = 0; k < bootstrap.resamples; ++k) {
    resample(bootstrap.seed, k, chosen);
    const std::vector<Estimate> again = estimates(table, chosen);
    for (std::size_t i = 0; i < dispersions; ++i) {
      first[i].push_back(again[i].first);
      total[i].push_back(again[i].total);
    }
  }
  for (std::size_t i = 0; i < dispersions; ++i)
    result.effects.push_back({{whole[i].first, percentiles(first[i], bootstrap.confidence)},
                              {whole[i].total, percentiles(total[i], bootstrap.confidence)},
                              is_inert(rows, i)});
  return result;
}

} // namespace wingspread
