#include "montecarlo/analyses/sensitivity/rank_sensitivity.hpp"

#include "montecarlo/analyses/sensitivity/ranked_draws.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/foundation/statistics/jackknife.hpp"
#include "montecarlo/foundation/statistics/rank_bias.hpp"
#include "montecarlo/foundation/statistics/ranked_column.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace wingspread {
namespace {

/// Heuristic: `collinear` names a dispersion if the others explain at least this share (R²) of its variance. With a
/// smaller value it names independent dispersions of small campaigns by chance. With a larger value, dispersions that
/// share half of their variance with others go unmentioned.
constexpr double most_explained = 0.5;
/// Runs that `collinear` needs beside one for each dispersion: three independent draws of 4 to 7 runs were named in a
/// quarter of the campaigns, of 20 and more in none.
constexpr long least_beside = 16;
/// Partial coefficients have bounds if at least n (1 − R²) of this size is left of an output's ranks. Below, the rest is
/// of few ranks (its rms is below 0.3 √n), and nominal 90 % bounds covered 0 to 80 %. A test bounds the share of samples
/// with wrong bounds.
constexpr double least_unexplained = 1;

std::vector<RankedColumn> ranked(const std::vector<const Column*>& columns) {
  std::vector<const Spilled<double>*> values;
  for (const Column* column : columns) values.push_back(&column->values);
  return rank_columns(values, all_threads);
}

/// Drops the runs in which the column has no value.
void keep_runs_with(const Column& column, Rows& keep) {
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (std::isnan(column.values[i])) keep[i] = false;
  column.values.release();
}

using Coefficients = RankedDraws::Coefficients;

using Matrix = PartialCorrelations::Matrix;

/// Bias-corrected partial coefficients of independent runs, as Fisher's z.
///
/// Leaving out a group changes the correlations. The bounds' standard error is computed from the slope of z along this
/// change. The whole change of z is not used, because z is curved if 1 − R² is small: its spread would be 3 to 5 % too
/// large at n = 100.
class CorrectedPartial {
public:
  /// @param draws  of all kept runs; a reference is kept
  /// @param output ranks of all kept runs
  CorrectedPartial(const RankedDraws& draws, const std::vector<std::vector<double>>& outputs)
      : draws_(&draws.partial()), bias_(columns_of(draws, outputs)) {}

  /// The model of the draws with correlations that are moved by `step` towards those without a group.
  struct Model {
    PartialCorrelations now, biased;
  };
  [[nodiscard]] Model moved(const PartialCorrelations& without) const {
    Matrix now = draws_->correlations();
    const std::vector<Eigen::Index> place = places_in(without);
    for (Eigen::Index i = 0; i < now.rows(); ++i)
      for (Eigen::Index j = 0; j < now.cols(); ++j)
        if (const Eigen::Index k = at(place, i), l = at(place, j); i != j && k >= 0 && l >= 0)
          now(i, j) += step * (without.correlations()(k, l) - now(i, j));
    return {draws_->with(now), draws_->with(biased(now))};
  }
  /// z of each draw and the output, with Spearman's coefficients `plain` of the two.
  [[nodiscard]] std::vector<double> z(const Model& model, std::span<const double> plain,
                                      std::size_t output) const {
    std::vector<double> shown(plain.begin(), plain.end());
    for (const std::size_t j : draws_->which_vary())
      shown[j] = bias_.in_sample(j, plain.size() + output, plain[j]);
    std::vector<double> z = model.now.given(plain);
    const std::vector<double> twice = model.biased.given(shown);
    for (std::size_t j = 0; j < z.size(); ++j) z[j] = 2 * std::atanh(z[j]) - std::atanh(twice[j]);
    return z;
  }
  /// Coefficients moved by `step` towards those without a group; those without it that are NaN are not moved.
  [[nodiscard]] static std::vector<double> moved(std::span<const double> all,
                                                 std::span<const double> without) {
    std::vector<double> plain;
    for (std::size_t j = 0; j < all.size(); ++j)
      plain.push_back(std::isnan(without[j]) ? all[j] : all[j] + step * (without[j] - all[j]));
    return plain;
  }
  /// The z without the group, extrapolated by the slope.
  [[nodiscard]] static double without_group(double z, double moved) {
    return z + (moved - z) / step;
  }

private:
  /// Step of the difference quotient. Its error is a thousandth of the curvature of z, and 1e-13 by rounding.
  static constexpr double step = 1e-3;

