#include "montecarlo/sensitivity/rank_sensitivity.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/dependence.hpp"
#include "montecarlo/statistics/pairwise_correlation.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>

namespace wingspread {
namespace {

using Matrix = Eigen::MatrixXd;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

bool varies(std::span<const double> values) {
  return std::ranges::any_of(values, [&](double value) { return value != values.front(); });
}

/// The inverse of a correlation matrix, by its Cholesky factor; nothing when it is singular. By
/// hand, as the factor is: the same bytes however a library was compiled.
std::optional<Matrix> inverse_of(const Matrix& correlations) {
  const auto factor = cholesky(correlations);
  if (!factor) return std::nullopt;
  const Eigen::Index n = correlations.rows();
  Matrix root = Matrix::Zero(n, n); // L⁻¹
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) {
      double rest = i == j ? 1 : 0;
      for (Eigen::Index k = j; k < i; ++k) rest -= (*factor)(i, k) * root(k, j);
      root(i, j) = rest / (*factor)(i, i);
    }
  Matrix inverse = Matrix::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index k = std::max(i, j); k < n; ++k) inverse(i, j) += root(k, i) * root(k, j);
  return inverse;
}

/// How surely a coefficient is not 0: its z in standard errors under ρ = 0.
double standard_errors(double coefficient, long n, long held) {
  if (std::isnan(coefficient) || n - held <= 3) return 0;
  return std::abs(std::atanh(coefficient)) * std::sqrt(static_cast<double>(n - held - 3));
}

double two_sided_normal(double confidence) {
  const double tail = (1 - confidence) / 2;
  return inverse(Normal{}, {1 - tail, tail});
}

/// The draws' ranks over the runs that have some output, made ready.
struct RankedDraws {
  std::vector<Spilled<double>> ranks;
  PartialCorrelations partial;
};

std::vector<RankedColumn> ranked(const std::vector<Column>& columns) {
  std::vector<const Spilled<double>*> values;
  for (const Column& column : columns) values.push_back(&column.values);
  return rank_columns(values, 0);
}

/// Takes out the runs in which the column has no number.
void keep_runs_with(const Column& column, std::vector<bool>& keep) {
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (std::isnan(column.values[i])) keep[i] = false;
  column.values.release();
}

RankedDraws ranked_draws(const std::vector<RankedColumn>& draws, const std::vector<bool>& keep) {
  std::vector<Spilled<double>> ranks;
  for (const RankedColumn& draw : draws) ranks.emplace_back(draw.ranks_where(keep));
  PartialCorrelations partial(ranks);
  return {std::move(ranks), std::move(partial)};
}

OutputRanks output_ranks(const Column& output, const RankedDraws& draws,
                         const std::vector<bool>& keep, double confidence) {
  OutputRanks result{output.name,
                     std::ranges::count(keep, true),
                     std::ranges::count(keep, false),
                     {},
                     draws.partial.entangled()};
  const std::vector<double> ranks = RankedColumn(output.values).ranks_where(keep);
  std::vector<double> plain;
  for (const Spilled<double>& draw : draws.ranks) {
    plain.push_back(pearson(draw, ranks));
    draw.release();
  }
  const std::vector<double> partial = draws.partial.given(plain);
  const auto coefficient = [&](double value, long held) -> Coefficient {
    if (std::isnan(value)) return {value, {}};
    return {value, rank_correlation_bounds(value, result.count, held, confidence)};
  };
  for (std::size_t j = 0; j < plain.size(); ++j)
    result.effects.push_back({coefficient(plain[j], 0),
                              coefficient(partial[j], std::max(0L, draws.partial.varying() - 1))});
  return result;
}

void note_idle(const std::vector<Column>& draws, RankSensitivity& all) {
  const double tests = 2 * static_cast<double>(all.outputs.size());
  const double sure = two_sided_normal(1 - (1 - all.confidence) / tests);
  const auto count = static_cast<long>(
      std::ranges::count_if(draws, [](const Column& draw) { return varies(draw.values); }));
  for (std::size_t j = 0; j < draws.size(); ++j) {
    const auto moves = [&](const OutputRanks& output) {
      const RankEffect& effect = output.effects[j];
      return standard_errors(effect.spearman.value, output.count, 0) > sure ||
             standard_errors(effect.partial.value, output.count, count - 1) > sure;
    };
    if (!varies(draws[j].values))
      all.unvaried.push_back(draws[j].name);
    else if (std::ranges::none_of(all.outputs, moves))
      all.idle.push_back(draws[j].name);
  }
}

} // namespace

