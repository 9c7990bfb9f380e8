#include "montecarlo/report/data/causes_json.hpp"

#include "montecarlo/analyses/sensitivity/levers.hpp"
#include "montecarlo/analyses/sensitivity/rank_report.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/report/data/output_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace wingspread {
namespace {

/// Fewest runs for correlations: with three runs every rank correlation is ±1/2 or ±1.
constexpr long fewest_runs = 4;

// ---- effects

/// The first runs of a random design; all runs of a replicated design, whose replicates must stay complete.
const Results& effect_runs(const PageSource& source, Results& first) {
  if (source.replication.replicates > 0 || source.results.size() <= most_effect_runs)
    return source.results;
  first = Results(RunPlan(source.stored.campaign).names());
  for (std::size_t row = 0; row < most_effect_runs; ++row) first.append(source.results.row(row));
  return first;
}

double strength(const RankEffect& effect) {
  const auto size = [](double value) { return std::isnan(value) ? 0 : std::abs(value); };
  return std::max(size(effect.spearman.value), size(effect.partial.value));
}

void add_coefficient(Json& json, const std::string& name, const Coefficient& coefficient) {
  json[name] = page_number(coefficient.value, 4);
  json[name + "_lower"] = page_number(coefficient.bounds.lower);
  json[name + "_upper"] = page_number(coefficient.bounds.upper);
}

/// The strongest effects on an output, strongest first.
void add_effects(const RankSensitivity& all, const OutputRanks& output, std::size_t most,
                 Json& effects) {
  std::vector<std::size_t> draws(output.effects.size());
  std::iota(draws.begin(), draws.end(), std::size_t{0});
  std::ranges::stable_sort(draws, std::ranges::greater{},
                           [&](std::size_t i) { return strength(output.effects[i]); });
  for (const std::size_t draw : std::span(draws).first(std::min(most, draws.size()))) {
    const RankEffect& effect = output.effects[draw];
    if (std::isnan(effect.spearman.value) && std::isnan(effect.partial.value)) continue;
    Json json{{"output", output.output}, {"draw", all.dispersions[draw]}};
    add_coefficient(json, "spearman", effect.spearman);
    add_coefficient(json, "prcc", effect.partial);
    effects.push_back(std::move(json));
  }
}

// ---- scatters

std::vector<double> even_edges(const Column& column, std::span<const std::size_t> rows,
                               std::size_t bins) {
  const auto value = [&](std::size_t row) -> double { return column.values[row]; };
  double least = value(std::ranges::min(rows, {}, value)),
         most = value(std::ranges::max(rows, {}, value));
  if (least == most) {
    const double half = least == 0 ? 0.5 : std::abs(least) / 2;
    least -= half;
    most += half;
  }
  std::vector<double> edges;
  for (std::size_t i = 0; i <= bins; ++i)
    edges.push_back(std::lerp(least, most, static_cast<double>(i) / static_cast<double>(bins)));
  return edges;
}

std::size_t bin_of(const std::vector<double>& edges, double value) {
  const auto inner = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
  return static_cast<std::size_t>(inner - edges.begin() - 1);
}

/// The rows in which both columns have a value.
std::vector<std::size_t> rows_of_both(const Column& x, const Column& y) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < x.values.size(); ++row)
    if (!std::isnan(x.values[row]) && !std::isnan(y.values[row])) rows.push_back(row);
  return rows;
}

/// Whether a pair is correlated by more than three standard errors, each 1/√(n − 1) for independent columns.
/// About three in a thousand independent pairs are.
bool is_visible(const Correlation& value) {
  return std::abs(value.spearman) * std::sqrt(static_cast<double>(value.count) - 1) > 3;
}

/// Whether a requirement on an output fails.
bool fails(const PageSource& source, std::size_t output) {
  return std::ranges::any_of(source.summary.requirements, [&](const Verdict& verdict) {
    return verdict.decision == Decision::fail &&
           verdict.requirement.output == source.results.outputs[output].name;
  });
}

