#include "montecarlo/sensitivity/sensitivity_text.hpp"

#include "montecarlo/formats/csv.hpp"
#include "montecarlo/formats/json.hpp"
#include "montecarlo/formats/output_name.hpp"
#include "montecarlo/formats/text_layout.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace wingspread {
namespace {

constexpr std::size_t most_lines = 8; ///< of an output's table
constexpr std::size_t name_width = 30;

Json value_json(double value, const Bounds& bounds) {
  return {{"value", json_number(value)},
          {"lower", json_number(bounds.lower)},
          {"upper", json_number(bounds.upper)}};
}

Bounds bounds_of(const Interval& interval) { return {interval.lower, interval.upper}; }

/// "+0.123   −0.456 – −0.345", 30 columns wide.
std::string value_text(double value, const Bounds& bounds) {
  if (std::isnan(value)) return fmt::format("{:>9}{:>21}", "–", "–");
  const std::string range =
      bounds.lower ? fmt::format("{:.3f} … {:.3f}", *bounds.lower, *bounds.upper) : "–";
  return fmt::format("{:>9.3f}{:>21}", value, range);
}

/// Indices of the dispersions, the largest first; those without a number last.
std::vector<std::size_t> by_size(std::size_t count,
                                 const std::function<double(std::size_t)>& size) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) {
    const double value = size(j);
    return std::isnan(value) ? -1.0 : value;
  });
  return order;
}

/// One output's heading and its first lines; what is smaller is summed up in one.
std::string block(const std::string& heading, const std::string& columns, std::size_t count,
                  const std::function<double(std::size_t)>& size,
                  const std::function<std::string(std::size_t)>& line) {
  std::string text = fmt::format("\n{}\n{}\n", heading, columns);
  const std::vector<std::size_t> order = by_size(count, size);
  const std::size_t shown = count > most_lines + 1 ? most_lines : count;
  for (std::size_t k = 0; k < shown; ++k) text += line(order[k]);
  if (shown < count)
    text += fmt::format("  and {} others, none above {:.3f}\n", count - shown,
                        std::max(0.0, size(order[shown])));
  return text;
}

std::string heading_of(const std::string& output, long count, const char* counted, long left_out) {
  const std::string unit = parse_output_name(output).unit;
  std::string text =
      fmt::format("{}{}{} · {} {}", output, unit.empty() ? "" : ", ", unit, count, counted);
  if (left_out > 0) text += fmt::format(" · {} without it left out", left_out);
  return text;
}

std::string quoted(const std::vector<std::string>& names) {
  return fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

} // namespace

std::vector<std::string> SobolSensitivity::idle() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < dispersions.size(); ++i) {
    const auto inert = [i](const Output& output) { return output.indices.effects[i].inert; };
    const auto known = [](const Output& output) { return output.indices.rows > 0; };
    if (std::ranges::all_of(outputs, inert) && std::ranges::any_of(outputs, known))
      names.push_back(dispersions[i]);
  }
  return names;
}

SobolSensitivity sobol_sensitivity(const Results& results, long rows, std::string design,
                                   const Bootstrap& bootstrap) {
  const std::size_t d = results.draws.size();
  SobolSensitivity all{rows,
                       static_cast<long>(results.size()),
                       rows * static_cast<long>(d + 2),
                       std::move(design),
                       bootstrap.confidence,
                       bootstrap.resamples,
                       {},
                       {}};
  for (const Column& draw : results.draws) all.dispersions.push_back(draw.name);
  for (const Column& output : results.outputs)
    all.outputs.push_back({output.name, sobol_indices(output.values, d, bootstrap)});
  const Column deployed = deployed_column(results);
  if (moments(sorted_present(deployed.values)).std > 0)
    all.outputs.push_back({deployed.name, sobol_indices(deployed.values, d, bootstrap)});
  return all;
}