  static std::vector<std::span<const double>>
  columns_of(const RankedDraws& draws, const std::vector<std::vector<double>>& outputs) {
    std::vector<std::span<const double>> columns;
    for (const Spilled<double>& draw : draws.ranks())
      columns.emplace_back(draw.begin(), draw.end());
    for (const std::vector<double>& output : outputs) columns.emplace_back(output);
    return columns;
  }
  static Eigen::Index at(const std::vector<Eigen::Index>& place, Eigen::Index i) {
    return place[static_cast<std::size_t>(i)];
  }
  /// The index of each varying draw among the draws that vary without the group; −1 if it does not vary there.
  [[nodiscard]] std::vector<Eigen::Index> places_in(const PartialCorrelations& without) const {
    std::vector<Eigen::Index> places;
    const auto there = without.which_vary();
    for (const std::size_t j : draws_->which_vary()) {
      const auto found = std::ranges::find(there, j);
      places.push_back(found == there.end() ? -1 : found - there.begin());
    }
    return places;
  }
  [[nodiscard]] Matrix biased(const Matrix& correlations) const {
    Matrix found = correlations;
    const auto which = draws_->which_vary();
    for (std::size_t i = 0; i < which.size(); ++i)
      for (std::size_t j = 0; j < which.size(); ++j)
        if (auto& each = found(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)); i != j)
          each = bias_.in_sample(which[i], which[j], each);
    return found;
  }

  const PartialCorrelations* draws_;
  RankBias bias_;
};

/// The independent groups of runs for the jackknife: the replicates of a design, or parts of independent draws.
class Groups {
public:
  Groups(const Replication& replication, std::size_t rows) : replication_(replication) {
    count_ = independent() ? jackknife_groups : replication.replicates;
    if (static_cast<std::size_t>(count_) > rows || count_ < 2) count_ = 0;
  }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] bool independent() const { return replication_.replicates == 0; }
  /// The kept runs without those of a group.
  [[nodiscard]] Rows without(int group, Rows keep) const {
    for (std::size_t row = 0; row < keep.size(); ++row)
      if (of(row) == group) keep[row] = false;
    return keep;
  }

private:
  [[nodiscard]] int of(std::size_t row) const {
    return replication_.replicates == 0 ? static_cast<int>(row % jackknife_groups)
                                        : replication_.of_row[row];
  }
  const Replication& replication_;
  int count_;
};

/// The coefficients of one output: over all its runs, and over the runs without each group.
struct Found {
  long count = 0, held = 0;
  Coefficients all;
  std::vector<Coefficients> without{};
  std::vector<double>
      errors{};            ///< of Spearman's coefficients, for any law; of independent runs only
  std::vector<double> z{}; ///< corrected partial coefficients; of independent runs only
  std::vector<std::vector<double>> z_without{};
};

/// Bounds of an output's coefficients.
class Judge {
public:
  /// @param tests number of simultaneous tests for the idle dispersions (Bonferroni)
  Judge(const RankSensitivity& all, long tests)
      : independent_(all.replicates == 0),
        confidence_(all.interim.confidence_of_bound(all.confidence)),
        sure_(at_each_of(confidence_, tests)) {}

  [[nodiscard]] RankEffect effect(const Found& found, std::size_t j) const {
    const double spearman = found.all.spearman[j], partial = found.all.partial[j];
    return {{spearman, spearman_bounds(found, j, confidence_)},
            {partial,
             is_fit_for_bounds(found) ? that_contain(partial, partial_bounds(found, j)) : Bounds{}},
            seen(found, j)};
  }

private:
  using Kind = std::vector<double> Coefficients::*;

  [[nodiscard]] Bounds spearman_bounds(const Found& found, std::size_t j, double confidence) const {
    const double value = found.all.spearman[j];
    if (!independent_) return jackknifed(found, j, &Coefficients::spearman, confidence);
    if (std::isnan(value)) return {};
    const double error = found.errors.empty() ? 0 : found.errors[j];
    return rank_correlation_bounds(value, found.count, confidence, error);
  }

