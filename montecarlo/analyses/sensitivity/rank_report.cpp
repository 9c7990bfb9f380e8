#include "montecarlo/analyses/sensitivity/rank_report.hpp"

#include "montecarlo/analyses/sensitivity/effect_table.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/jackknife.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"
#include "montecarlo/results/summary/summary_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// Says in words how the bounds were computed, which depends on the campaign's design.
std::string bounds_definition(const RankSensitivity& all) {
  if (all.replicates == 1) return std::string(one_replicate);
  if (all.replicates > 1)
    return fmt::format(
        "jackknife over {} independent replicates, Fisher's z, Student's t, two-sided",
        all.replicates);
  return fmt::format(
      "spearman: Fisher's z, variance (1 + r^2/2)/(n - 3) or that of the rows' influences on r, "
      "the "
      "larger; prcc: corrected "
      "for the bias of ranks, jackknife over {} parts of the runs, Fisher's z, Student's "
      "t; two-sided{}",
      jackknife_groups, over_interim_analyses(all.interim, all.confidence));
}

std::string too_few_runs(const RankSensitivity& all) {
  return fmt::format("{} too few to show an effect: it takes {} or more",
                     counted(all.runs, "run is", "runs are"), least_runs_for_effects);
}

} // namespace

Json sensitivity_json(const RankSensitivity& all, const Json& about) {
  Json outputs = Json::object();
  for (const OutputRanks& output : all.outputs) {
    Json effects = Json::object();
    for (std::size_t j = 0; j < all.dispersions.size(); ++j) {
      const auto& [spearman, partial, seen] = output.effects[j];
      effects[all.dispersions[j]] = {{"spearman", value_json(spearman.value, spearman.bounds)},
                                     {"prcc", value_json(partial.value, partial.bounds)}};
    }
    outputs[output.output] = {{"count", output.count},
                              {"missing", output.missing},
                              {"cut", output.cut},
                              {"entangled", output.entangled},
                              {"dispersions", effects}};
  }
  Json json{
      {stamp_key, about},
      {"method", "rank correlation"},
      {"runs", all.runs},
      {"warnings", warnings(all)},
      {"confidence", all.confidence},
      {"definitions",
       {{"spearman", "Pearson's of the mid-ranks, over the runs that have the output"},
        {"prcc", "partial correlation of the mid-ranks, all other dispersions held"},
        {"bounds", bounds_definition(all)},
        {"cut", "runs whose peak t_end cut: their values are those up to t_end"},
        {"deployed", "1 deployed, 0 otherwise"},
        {"moves_nothing", "dispersions of which no coefficient differs from 0 at the confidence "
                          "shared over all outputs"},
        {"follow_from_others", "dispersions of which the others explain half of the ranks' "
                               "variance or more: prcc omits their joint effect"}}},
      {"outputs", outputs},
      {"do_not_vary", all.unvaried},
      {"moves_nothing", all.idle},
      {"follow_from_others", all.collinear}};
  if (!all.rows.empty()) json["rows"] = all.rows;
  return json;
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

std::string sensitivity_table(const RankSensitivity& all, std::string_view title) {
  std::string text = fmt::format("{}\n", title);
  const std::string columns = column_names("PRCC", "Spearman", all.confidence);
  for (const OutputRanks& output : all.outputs) {
    const auto size = [&](std::size_t j) {
      const RankEffect& effect = output.effects[j];
      return std::fmax(std::abs(effect.spearman.value), std::abs(effect.partial.value));
    };
    const auto line = [&](std::size_t j) {
      const auto& [spearman, partial, seen] = output.effects[j];
      return fmt::format("{}{}{}\n", in_column("  " + all.dispersions[j], name_width + 2),
                         value_text(partial.value, partial.bounds),
                         value_text(spearman.value, spearman.bounds));
    };
    text += effect_block(
        heading_of(output.output, output.count, "runs", output.missing, "without a value") +
            cut_heading(output.cut),
        columns, all.dispersions.size(), size, line);
  }
  return text;
}

std::string moved_by_table(const RankSensitivity& all, std::string_view title) {
  if (all.runs < least_runs_for_effects)
    return fmt::format("{}\n\n  not known: {}\n", title, too_few_runs(all));
  MovedBy moved;
  for (const OutputRanks& output : all.outputs) {
    const auto larger = [&](std::size_t j) {
      const double spearman = output.effects[j].spearman.value,
                   partial = output.effects[j].partial.value;
      return std::isnan(partial) || std::abs(spearman) > std::abs(partial) ? spearman : partial;
    };
    const auto seen = [&](std::size_t j) {
      return output.effects[j].seen ? larger(j) : std::nan("");
    };
    const auto visible = [&](std::size_t j) {
      return output.effects[j].seen && output.effects[j].spearman.bounds.lower;
    };
    moved.add(output.output, {all.dispersions, seen, least_shown_correlation, visible,
                              [](double value) { return fmt::format("{:.2f}", value); }});
  }
  return fmt::format("{}\n\n", title) +
         moved.table("moved by (rank correlation, partial or Spearman's, the larger)",
                     ". A draw that moves an output both ways has no rank correlation: Sobol' "
                     "indices show it (sensitivity of the campaign's file)");
}

std::vector<std::string> warnings(const RankSensitivity& all) {
  std::vector<std::string> list;
  std::vector<CutOutput> cut;
  for (const OutputRanks& output : all.outputs) cut.push_back({output.output, output.cut});
  warn_of_t_end(cut, all.open_latches, all.runs, all.never_final, list);
  if (all.runs < least_runs_for_effects) list.push_back(too_few_runs(all));
  if (!all.unvaried.empty())
    list.push_back(fmt::format("the draws of {} do not vary", quoted(all.unvaried)));
  if (!all.idle.empty())
    list.push_back(fmt::format("no visible effect of {} on any output in {} runs (an effect that "
                               "first increases and then decreases shows in Sobol' indices only)",
                               quoted(all.idle), all.runs));
  for (const auto& [name, columns] : all.rows)
    if (columns.size() > 1)
      list.push_back(
          fmt::format("{} are drawn together, as rows of \"{}\": Spearman's coefficient of "
                      "one has the effects of the others in it; Sobol' indices are of "
                      "\"{}\" as a whole",
                      quoted(columns), name, name));
  if (all.replicates == 1) list.emplace_back(one_replicate);
  if (!all.collinear.empty())
    list.push_back(fmt::format("the draws of {} depend on those of others: their joint effect "
                               "is in Spearman's coefficients, not in the partial ones",
                               quoted(all.collinear)));
  const auto any_effect = [&](const auto& has) {
    return std::ranges::any_of(all.outputs, [&](const OutputRanks& output) {
      return !output.entangled && std::ranges::any_of(output.effects, has);
    });
  };
  if (any_effect([](const RankEffect& effect) {
        return std::isnan(effect.partial.value) && !std::isnan(effect.spearman.value);
      }))
    list.emplace_back("some partial coefficients are missing: other draws explain the output's "
                      "ranks exactly, or there are too few runs");
  const auto lacks_bounds = [](const RankEffect& effect) {
    return effect.spearman.bounds.lower && !std::isnan(effect.partial.value) &&
           !effect.partial.bounds.lower;
  };
  if (any_effect(lacks_bounds))
    list.emplace_back("some partial coefficients have no bounds: the draws explain nearly all of "
                      "the output's ranks, and their error is not known from the few that are "
                      "left, or there are too few runs");
  if (std::ranges::any_of(all.outputs, &OutputRanks::entangled))
    list.emplace_back("some outputs have no partial coefficients: two dispersions rank "
                      "the runs alike, or there are too few runs");
  return list;
}

} // namespace wingspread