/// The digits of points between these edges.
int digits_between(const std::vector<double>& edges) {
  return digits_that_show(edges.back() - edges.front(),
                          std::max(std::abs(edges.front()), std::abs(edges.back())), 6);
}

Json points_json(const PageSource& source, const Column& x, const Column& y, int x_digits,
                 int y_digits) {
  constexpr std::size_t most_points = 400;
  Json json{
      {"run", Json::array()}, {"x", Json::array()}, {"y", Json::array()}, {"order", Json::array()}};
  for (const std::size_t row : scatter_rows(x, y, most_points)) {
    json["run"].push_back(source.results.runs[row]);
    json["x"].push_back(page_number(x.values[row], x_digits));
    json["y"].push_back(page_number(y.values[row], y_digits));
    json["order"].push_back(source.orders->of_row(row));
  }
  return json;
}

Json scatter_json(const PageSource& source, const Pair& pair) {
  constexpr std::size_t bins = 32;
  const Column& x = source.results.draws[pair.draw];
  const Column& y = source.results.outputs[pair.output];
  const std::vector<std::size_t> rows = rows_of_both(x, y);
  const std::vector<double> x_edges = even_edges(x, rows, bins),
                            y_edges = even_edges(y, rows, bins);
  std::vector<long> density(bins * bins, 0);
  for (const std::size_t row : rows)
    ++density[bin_of(y_edges, y.values[row]) * bins + bin_of(x_edges, x.values[row])];
  return {{"draw", x.name},
          {"output", y.name},
          {"spearman", page_number(pair.spearman, 4)},
          {"x_edges", page_numbers(x_edges, digits_that_tell(x_edges, page_digits))},
          {"y_edges", page_numbers(y_edges, digits_that_tell(y_edges, page_digits))},
          {"density", density},
          {"points", points_json(source, x, y, digits_between(x_edges), digits_between(y_edges))}};
}

// ---- needed changes

/// The `margin` command whose range holds the lever's change; null if `margin` cannot make the change.
Json margin_command(const PageSource& source, const LeverChange& each) {
  if (each.lever.paths.empty() || !(each.change.change > 0)) return nullptr;
  constexpr double least = 0.005; // of a range of three digits
  const double size = std::max(std::abs(each.change.change - 1), least),
               t = std::copysign(size, each.change.change - 1);
  // The range goes from twice the change to half of it in the other direction.
  const double beyond = std::max(0.05, 1 + 2 * t), before = std::max(0.05, 1 - t / 2);
  std::vector<std::string> paths;
  for (const std::string& path : each.lever.paths) paths.push_back(shell_word(path));
  return fmt::format("wingspread margin {}{} --scale {} --range {:.3g} {:.3g} --out results/margin",
                     shell_word((source.made_from / campaign_file).string()),
                     requirements_option(source), fmt::join(paths, " "), std::min(beyond, before),
                     std::max(beyond, before));
}

Json lever_json(const PageSource& source, const LeverChange& each) {
  const auto& [lever, change] = each;
  Json json{{"words", lever.words},
            {"draws", lever.draws},
            {"scaled", lever.moved.scaled},
            {"unit", lever.unit},
            {"now", page_number(change.now)},
            {"change", page_number(change.change)},
            {"least", page_number(change.least)},
            {"most", page_number(change.most)},
            {"known", change.known},
            {"beyond_runs", change.beyond_runs},
            {"beyond_undeployed", change.beyond_undeployed},
            {"of_broken", page_number(change.of_broken)},
            {"of_others", page_number(change.of_others)},
            {"command", margin_command(source, each)}};
  add_bounds(json, change.bounds);
  return json;
}

