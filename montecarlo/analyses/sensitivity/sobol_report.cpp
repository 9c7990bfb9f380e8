#include "montecarlo/analyses/sensitivity/sobol_report.hpp"

#include "montecarlo/analyses/sensitivity/effect_table.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"
#include "montecarlo/results/summary/replication.hpp"

#include <fmt/format.h>

#include <cmath>

namespace wingspread {
namespace {

/// Says in words how the bounds were computed, which depends on whether the rows are independent.
std::string bounds_definition(const SobolBounds& how) {
  if (how.replicates == 1) return std::string(one_replicate);
  if (how.replicates > 1)
    return fmt::format("jackknife over {} independent replicates, Student's t, two-sided",
                       how.replicates);
  return fmt::format("percentile bootstrap over rows, {} resamples, two-sided", how.resamples);
}

/// The outputs without indices because they lack a value at some point.
std::vector<std::string> incomplete(const SobolSensitivity& all) {
  std::vector<std::string> names;
  for (const auto& [name, indices, cut] : all.outputs)
    if (indices.incomplete > 0) names.push_back(name);
  return names;
}

} // namespace

Json sensitivity_json(const SobolSensitivity& all, const Json& about) {
  Json outputs = Json::object();
  for (const auto& [name, indices, cut] : all.outputs) {
    Json effects = Json::object();
    for (std::size_t i = 0; i < all.dispersions.size(); ++i) {
      const auto& [first, total, inert] = indices.effects[i];
      effects[all.dispersions[i]] = {{"first", value_json(first.value, first.bounds)},
                                     {"total", value_json(total.value, total.bounds)},
                                     {"inert", inert}};
    }
    outputs[name] = {{"rows", indices.rows},
                     {"incomplete", indices.incomplete},
                     {"cut", cut},
                     {"mean", json_number(indices.mean)},
                     {"variance", json_number(indices.variance)},
                     {"dispersions", effects}};
  }
  return {
      {stamp_key, about},
      {"method", "Sobol' indices"},
      {"design", all.design},
      {"samples", all.rows},
      {"runs", all.runs},
      {"partial", all.runs < all.total},
      {"warnings", warnings(all)},
      {"confidence", all.bounds.confidence},
      {"definitions",
       {{"first", "Saltelli 2010, centred: mean over the N rows of (f_B - m)(f_ABi - f_A), over "
                  "the variance; m is the mean of all 2N values f_A and f_B"},
        {"total", "Jansen 1999: mean over the N rows of (f_A - f_ABi)^2, over twice the variance"},
        {"variance", "of the 2N values f_A and f_B about m, with the divisor 2N"},
        {"bounds", bounds_definition(all.bounds)},
        {"cut", "runs whose peak t_end cut: their values are those up to t_end"},
        {"incomplete", "rows in which one of the points does not have the output: where there are "
                       "any, it has no indices"},
        {"deployed", "1 deployed, 0 otherwise"},
        {"do_not_vary", "the same draw in all rows: their indices are unknown, not 0"},
        {"moves_nothing", "all outputs of all rows are the same without it, bit for bit"}}},
      {"outputs", outputs},
      {"do_not_vary", all.unvaried},
      {"moves_nothing", all.idle()}};
}

std::string sensitivity_csv(const SobolSensitivity& all) {
  std::string text = "output,dispersion,rows,incomplete,first,first_lower,first_upper,"
                     "total,total_lower,total_upper\n";
  for (const auto& [name, indices, cut] : all.outputs)
    for (std::size_t i = 0; i < all.dispersions.size(); ++i) {
      append_csv_cell(text, name);
      append_csv_cells(text, all.dispersions[i], indices.rows, indices.incomplete);
      for (const SobolIndex& index : {indices.effects[i].first, indices.effects[i].total})
        append_csv_cells(text, index.value, index.bounds.lower, index.bounds.upper);
      text += '\n';
    }
  return text;
}

namespace {

constexpr const char* shares_outside =
    "a share below 0 or above 100 % is noise of its estimate: more --samples reduce it";

} // namespace

std::string sensitivity_table(const SobolSensitivity& all, std::string_view title) {
  constexpr double digit = 0.0005; // half of the last one
  bool outside = false;
  std::string text = fmt::format("{}\n", title);
  const std::string columns = column_names("total", "first", all.bounds.confidence);
  for (const auto& [name, indices, cut] : all.outputs) {
    const SobolIndices& found = indices;
    const auto size = [&](std::size_t i) { return found.effects[i].total.value; };
    const auto line = [&](std::size_t i) {
      const auto& [first, total, inert] = found.effects[i];
      for (const double share : {first.value, total.value})
        outside = outside || share < -digit || share > 1 + digit;
      return fmt::format("{}{}{}\n", in_column("  " + all.dispersions[i], name_width + 2),
                         value_text(total.value, total.bounds),
                         value_text(first.value, first.bounds));
    };
    text += effect_block(
        heading_of(name, found.rows, "rows", found.incomplete, "with a missing value: no indices") +
            cut_heading(cut),
        columns, all.dispersions.size(), size, line);
    double sum = 0;
    long known = 0;
    for (const SobolEffect& effect : found.effects)
      if (!std::isnan(effect.first.value)) sum += effect.first.value, ++known;
    if (known > 0)
      text += fmt::format("  {:<{}}{:>39.3f}\n", "sum of the first-order", name_width, sum);
  }
  return outside ? fmt::format("{}\n{}\n", text, shares_outside) : text;
}

std::string moved_by_table(const SobolSensitivity& all, std::string_view title) {
  constexpr double least = least_shown_share;
  constexpr double least_counted = 0.005; // of the variance; less is 0 % as printed
  bool outside = false;
  MovedBy moved;
  for (const auto& [name, indices, cut] : all.outputs) {
    const SobolIndices& found = indices;
    if (found.incomplete > 0) {
      moved.add_unknown(name);
      continue;
    }
    const auto total = [&](std::size_t i) { return found.effects[i].total.value; };
    const auto visible = [&](std::size_t i) {
      return found.effects[i].total.bounds.lower.value_or(0) >= least_counted;
    };
    moved.add(name, {all.dispersions, total, least, visible, [&](double share) {
                       outside = outside || share > 1 + least_counted;
                       return fmt::format("{:.0f} %", 100 * share);
                     }});
  }
  return fmt::format("{}\n\n", title) +
         moved.table("moved by (share of the variance, interactions included)") +
         (outside ? fmt::format("  {}\n", shares_outside) : "");
}

namespace {

/// The outputs with an index whose bounds are wider than 0 to 1, where every true index lies.
std::vector<std::string> unknown_shares(const SobolSensitivity& all) {
  const auto says_nothing = [](const SobolEffect& effect) {
    const auto& [lower, upper] = effect.total.bounds;
    return lower && upper && *upper - *lower > 1;
  };
  std::vector<std::string> names;
  for (const auto& output : all.outputs)
    if (std::ranges::any_of(output.indices.effects, says_nothing)) names.push_back(output.name);
  return names;
}

} // namespace

std::vector<std::string> warnings(const SobolSensitivity& all) {
  std::vector<std::string> list;
  std::vector<CutOutput> cut;
  for (const auto& output : all.outputs) cut.push_back({output.name, output.cut});
  warn_of_t_end(cut, all.open_latches, all.runs, all.never_final, list);
  if (const std::vector<std::string> idle = all.idle(); !idle.empty())
    list.push_back(fmt::format("no output of any run changes with {}", quoted(idle)));
  if (!all.unvaried.empty())
    list.push_back(
        fmt::format("the draws of {} do not vary in these rows: their indices are unknown, "
                    "and values that are not drawn have no part in the others",
                    quoted(all.unvaried)));
  if (all.bounds.replicates == 1) list.emplace_back(one_replicate);
  if (const std::vector<std::string> names = incomplete(all); !names.empty())
    list.push_back(fmt::format("no indices of {}: some points of the design have no value (rank "
                               "correlations of a campaign's runs use the runs with a value)",
                               quoted(names)));
  if (const std::vector<std::string> names = unknown_shares(all); !names.empty())
    list.push_back(fmt::format("shares of the variance of {} have bounds wider than the whole "
                               "variance (--all prints them): more --samples",
                               quoted(names)));
  if (all.runs < all.total)
    list.push_back(fmt::format("only {} of {} runs are complete", all.runs, all.total));
  if (all.rows < least_rows_for_bounds && all.bounds.replicates != 1)
    list.push_back(fmt::format("no bounds: {} too few, it takes {}",
                               counted(all.rows, "sample is", "samples are"),
                               least_rows_for_bounds));
  return list;
}

} // namespace wingspread
