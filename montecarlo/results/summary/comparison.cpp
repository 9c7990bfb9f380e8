#include "montecarlo/results/summary/comparison.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/summary/compact_table.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/table.hpp"
#include "montecarlo/results/summary/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <tuple>

namespace wingspread {

std::string share_text(double share) {
  constexpr double shown = 5e-6; // three decimals of a per cent round less away
  const double distance = std::min(share, 1 - share);
  if (!(distance > 0 && distance < shown)) return percent(share);
  constexpr int most = 12; // the distance is then near the rounding of a double
  return percent(share,
                 std::min(most, 1 - static_cast<int>(std::floor(std::log10(100 * distance)))));
}

namespace {

constexpr int name_width = 46, case_width = 13;

using Cases = std::span<const CaseSummary>;

/// Broken runs divided by the allowed number; if the runs are too few for a pass, by N (1 − p). The report's page ranks
/// by the same share (40-verdicts.js).
double used_share(const Verdict& verdict) {
  if (verdict.failures() == 0) return 0;
  const double allowed =
      verdict.allowed ? static_cast<double>(*verdict.allowed)
                      : static_cast<double>(verdict.runs) * (1 - verdict.requirement.probability);
  return static_cast<double>(verdict.failures()) / allowed; // infinite if none may
}

/// Ranks verdicts: smaller is worse.
auto standing(const Verdict& verdict) {
  constexpr std::array rank{2, 0, 1}; // pass, fail, undecided
  return std::tuple(rank[static_cast<std::size_t>(verdict.decision)], -used_share(verdict),
                    verdict.margin.value_or(-std::numeric_limits<double>::infinity()),
                    verdict.share);
}

/// Counts all verdicts of all cases, because each of them might have been a false pass. A group's members share its
/// risk, as in each case's own summary.
double joint_confidence_of(const std::vector<CaseSummary>& cases) {
  std::vector<double> confidences;
  for (const CaseSummary& each : cases)
    for (const Verdict& verdict : each.summary.requirements)
      confidences.push_back(verdict.confidence_alone);
  return joint_confidence(confidences);
}

/// A verdict as in the case's own summary.json, without the runs that break it.
Json requirement_json(const std::vector<CaseSummary>& cases, const std::vector<Json>& summaries,
                      std::size_t requirement) {
  const std::size_t worst = worst_case(cases, requirement);
  Json json =
      write_requirements({&cases[worst].summary.requirements[requirement].requirement, 1}).front();
  json["worst"] = cases[worst].name;
  json["verdict"] = summaries[worst]["requirements"][requirement]["verdict"];
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Json& whole = summaries[i]["requirements"][requirement];
    Json& its = json["cases"][cases[i].name];
    for (const char* key :
         {"verdict", "margin", "evidence", "runs", "failures", "observed", "guaranteed", "replay"})
      if (whole.contains(key)) its[key] = whole[key];
  }
  return json;
}

// ---- the table

using Cell = std::function<std::string(const CaseSummary&)>;

/// A line with a cell per case. A name too long for its column has a line of its own.
std::string line(std::string_view name, Cases cases, const Cell& cell) {
  std::string text = in_column(name, name_width);
  for (const CaseSummary& each : cases) text += right_aligned(cell(each), case_width);
  return text + '\n';
}

std::string heading(std::string_view name, Cases cases) {
  return '\n' + line(name, cases, [](const CaseSummary& each) { return each.name; });
}

std::string outcome_lines(Cases cases) {
  std::string text = heading("OUTCOME", cases);
  text += line("  runs", cases,
               [](const CaseSummary& each) { return std::to_string(each.summary.runs); });
  for (std::size_t i = 0; i < statuses.size(); ++i)
    text += line("  " + spaced(to_string(statuses[i])), cases, [i](const CaseSummary& each) {
      return share_text(each.summary.statuses[i].rate);
    });
  text += line("  the nominal wing", cases, [](const CaseSummary& each) {
    return each.summary.nominal ? spaced(to_string(each.summary.nominal->status)) : "–";
  });
  return text;
}

/// The mean, the first and the last quantile; a quantile that does not exist also among the runs with a value.
std::string output_lines(const OutputSummary& output, std::size_t index, Cases cases) {
  std::string text =
      fmt::format("{}{}{}{}\n", output.name, *parse_output_name(output.name).unit ? ", " : "",
                  parse_output_name(output.name).unit,
                  output.name.ends_with(".overtravel") ? " (backwards, beyond stowed)" : "");
  const auto of = [index](const CaseSummary& each) -> const OutputSummary& {
    return each.summary.outputs[index];
  };
  text += line("  nominal", cases, [&](const CaseSummary& each) {
    return of(each).nominal ? in_digits(*of(each).nominal) : "–";
  });
  text += line("  mean", cases,
               [&](const CaseSummary& each) { return in_digits(of(each).moments.mean); });
  const std::size_t count = output.quantiles.size();
  for (std::size_t q = 0; q < count; q += std::max<std::size_t>(count - 1, 1)) {
    const auto quantile = [&](const CaseSummary& each) { return of(each).quantiles[q]; };
    const auto among = [&](const CaseSummary& each) {
      return quantile(each).among.value_or(quantile(each).all).value;
    };
    const std::string name = "  " + quantile_name(output.quantiles[q].p);
    text += line(name, cases,
                 [&](const CaseSummary& each) { return in_digits(quantile(each).all.value); });
    if (std::ranges::any_of(cases, [&](const CaseSummary& each) {
          return std::isnan(quantile(each).all.value) && !std::isnan(among(each));
        }))
      text += line(name + " among runs with a value", cases,
                   [&](const CaseSummary& each) { return in_digits(among(each)); });
  }
  return text;
}

std::string all_output_lines(Cases cases) {
  const std::vector<OutputSummary>& outputs = cases.front().summary.outputs;
  std::string text = outputs.empty() ? "" : heading("OUTPUT", cases);
  for (std::size_t i = 0; i < outputs.size(); ++i) text += output_lines(outputs[i], i, cases);
  return text;
}

std::string requirement_lines(const std::vector<CaseSummary>& all, Cases cases) {
  const auto count = cases.front().summary.requirements.size();
  if (count == 0) return "";
  std::string text = heading("REQUIREMENT, runs that break it / allowed", cases);
  for (std::size_t i = 0; i < count; ++i) {
    const auto verdict = [i](const CaseSummary& each) -> const Verdict& {
      return each.summary.requirements[i];
    };
    text += to_string(verdict(cases.front()).requirement) + '\n';
    text += line("  worst: " + all[worst_case(all, i)].name, cases, [&](const CaseSummary& each) {
      return std::string(to_string(verdict(each).decision));
    });
    text += line("", cases, [&](const CaseSummary& each) {
      const auto& allowed = verdict(each).allowed;
      return fmt::format("{} / {}", verdict(each).failures(),
                         allowed ? std::to_string(*allowed) : "–");
    });
  }
  const auto groups = judge_groups(cases.front().summary.requirements);
  for (std::size_t g = 0; g < groups.size(); ++g)
    text +=
        line(fmt::format("  group {}, {:.10g} %", groups[g].name, 100 * groups[g].confidence),
             cases, [g](const CaseSummary& each) {
               return std::string(to_string(judge_groups(each.summary.requirements)[g].decision));
             });
  return text;
}

} // namespace