Column deployed_column(const Results& results) {
  Column column{"deployed", {}};
  for (const Status status : results.status) {
    const bool stayed = status == Status::stalled || status == Status::timed_out;
    column.values.push_back(status == Status::deployed ? 1 : stayed ? 0 : undefined);
  }
  return column;
}

Bounds rank_correlation_bounds(double coefficient, long n, long held, double confidence) {
  if (n - held <= 3) return {};
  const double z = std::atanh(coefficient);
  const double s =
      std::sqrt((1 + coefficient * coefficient / 2) / static_cast<double>(n - held - 3));
  const double reach = two_sided_normal(confidence) * s;
  return {std::tanh(z - reach), std::tanh(z + reach)};
}

PartialCorrelations::PartialCorrelations(const std::vector<Spilled<double>>& columns)
    : columns_(columns.size()),
      rows_(columns.empty() ? 0 : static_cast<long>(columns.front().size())) {
  for (std::size_t j = 0; j < columns.size(); ++j)
    if (varies(columns[j])) varying_.push_back(j);
  Matrix correlations = Matrix::Identity(index(varying_.size()), index(varying_.size()));
  for (std::size_t i = 0; i < varying_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      correlations(index(i), index(j)) = correlations(index(j), index(i)) =
          pearson(columns[varying_[i]], columns[varying_[j]]);
      columns[varying_[j]].release();
    }
  for (const Spilled<double>& column : columns) column.release();
  inverse_ = inverse_of(correlations);
}

std::vector<double> PartialCorrelations::given(std::span<const double> plain) const {
  std::vector<double> partial(columns_, undefined);
  const std::size_t k = varying_.size();
  const bool usable =
      inverse_ && rows_ > static_cast<long>(k) + 1 &&
      std::ranges::none_of(varying_, [&](std::size_t j) { return std::isnan(plain[j]); });
  if (!usable) return partial;
  std::vector<double> b(k, 0.0);
  double explained = 0; // c·b
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = 0; j < k; ++j)
      b[i] += (*inverse_)(index(i), index(j)) * plain[varying_[j]];
    explained += b[i] * plain[varying_[i]];
  }
  // Less than rounding is no rest: what it would leave of the other coefficients is noise.
  const double rounding = 64 * static_cast<double>(k + 1) * std::numeric_limits<double>::epsilon();
  const double rest = std::max(1 - explained, rounding);
  for (std::size_t i = 0; i < k; ++i) {
    const double size = std::sqrt(b[i] * b[i] + rest * (*inverse_)(index(i), index(i)));
    partial[varying_[i]] = std::clamp(b[i] / size, -1.0, 1.0);
  }
  return partial;
}

RankSensitivity rank_sensitivity(const Results& results, double confidence) {
  RankSensitivity all{static_cast<long>(results.size()), confidence, {}, {}, {}, {}};
  for (const Column& draw : results.draws) all.dispersions.push_back(draw.name);
  std::vector<const Column*> outputs;
  for (const Column& output : results.outputs) outputs.push_back(&output);
  const Column deployed = deployed_column(results);
  if (const auto known = sorted_present(deployed.values); !known.empty() && varies(known))
    outputs.push_back(&deployed);
  const std::vector<RankedColumn> draws = ranked(results.draws);
  std::vector<bool> with_draws(results.size(), true); // one that overflowed is no number
  for (const Column& draw : results.draws) keep_runs_with(draw, with_draws);
  std::map<std::vector<bool>, RankedDraws> prepared; // most outputs are there in the same runs
  for (const Column* output : outputs) {
    std::vector<bool> keep = with_draws;
    keep_runs_with(*output, keep);
    auto found = prepared.find(keep);
    if (found == prepared.end()) found = prepared.emplace(keep, ranked_draws(draws, keep)).first;
    all.outputs.push_back(output_ranks(*output, found->second, keep, confidence));
  }
  note_idle(results.draws, all);
  return all;
}

} // namespace wingspread