Json sensitivity_json(const RankSensitivity& all, const Json& about) {
  Json outputs = Json::object();
  for (const OutputRanks& output : all.outputs) {
    Json effects = Json::object();
    for (std::size_t j = 0; j < all.dispersions.size(); ++j) {
      const auto& [spearman, partial] = output.effects[j];
      effects[all.dispersions[j]] = {{"spearman", value_json(spearman.value, spearman.bounds)},
                                     {"prcc", value_json(partial.value, partial.bounds)}};
    }
    outputs[output.output] = {{"count", output.count},
                              {"missing", output.missing},
                              {"entangled", output.entangled},
                              {"dispersions", effects}};
  }
  return {{stamp_key, about},
          {"method", "rank correlation"},
          {"runs", all.runs},
          {"confidence", all.confidence},
          {"definitions",
           {{"spearman", "Pearson's of the mid-ranks, over the runs that have the output"},
            {"prcc", "partial correlation of the mid-ranks, all other dispersions held"},
            {"bounds", "Fisher's z, variance (1 + r^2/2)/(n - held - 3), two-sided"},
            {"deployed", "1 deployed, 0 stalled or timed out; others left out"},
            {"moves_nothing", "no coefficient differs from 0 at this confidence taken over all "
                              "outputs together"}}},
          {"outputs", outputs},
          {"do_not_vary", all.unvaried},
          {"moves_nothing", all.idle}};
}

Json sensitivity_json(const SobolSensitivity& all, const Json& about) {
  Json outputs = Json::object();
  for (const auto& [name, indices] : all.outputs) {
    Json effects = Json::object();
    for (std::size_t i = 0; i < all.dispersions.size(); ++i) {
      const auto& [first, total, inert] = indices.effects[i];
      effects[all.dispersions[i]] = {{"first", value_json(first.value, bounds_of(first.interval))},
                                     {"total", value_json(total.value, bounds_of(total.interval))},
                                     {"inert", inert}};
    }
    outputs[name] = {{"rows", indices.rows},
                     {"left_out", indices.left_out},
                     {"mean", json_number(indices.mean)},
                     {"variance", json_number(indices.variance)},
                     {"dispersions", effects}};
  }
  return {{stamp_key, about},
          {"method", "Sobol' indices"},
          {"design", all.design},
          {"samples", all.rows},
          {"runs", all.runs},
          {"partial", all.runs < all.total},
          {"confidence", all.confidence},
          {"definitions",
           {{"first", "Saltelli 2010: mean of f_B (f_ABi - f_A) over the variance"},
            {"total", "Jansen 1999: mean of (f_A - f_ABi)^2 over twice the variance"},
            {"bounds", fmt::format("percentile bootstrap over rows, {} resamples, two-sided; of "
                                   "stratified designs rather too wide",
                                   all.resamples)},
            {"left_out", "rows in which one of the points does not have the output"},
            {"deployed", "1 deployed, 0 stalled or timed out; others left out"},
            {"moves_nothing", "all outputs of all rows are the same without it, bit for bit"}}},
          {"outputs", outputs},
          {"moves_nothing", all.idle()}};
}

std::string sensitivity_csv(const RankSensitivity& all) {
  std::string text = "output,dispersion,count,missing,spearman,spearman_lower,spearman_upper,"
                     "prcc,prcc_lower,prcc_upper\n";
  for (const OutputRanks& output : all.outputs)
    for (std::size_t j = 0; j < all.dispersions.size(); ++j) {
      append_csv_cell(text, output.output);
      append_csv_cells(text, all.dispersions[j], output.count, output.missing);
      for (const Coefficient& c : {output.effects[j].spearman, output.effects[j].partial})
        append_csv_cells(text, c.value, c.bounds.lower, c.bounds.upper);
      text += '\n';
    }
  return text;
}