bool is_worse(const Verdict& verdict, const Verdict& other) {
  return standing(verdict) < standing(other);
}

std::size_t worst_case(const std::vector<CaseSummary>& cases, std::size_t requirement) {
  const auto verdict = [&](const CaseSummary& each) -> const Verdict& {
    return each.summary.requirements[requirement];
  };
  return static_cast<std::size_t>(std::ranges::min_element(cases, is_worse, verdict) -
                                  cases.begin());
}

Json cases_json(const std::vector<CaseSummary>& cases, const Json& about) {
  std::vector<Json> summaries;
  for (const CaseSummary& each : cases) summaries.push_back(summary_json(each.summary, {}));
  Json json{{stamp_key, about}, {"cases", Json::object()}, {"outputs", Json::object()}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Json& its = json["cases"][cases[i].name];
    its = {{"runs", cases[i].summary.runs}, {"status", summaries[i]["status"]}};
    if (summaries[i].contains("nominal")) its["nominal"] = summaries[i]["nominal"];
    if (summaries[i].contains("groups")) its["groups"] = summaries[i]["groups"];
    if (cases[i].partial) its["partial"] = true;
    for (const auto& [output, statistics] : summaries[i]["outputs"].items())
      json["outputs"][output][cases[i].name] = statistics;
  }
  json["requirements"] = Json::array();
  for (std::size_t i = 0; i < cases.front().summary.requirements.size(); ++i)
    json["requirements"].push_back(requirement_json(cases, summaries, i));
  if (!cases.front().summary.requirements.empty())
    json["joint_confidence"] = joint_confidence_of(cases);
  json["definitions"] = {
      {"worst",
       "failed before undecided before passed, then the largest number of runs that break the "
       "requirement, as a share of the number that may, then the least margin"},
      {"draws", "the same in every case: differences between cases are the cases'"},
      {"joint_confidence",
       "at least this for all that pass in all cases together: 1 - the sum of (1 - c)"},
      {"statistics", "as in each case's own summary.json"}};
  return json;
}

std::string stopping_lines(const std::vector<CaseSummary>& cases) {
  const std::size_t goals = cases.front().summary.until.size();
  if (goals == 0) return "";
  constexpr int goal_width = 45;
  std::string text = fmt::format("\n{}{:>13}{:>20}{:>20}\n",
                                 in_column("STOPPING GOAL, interval width", goal_width), "case",
                                 "found", "reached");
  for (std::size_t i = 0; i < goals; ++i)
    for (const CaseSummary& each : cases) {
      if (i >= each.summary.until.size()) continue;
      const GoalState& found = each.summary.until[i];
      const bool first = &each == &cases.front();
      text += fmt::format(
          "{}{}{:>20}{:>20}\n", in_column(first ? "  " + to_string(found.goal) : "", goal_width),
          right_aligned(each.name, case_width), found_text(found), found.met ? "yes" : "no");
    }
  return text;
}

std::string cases_table(const std::vector<CaseSummary>& cases, std::string_view title,
                        std::string_view folder) {
  constexpr std::size_t most_beside = (table_width - name_width) / case_width;
  std::string text = std::string(title) + '\n';
  for (std::size_t first = 0; first < cases.size(); first += most_beside) {
    const Cases block = Cases(cases).subspan(first, std::min(most_beside, cases.size() - first));
    text += outcome_lines(block) + all_output_lines(block) + requirement_lines(cases, block);
  }
  if (const std::string ranks = missing_ranks(cases); !ranks.empty())
    text += '\n' + wrapped("Quantiles are over all runs. " + ranks + '.', 0) + '\n';
  text += stopping_lines(cases);
  for (const CaseSummary& each : cases)
    if (each.partial) text += fmt::format("\n{} lacks runs of the campaign\n", each.name);
  return text + warning_lines(warnings(cases)) +
         fmt::format("\nFILES  {}: cases.json, and a results folder for each case\n", folder);
}

} // namespace wingspread