  [[nodiscard]] Bounds partial_bounds(const Found& found, std::size_t j) const {
    if (!independent_) return jackknifed(found, j, &Coefficients::partial, confidence_);
    std::vector<double> without;
    for (const std::vector<double>& z : found.z_without) without.push_back(z[j]);
    return from_z(jackknife_bounds(found.z.empty() ? undefined : found.z[j], without, confidence_));
  }

  [[nodiscard]] static bool is_fit_for_bounds(const Found& found) {
    return static_cast<double>(found.count) * found.all.unexplained >= least_unexplained;
  }

  /// No bounds where the bias, which they are corrected for, carries them past the coefficient: where the draws explain
  /// nearly all of an output's ranks, too few ranks are left for either.
  [[nodiscard]] static Bounds that_contain(double coefficient, const Bounds& bounds) {
    const bool inside =
        bounds.lower && *bounds.lower <= coefficient && coefficient <= *bounds.upper;
    return inside ? bounds : Bounds{};
  }

  [[nodiscard]] static Bounds jackknifed(const Found& found, std::size_t j, Kind kind,
                                         double confidence) {
    std::vector<double> without;
    for (const Coefficients& each : found.without) without.push_back((each.*kind)[j]);
    return jackknife_correlation_bounds((found.all.*kind)[j], without, confidence);
  }

  /// Whether a coefficient differs significantly from 0. For independent draws Fisher's z, in its standard errors under
  /// ρ = 0, decides; for replicates the bounds decide, and without bounds the answer is true.
  [[nodiscard]] bool seen(const Found& found, std::size_t j) const {
    if (independent_)
      return standard_errors(found.all.spearman[j], found.count) > two_sided_normal(sure_) ||
             standard_errors(found.all.partial[j], found.count - found.held) >
                 two_sided_normal(sure_);
    return found.without.empty() ||
           excludes_0(jackknifed(found, j, &Coefficients::spearman, sure_)) ||
           excludes_0(jackknifed(found, j, &Coefficients::partial, sure_));
  }

  [[nodiscard]] static double standard_errors(double coefficient, long n) {
    if (std::isnan(coefficient) || n < least_runs_for_effects) return 0;
    return std::abs(std::atanh(coefficient)) * std::sqrt(static_cast<double>(n - 3));
  }
  [[nodiscard]] static bool excludes_0(const Bounds& bounds) {
    return bounds.lower && (*bounds.lower > 0 || *bounds.upper < 0);
  }

  bool independent_;
  double confidence_, sure_;
};

/// Adds the corrected partial coefficients without one group.
void add_corrected(const CorrectedPartial& corrected, const PartialCorrelations& without,
                   std::vector<Found>& found) {
  const CorrectedPartial::Model model = corrected.moved(without);
  for (std::size_t i = 0; i < found.size(); ++i) {
    Found& each = found[i];
    const std::vector<double>& left = each.without.back().spearman;
    std::vector<double> z = corrected.z(model, CorrectedPartial::moved(each.all.spearman, left), i);
    for (std::size_t j = 0; j < z.size(); ++j)
      z[j] = std::isnan(left[j]) ? undefined : CorrectedPartial::without_group(each.z[j], z[j]);
    each.z_without.push_back(std::move(z));
  }
}