std::string sensitivity_csv(const SobolSensitivity& all) {
  std::string text = "output,dispersion,rows,left_out,first,first_lower,first_upper,"
                     "total,total_lower,total_upper\n";
  for (const auto& [name, indices] : all.outputs)
    for (std::size_t i = 0; i < all.dispersions.size(); ++i) {
      append_csv_cell(text, name);
      append_csv_cells(text, all.dispersions[i], indices.rows, indices.left_out);
      for (const SobolIndex& index : {indices.effects[i].first, indices.effects[i].total})
        append_csv_cells(text, index.value, index.interval.lower, index.interval.upper);
      text += '\n';
    }
  return text;
}

std::string sensitivity_table(const RankSensitivity& all, std::string_view title) {
  std::string text = fmt::format("{}\n", title);
  const std::string bounds = fmt::format("{:g} % bounds", 100 * all.confidence);
  const std::string columns = fmt::format("  {:<{}}{:>9}{:>21}{:>9}{:>21}", "dispersion",
                                          name_width, "PRCC", bounds, "Spearman", bounds);
  for (const OutputRanks& output : all.outputs) {
    const auto size = [&](std::size_t j) {
      const RankEffect& effect = output.effects[j];
      return std::abs(output.entangled ? effect.spearman.value : effect.partial.value);
    };
    const auto line = [&](std::size_t j) {
      const auto& [spearman, partial] = output.effects[j];
      return fmt::format("  {:<{}}{}{}\n", shortened(all.dispersions[j], name_width - 2),
                         name_width, value_text(partial.value, partial.bounds),
                         value_text(spearman.value, spearman.bounds));
    };
    text += block(heading_of(output.output, output.count, "runs", output.missing), columns,
                  all.dispersions.size(), size, line);
  }
  return text;
}

std::string sensitivity_table(const SobolSensitivity& all, std::string_view title) {
  std::string text = fmt::format("{}\n", title);
  const std::string bounds = fmt::format("{:g} % bounds", 100 * all.confidence);
  const std::string columns = fmt::format("  {:<{}}{:>9}{:>21}{:>9}{:>21}", "dispersion",
                                          name_width, "total", bounds, "first", bounds);
  for (const auto& [name, indices] : all.outputs) {
    const SobolIndices& found = indices;
    const auto size = [&](std::size_t i) { return found.effects[i].total.value; };
    const auto line = [&](std::size_t i) {
      const auto& [first, total, inert] = found.effects[i];
      return fmt::format("  {:<{}}{}{}\n", shortened(all.dispersions[i], name_width - 2),
                         name_width, value_text(total.value, bounds_of(total.interval)),
                         value_text(first.value, bounds_of(first.interval)));
    };
    text += block(heading_of(name, found.rows, "rows", found.left_out), columns,
                  all.dispersions.size(), size, line);
    double sum = 0;
    for (const SobolEffect& effect : found.effects) sum += effect.first.value;
    if (!std::isnan(sum))
      text += fmt::format("  {:<{}}{:>39.3f}\n", "sum of the first-order", name_width, sum);
  }
  return text;
}

std::vector<std::string> warnings(const RankSensitivity& all) {
  std::vector<std::string> list;
  if (!all.unvaried.empty())
    list.push_back(fmt::format("the draws of {} do not vary", quoted(all.unvaried)));
  if (!all.idle.empty())
    list.push_back(fmt::format("no output is seen to rise or fall with {} in {} runs (one that "
                               "rises and falls would not be seen: Sobol' indices show it)",
                               quoted(all.idle), all.runs));
  if (std::ranges::any_of(all.outputs, &OutputRanks::entangled))
    list.emplace_back("two dispersions rank the runs alike, or there are too few runs: some "
                      "outputs have no partial coefficients");
  return list;
}

std::vector<std::string> warnings(const SobolSensitivity& all) {
  std::vector<std::string> list;
  if (const std::vector<std::string> idle = all.idle(); !idle.empty())
    list.push_back(fmt::format("no output of any run changes with {}", quoted(idle)));
  if (all.runs < all.total)
    list.push_back(fmt::format("only {} of {} runs are there", all.runs, all.total));
  return list;
}

} // namespace wingspread