Json block_json(const PageSource& source, const Verdict& verdict, NeededFor what) {
  constexpr std::size_t most_levers = 3, most_needs = 24;
  const auto found = lever_changes(what, source.stored.campaign, verdict, source.results,
                                   source.replication, source.confidence, most_needs);
  Json json{{"for", what == NeededFor::limit ? "limit" : "deployment"},
            {"runs", found ? found->runs : 0},
            {"explained", found ? page_number(found->explained, 3) : Json(nullptr)},
            {"levers", Json::array()},
            {"needs", Json::array()}};
  if (!found) return json;
  const std::span<const LeverChange> all = found->levers;
  for (const LeverChange& each : all.first(std::min(all.size(), most_levers)))
    json["levers"].push_back(lever_json(source, each));
  for (const LeverChange& each : all)
    json["needs"].push_back(
        {{"draws", each.lever.draws},
         {"change", each.change.known ? page_number(each.change.change) : Json(nullptr)}});
  return json;
}

// ---- loads without a requirement

/// The largest magnitude of an output over all runs.
double largest(const OutputSummary& output) {
  return std::max(std::abs(output.moments.min), std::abs(output.moments.max));
}

} // namespace

Json changes_json(const PageSource& source, const Verdict& verdict) {
  Json blocks = Json::array();
  const Requirement& requirement = verdict.requirement;
  if (verdict.decision != Decision::fail || !source.has_rows() || requirement.static_margin)
    return blocks;
  const BrokenRuns broken = broken_runs(verdict, source.results, 0);
  const long may =
      verdict.allowed.value_or(verdict.runs - quantile_rank(verdict.runs, requirement.probability));
  if (broken.not_deployed > may)
    blocks.push_back(block_json(source, verdict, NeededFor::deployment));
  if (broken.beyond > 0) blocks.push_back(block_json(source, verdict, NeededFor::limit));
  return blocks;
}

Json unjudged_json(const PageSource& source) {
  std::map<std::string, const OutputSummary*> judged, other; // the largest of each kind
  for (const OutputSummary& output : source.summary.outputs) {
    const OutputName name = parse_output_name(output.name);
    if (output.moments.count == 0 || !std::string_view(name.unit).starts_with('N')) continue;
    const auto required =
        std::ranges::find(source.summary.requirements, output.name,
                          [](const Verdict& verdict) { return verdict.requirement.output; });
    const bool is_judged = required != source.summary.requirements.end();
    const OutputSummary*& kept = (is_judged ? judged : other)[name.quantity];
    if (!kept || largest(output) > largest(*kept)) kept = &output;
  }
  Json json = Json::array();
  for (const auto& [kind, output] : judged)
    if (other.contains(kind) && largest(*other[kind]) > largest(*output))
      json.push_back({{"output", other[kind]->name},
                      {"largest", page_number(largest(*other[kind]))},
                      {"judged", output->name},
                      {"judged_largest", page_number(largest(*output))}});
  return json;
}

Json correlations_json(const PageSource& source, const PageDetail& detail) {
  const Results& results = source.results;
  const std::size_t draws = std::min(results.draws.size(), detail.correlated_draws);
  const std::vector<std::size_t> outputs = shown_outputs(source, detail);
  if (source.summary.correlations.empty() || source.summary.runs < fewest_runs) return nullptr;
  Json json{{"draws", Json::array()},
            {"outputs", Json::array()},
            {"spearman", Json::array()},
            {"pearson", Json::array()}};
  for (const std::size_t o : outputs) json["outputs"].push_back(results.outputs[o].name);
  const std::size_t row = results.outputs.size() + 1; // + 1: `deployed`
  for (std::size_t d = 0; d < draws; ++d) {
    json["draws"].push_back(results.draws[d].name);
    Json spearman = Json::array(), pearson = Json::array();
    for (const std::size_t o : outputs) {
      const Correlation& value = source.summary.correlations[d * row + o].value;
      spearman.push_back(page_number(value.spearman, 3));
      pearson.push_back(page_number(value.pearson, 3));
    }
    json["spearman"].push_back(std::move(spearman));
    json["pearson"].push_back(std::move(pearson));
  }
  return json;
}