/// The coefficients of outputs that have values in the same runs.
std::vector<Found> coefficients(const std::vector<RankedColumn>& draws,
                                const std::vector<const RankedColumn*>& outputs, const Rows& keep,
                                const Groups& groups, bool& entangled) {
  std::vector<Found> found;
  std::vector<std::vector<double>> ranks;
  const RankedDraws all(draws, keep);
  entangled = all.partial().entangled();
  for (const RankedColumn* output : outputs) {
    ranks.push_back(output->ranks_where(keep));
    found.push_back({std::ranges::count(keep, true), std::max(0L, all.partial().varying() - 1),
                     all.with(ranks.back())});
    if (groups.independent()) found.back().errors = all.errors(ranks.back());
  }
  std::optional<CorrectedPartial> corrected;
  if (groups.independent() && groups.count() > 0) {
    corrected.emplace(all, ranks);
    const CorrectedPartial::Model model = corrected->moved(all.partial());
    for (std::size_t i = 0; i < found.size(); ++i)
      found[i].z = corrected->z(model, found[i].all.spearman, i);
  }
  for (int group = 0; group < groups.count(); ++group) {
    const Rows rest = groups.without(group, keep);
    const RankedDraws without(draws, rest);
    for (std::size_t i = 0; i < outputs.size(); ++i)
      found[i].without.push_back(without.with(outputs[i]->ranks_where(rest)));
    if (corrected) add_corrected(*corrected, without.partial(), found);
  }
  return found;
}

OutputRanks output_ranks(const std::string& name, const Found& found, const Results& results,
                         bool entangled, const Judge& judge) {
  const auto runs = static_cast<long>(results.size());
  OutputRanks result{name, found.count, runs - found.count,
                     {},   entangled,   count_cut(results, name)};
  for (std::size_t j = 0; j < found.all.spearman.size(); ++j)
    result.effects.push_back(judge.effect(found, j));
  return result;
}

/// Lists the constant, idle and collinear dispersions.
void note_dispersions(const Results& results, const std::vector<RankedColumn>& draws,
                      const Rows& with_draws, RankSensitivity& all) {
  if (all.runs < least_runs_for_effects) return;
  const RankedDraws ranked(draws, with_draws);
  const std::vector<double> explained = ranked.partial().explained();
  const bool enough =
      std::ranges::count(with_draws, true) >= ranked.partial().varying() + least_beside;
  for (std::size_t j = 0; j < draws.size(); ++j) {
    const std::string& name = results.draws[j].name;
    const auto seen = [&](const OutputRanks& output) { return output.effects[j].seen; };
    if (!varies(results.draws[j].values))
      all.unvaried.push_back(name);
    else if (std::ranges::none_of(all.outputs, seen))
      all.idle.push_back(name);
    if (enough && explained[j] >= most_explained) all.collinear.push_back(name);
  }
}

} // namespace

RankSensitivity rank_sensitivity(const Results& results, double confidence, const RunsMade& made) {
  RankSensitivity all;
  all.runs = static_cast<long>(results.size());
  all.confidence = confidence;
  all.interim = made.interim;
  all.replicates = made.replication.replicates;
  all.rows = made.rows;
  std::vector<const Column*> drawn, outputs;
  for (const Column& draw : results.draws) drawn.push_back(&draw);
  for (const Column& output : results.outputs) outputs.push_back(&output);
  for (const Column* draw : drawn) all.dispersions.push_back(draw->name);
  const Column deployed = deployed_column(results);
  if (const auto known = sorted_present(deployed.values); !known.empty() && varies(known))
    outputs.push_back(&deployed);
  const std::vector<RankedColumn> draws = ranked(drawn), ranks = ranked(outputs);
  Rows with_draws(results.size(), true); // a draw that overflowed is NaN: its run is left out
  for (const Column* draw : drawn) keep_runs_with(*draw, with_draws);
  std::map<Rows, std::vector<std::size_t>> together; // most outputs have values in the same runs
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    Rows keep = with_draws;
    keep_runs_with(*outputs[i], keep);
    together[keep].push_back(i);
  }
  const Groups groups(made.replication, results.size());
  const Judge judge(all, 2 * std::ssize(outputs));
  all.outputs.resize(outputs.size());
  for (const auto& [keep, which] : together) {
    std::vector<const RankedColumn*> these;
    for (const std::size_t i : which) these.push_back(&ranks[i]);
    bool entangled = false;
    const std::vector<Found> found = coefficients(draws, these, keep, groups, entangled);
    for (std::size_t k = 0; k < which.size(); ++k)
      all.outputs[which[k]] =
          output_ranks(outputs[which[k]]->name, found[k], results, entangled, judge);
  }
  note_dispersions(results, draws, with_draws, all);
  all.open_latches = count_open_latches(results);
  all.never_final = made.never_final;
  return all;
}

} // namespace wingspread
