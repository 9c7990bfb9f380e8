#include "montecarlo/sensitivity/rank_sensitivity.hpp"

#include "montecarlo/statistics/bonferroni.hpp"
#include "montecarlo/statistics/ranked_column.hpp"
#include "montecarlo/statistics/statistics.hpp"
#include "montecarlo/statistics/two_sided.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace wingspread {
namespace {

/// How surely a coefficient is not 0: its z in standard errors under ρ = 0.
double standard_errors(double coefficient, long n, long held) {
  if (std::isnan(coefficient) || n - held <= 3) return 0;
  return std::abs(std::atanh(coefficient)) * std::sqrt(static_cast<double>(n - held - 3));
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
  const long tests = 2 * std::ssize(all.outputs);
  const double sure = two_sided_normal(at_each_of(all.confidence, tests));
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