/// The warnings, without idle dispersions: these have a list of their own.
std::vector<std::string> further_warnings(RankSensitivity all) {
  all.idle.clear();
  return warnings(all);
}

Json effects_json(const PageSource& source, const PageDetail& detail) {
  if (!source.has_rows() || source.results.draws.empty() || source.summary.runs < fewest_runs)
    return nullptr;
  Results first;
  const Results& runs = effect_runs(source, first);
  const RunsMade made{source.replication, source.summary.interim, {}, source.summary.never_final};
  const RankSensitivity all =
      rank_sensitivity(runs, source.stored.campaign.statistics.confidence, made);
  Json effects = Json::array();
  const std::vector<Column>& columns = source.results.outputs;
  const std::vector<std::size_t> shown = shown_outputs(source, detail);
  for (const OutputRanks& output : all.outputs) {
    const auto column = std::ranges::find(columns, output.output, &Column::name);
    const auto place = static_cast<std::size_t>(column - columns.begin()); // the end: `deployed`
    if (place == columns.size() || std::ranges::binary_search(shown, place))
      add_effects(all, output, detail.effects, effects);
  }
  if (effects.empty()) return nullptr;
  return {{"kind", "rank"},
          {"runs", all.runs},
          {"confidence", all.confidence},
          {"idle", all.idle},
          {"warnings", further_warnings(all)},
          {"effects", std::move(effects)}};
}

std::vector<Pair> strongest_pairs(const PageSource& source, std::size_t most) {
  constexpr long most_of_output = 2;
  std::vector<Pair> all;
  const std::size_t row = source.results.outputs.size() + 1;
  for (std::size_t i = 0; i < source.summary.correlations.size(); ++i)
    if (const Correlation& value = source.summary.correlations[i].value;
        i % row + 1 < row && is_visible(value))
      all.push_back({i / row, i % row, value.spearman});
  std::ranges::stable_sort(all, std::ranges::greater{}, [&](const Pair& pair) {
    return std::pair(fails(source, pair.output), std::abs(pair.spearman));
  });
  std::vector<Pair> strongest;
  for (const Pair& pair : all)
    if (strongest.size() < most &&
        std::ranges::count(strongest, pair.output, &Pair::output) < most_of_output)
      strongest.push_back(pair);
  return strongest;
}

std::vector<std::size_t> scatter_rows(const Column& x, const Column& y, std::size_t most) {
  std::vector<std::size_t> rows = rows_of_both(x, y);
  if (rows.size() <= most) return rows;
  const auto extreme = static_cast<std::ptrdiff_t>(most / 10); // at each end of each column
  std::vector<std::size_t> chosen;
  std::vector<std::size_t> by_value = rows;
  for (const Column* column : {&x, &y}) {
    const auto value = [&](std::size_t row) { return std::pair(column->values[row], row); };
    std::ranges::nth_element(by_value, by_value.begin() + extreme, {}, value);
    chosen.insert(chosen.end(), by_value.begin(), by_value.begin() + extreme);
    std::ranges::nth_element(by_value, by_value.end() - extreme, {}, value);
    chosen.insert(chosen.end(), by_value.end() - extreme, by_value.end());
  }
  const std::size_t rest = most - chosen.size();
  for (std::size_t i = 0; i < rest; ++i) chosen.push_back(rows[i * rows.size() / rest]);
  std::ranges::sort(chosen);
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

Json scatters_json(const PageSource& source, const PageDetail& detail, int threads) {
  const std::vector<Pair> pairs = strongest_pairs(source, detail.scatters);
  std::vector<Json> scatters(pairs.size());
  for_each_task(threads_within_memory(threads, 24 * source.results.size()), pairs.size(),
                [&](std::size_t i) { scatters[i] = scatter_json(source, pairs[i]); });
  source.results.release();
  return scatters;
}

} // namespace wingspread
