#include "montecarlo/results/summary/table.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/results/summary/compact_table.hpp"
#include "montecarlo/results/summary/overtravel.hpp"
#include "montecarlo/results/summary/warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <utility>

namespace wingspread {

namespace {

constexpr std::size_t most_lines = 8; ///< of reasons and of latch orders, unless all are asked for
constexpr std::size_t columns_per_block = 6, label_width = 19, number_width = 11; // of outputs

std::string percent_bounds(const Bounds& bounds) {
  if (!bounds.lower || !bounds.upper) return "–";
  return percent_range(*bounds.lower, *bounds.upper);
}

double share_of(long count, long runs) {
  return static_cast<double>(count) / static_cast<double>(runs);
}

std::string outcome_line(std::string_view name, const StatusShare& share) {
  return fmt::format("  {:<48}{:>10}{}{}\n", name, share.count,
                     right_aligned(share_text(share.rate), 12),
                     right_aligned(percent_bounds(share.bounds), 26));
}

/// @param all a line for every status; else one for those that no run has
std::string outcomes(const Summary& summary, bool all) {
  const std::string bounds = fmt::format("{:g} % bounds", 100 * summary.confidence);
  std::string text =
      fmt::format("\n{:<50}{:>10}{:>12}{:>26}\n", "OUTCOME", "runs", "share", bounds);
  std::vector<std::string> none;
  const StatusShare* of_none = nullptr; // equal counts have equal bounds
  for (const StatusShare& share : summary.statuses)
    if (share.count > 0 || share.status == Status::deployed || all)
      text += outcome_line(spaced(to_string(share.status)), share);
    else
      none.push_back(spaced(to_string(share.status))), of_none = &share;
  if (of_none) text += outcome_line(fmt::format("{}", fmt::join(none, ", ")), *of_none);
  if (summary.nominal)
    text +=
        fmt::format("  {:<48}{}\n", "the nominal wing", spaced(to_string(summary.nominal->status)));
  if (summary.nominal && !summary.nominal->reason.empty())
    text += fmt::format("    {}\n", wrapped(summary.nominal->reason, 4));
  if (summary.replicates == 1) text += fmt::format("  {}\n", one_replicate);
  return text;
}

std::string reasons(const Summary& summary, bool all) {
  if (summary.reasons.empty()) return "";
  std::string text = fmt::format("\n{:<12}{:>8}  {}\n", "WHY", "runs", "reason");
  const std::size_t shown =
      all ? summary.reasons.size() : std::min(summary.reasons.size(), most_lines);
  for (const auto& [status, reason, count] : std::span(summary.reasons).first(shown))
    text +=
        fmt::format("  {:<10}{:>8}  {}\n", spaced(to_string(status)), count, wrapped(reason, 22));
  if (shown < summary.reasons.size())
    text += fmt::format("  and {}, in summary.json\n",
                        counted(static_cast<long>(summary.reasons.size() - shown), "other reason",
                                "other reasons"));
  return text;
}

/// The angles at which hinges stopped in stalled runs; empty without final_angle.
std::string stalled_at(const Summary& summary) {
  if (summary.stalled_at.empty()) return "";
  std::string text =
      fmt::format("\n{:<50}{:>10}{:>12}{:>12}{:>12}\n", "STALLED AT, from latched, deg", "runs",
                  "median", "least", "largest");
  const auto degrees = [](double angle) { return angle * 180 / std::numbers::pi; };
  for (const StoppedHinge& each : summary.stalled_at)
    text += fmt::format("{}{:>10}{:>12.3f}{:>12.3f}{:>12.3f}\n",
                        in_column(fmt::format("  {}", each.hinge), 50), each.runs,
                        degrees(each.median), degrees(each.least), degrees(each.largest));
  return text;
}

std::string latch_orders(const Summary& summary, bool all) {
  std::string text = fmt::format("\n{:<50}{:>10}{:>12}\n", "LATCH ORDER", "runs", "share");
  const auto line = [&](std::string_view order, long count) {
    text += fmt::format("{}{:>10}{}\n", in_column(fmt::format("  {}", order), 50), count,
                        right_aligned(share_text(share_of(count, summary.runs)), 12));
  };
  const std::size_t shown =
      all ? summary.latch_orders.size() : std::min(summary.latch_orders.size(), most_lines);
  long others = summary.runs - summary.without_latch;
  for (const auto& [order, count] : std::span(summary.latch_orders).first(shown)) {
    line(order, count);
    others -= count;
  }
  if (others > 0)
    line((summary.more_order_kinds ? "more than " : "") +
             counted(summary.latch_order_kinds - static_cast<long>(shown), "other order",
                     "other orders"),
         others);
  if (summary.without_latch > 0) line("no latch", summary.without_latch);
  return text;
}

/// A column of numbers in the table of outputs.
struct NumberColumn {
  std::string heading;
  std::function<double(const OutputSummary&)> value;
};

std::vector<NumberColumn> number_columns(const Summary& summary) {
  std::vector<NumberColumn> columns{{"mean", [](const OutputSummary& o) { return o.moments.mean; }},
                                    {"std", [](const OutputSummary& o) { return o.moments.std; }}};
  if (summary.nominal)
    columns.insert(columns.begin(), {"nominal", [](const OutputSummary& o) { return *o.nominal; }});
  if (summary.outputs.empty()) return columns;
  const auto& quantiles = summary.outputs.front().quantiles;
  for (std::size_t i = 0; i < quantiles.size(); ++i)
    columns.push_back({quantile_name(quantiles[i].p),
                       [i](const OutputSummary& o) { return o.quantiles[i].all.value; }});
  return columns;
}

std::string label(const OutputName& name) {
  return name.quantity == "rate_at" ? "rate at " + name.other : spaced(name.quantity);
}

/// Five digits, or four if five would leave no blank between columns.
std::string in_number_column(double value) {
  const std::string text = in_digits(value);
  const bool fits = count_characters(text) < number_width;
  return right_aligned(fits ? text : fmt::format("{:#.4g}", value), number_width);
}

std::string output_line(const OutputSummary& output, std::span<const NumberColumn> columns) {
  const OutputName name = parse_output_name(output.name);
  std::string text = fmt::format("{}{:<6}{:>9}", in_column("  " + label(name), label_width),
                                 name.unit, output.moments.count);
  for (const NumberColumn& column : columns) text += in_number_column(column.value(output));
  return text + '\n';
}

std::string output_block(const Summary& summary, std::span<const NumberColumn> columns, bool all) {
  std::string text = fmt::format("\n{:<{}}{:<6}{:>9}", "OUTPUT", label_width, "unit", "runs");
  for (const NumberColumn& column : columns) text += right_aligned(column.heading, number_width);
  text += '\n';
  bool explained = false; // whether it needs the note
  for (const char* previous = nullptr; const OutputSummary& output : summary.outputs) {
    if (!all && is_quiet(output)) continue;
    const std::string hinge = parse_output_name(output.name).hinge;
    if (!previous || hinge != parse_output_name(previous).hinge)
      text += fmt::format("{}\n", hinge.empty() ? "wing" : hinge);
    text += output_line(output, columns);
    explained = explained || output.name.ends_with(".overtravel");
    previous = output.name.c_str();
  }
  if (explained) text += fmt::format("  {}\n", overtravel_note);
  return text;
}

/// The quantiles that do not exist over all runs, with the reason, and as they are among the runs with a value.
std::string missing_quantiles(const Summary& summary) {
  std::string text;
  for (const OutputSummary& output : summary.outputs) {
    const std::string unit = parse_output_name(output.name).unit;
    std::vector<std::string> found;
    for (const QuantileEstimate& quantile : output.quantiles)
      if (quantile.among && std::isnan(quantile.all.value))
        found.push_back(fmt::format("{} {}{}", quantile_name(quantile.p),
                                    in_digits(quantile.among->value),
                                    unit.empty() ? "" : ' ' + unit));
    if (found.empty()) continue;
    const std::string line = fmt::format(
        "{}: {} of {} runs have a value; the others rank {}. Among runs with a value: {}",
        output.name, output.moments.count, summary.runs, words_of(output.missing_end),
        fmt::join(found, ", "));
    text += "  " + wrapped(line, 4) + '\n';
  }
  return text.empty() ? "" : "\nNO QUANTILE over all runs\n" + text;
}

/// Splits the columns into blocks so that lines keep within the width. @param all also outputs that are_quiet()
std::string outputs(const Summary& summary, bool all) {
  if (summary.outputs.empty()) return "";
  const std::vector<NumberColumn> columns = number_columns(summary);
  std::string text;
  for (std::size_t first = 0; first < columns.size(); first += columns_per_block) {
    const std::size_t count = std::min(columns_per_block, columns.size() - first);
    text += output_block(summary, std::span(columns).subspan(first, count), all);
  }
  if (!all) text += quiet_outputs(summary.outputs);
  if (const std::string ranks = missing_ranks(summary.outputs); !ranks.empty())
    text += '\n' +
            wrapped(fmt::format("Mean, std: over the runs in which the output happened, of "
                                "{}. Quantiles: over all runs. {}.",
                                summary.runs, ranks),
                    0) +
            '\n';
  return text + missing_quantiles(summary);
}

/// @param sign as of in_digits_towards
std::string in_digits_if_any(const std::optional<double>& value, int sign = 0) {
  return value ? in_digits_towards(*value, sign) : "–";
}

/// The rule by which runs are ranked for tolerance limits, and why limits are missing, with their outputs.
std::string tolerance_notes(const Summary& summary) {
  bool beyond = false;
  std::vector<std::pair<std::string, std::vector<std::string>>> missing;
  for (const OutputSummary& output : summary.outputs)
    for (const ToleranceLimitEstimate& estimate : output.tolerance_limits) {
      beyond = beyond || estimate.beyond > 0;
      const std::string why = why_no_limit(summary, estimate);
      if (why.empty()) continue;
      auto same = std::ranges::find(missing, why, &decltype(missing)::value_type::first);
      if (same == missing.end()) same = missing.insert(missing.end(), {why, {}});
      if (same->second.empty() || same->second.back() != output.name)
        same->second.push_back(output.name);
    }
  std::string text;
  for (const auto& [why, names] : missing)
    text += "  " + wrapped(fmt::format("–: {} ({})", why, fmt::join(names, ", ")), 4) + '\n';
  if (beyond)
    text += "  " +
            wrapped("Limits are over all runs, as requirements: a run that did not deploy or has "
                    "no value counts as worse than any value (above all for an upper limit, below "
                    "all for a lower one), even where the quantiles above use its value. So does a "
                    "peak that t_end cut, but for a lower limit, which takes its value.",
                    4) +
            '\n';
  return text;
}

/// A line for each output and each limit asked for.
std::string tolerance(const Summary& summary) {
  std::string text;
  for (const OutputSummary& output : summary.outputs)
    for (const auto& [spec, limits, beyond] : output.tolerance_limits) {
      const std::string content =
          fmt::format("{:.10g} % at {:.10g} %", 100 * spec.probability, 100 * spec.confidence);
      text += fmt::format("{}{}{:>14}", in_column("  " + output.name, 44), in_column(content, 28),
                          spec.side == Side::upper ? "" : in_digits_if_any(limits.lower, -1));
      if (spec.side != Side::lower)
        text += fmt::format("{:>14}", in_digits_if_any(limits.upper, 1));
      text += '\n';
    }
  if (text.empty()) return "";
  return fmt::format("\n{:<44}{:<28}{:>14}{:>14}\n", "TOLERANCE LIMITS", "content, confidence",
                     "lower", "upper") +
         text + tolerance_notes(summary);
}

/// The worst runs that break a requirement, and the command that replays the first.
std::string broken_runs(const Verdict& verdict, std::string_view folder) {
  constexpr std::size_t most = 6;
  if (verdict.broken.empty() || folder.empty()) return "";
  std::string text = "    " + replay_command(folder, verdict.broken.front());
  for (std::size_t i = 1; i < std::min(verdict.broken.size(), most); ++i)
    text += fmt::format("{}{}", i == 1 ? "   and " : ", ", verdict.broken[i]);
  return text + (verdict.broken.size() > most ? ", …\n" : "\n");
}

/// The verdicts of groups of requirements, at their joint confidence.
std::string groups(const Summary& summary) {
  std::string text;
  for (const auto& [name, confidence, members, passed, decision] :
       judge_groups(summary.requirements))
    text += fmt::format("  group {}: {}: {} of {} pass, joint confidence {:.10g} %\n", name,
                        to_string(decision), passed, members, 100 * confidence);
  return text;
}

std::string requirements(const Summary& summary, std::string_view folder) {
  if (summary.requirements.empty()) return "";
  std::string text = fmt::format("\n{:<46}{:<10}{:>8}{:>8}{:>13}{:>13}\n", "REQUIREMENT", "verdict",
                                 "broken", "allowed", "observed", "guaranteed");
  for (const Verdict& verdict : summary.requirements) {
    text += fmt::format(
        "{}{:<10}{:>8}{:>8}{}{}\n", in_column("  " + to_string(verdict.requirement), 46),
        to_string(verdict.decision), verdict.failures(),
        verdict.allowed ? std::to_string(*verdict.allowed) : "–",
        right_aligned(observed_text(verdict), 13), right_aligned(guaranteed_text(verdict), 13));
    if (verdict.decision != Decision::pass || verdict.joint)
      text += "    " + wrapped(evidence(verdict), 4) + '\n';
    text += broken_runs(verdict, folder);
  }
  text += groups(summary);
  const auto passes = [](const Verdict& verdict) { return verdict.decision == Decision::pass; };
  const double joint = joint_confidence(summary.requirements);
  if (std::ranges::count_if(summary.requirements, passes) > 1)
    text +=
        fmt::format("  Joint confidence of {} requirements: {}.\n", summary.requirements.size(),
                    joint > 0 ? fmt::format("at least {:.10g} %", 100 * joint) : "no guarantee");
  return text;
}

} // namespace

std::string found_text(const GoalState& found) {
  const WidthGoal* goal = std::get_if<WidthGoal>(&found.goal);
  if (!goal) return found.met ? "decided" : "open";
  if (found.relative) return percent(*found.relative);
  const std::string unit = found.width ? parse_output_name(goal->output).unit : "";
  return in_digits_if_any(found.width) + (unit.empty() ? "" : ' ' + unit);
}

namespace {

std::string stopping(const Summary& summary) {
  if (summary.until.empty()) return "";
  std::string text =
      fmt::format("\n{:<58}{:>20}{:>20}\n", "STOPPING GOAL, interval width", "found", "reached");
  for (const GoalState& found : summary.until)
    text += fmt::format("{}{:>20}{:>20}\n", in_column("  " + to_string(found.goal), 58),
                        found_text(found), found.met ? "yes" : "no");
  return text;
}

std::string files(const Summary& summary, std::string_view folder) {
  if (folder.empty()) return "";
  return fmt::format("\nFILES  {}: {}, summary.json, histograms.json, histograms.csv\n", folder,
                     summary.without_rows ? "broken_runs.csv, extremes.csv" : "runs.csv");
}

/// Merges neighbouring bins down to at most `most`.
Histogram coarser(const Histogram& histogram, std::size_t most) {
  const std::size_t group = (histogram.counts.size() + most - 1) / most;
  if (group <= 1) return histogram;
  Histogram result{{histogram.edges.front()}, {}};
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (i % group == 0) {
      result.counts.push_back(0);
      result.edges.push_back(0);
    }
    result.counts.back() += histogram.counts[i];
    result.edges.back() = histogram.edges[i + 1];
  }
  return result;
}

/// A bar of `eighths` eighths of a column.
std::string bar(long eighths) {
  constexpr std::array partial{"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  std::string text;
  for (long full = 0; full < eighths / 8; ++full) text += "█";
  return text + partial[static_cast<std::size_t>(eighths % 8)];
}

} // namespace

std::string summary_table(const Summary& summary, std::string_view title, std::string_view folder,
                          bool all) {
  return std::string(title) + '\n' + outcomes(summary, all) + reasons(summary, all) +
         stalled_at(summary) + latch_orders(summary, all) + outputs(summary, all) +
         accuracy_text(summary, all) + tolerance(summary) + requirements(summary, folder) +
         stopping(summary) + warning_lines(warnings(summary)) + files(summary, folder);
}

std::string draw_histogram(std::string_view name, std::string_view unit, const Histogram& histogram,
                           int width) {
  std::string text = unit.empty() ? std::string(name) : fmt::format("{}, {}", name, unit);
  text += histogram.counts.empty() ? "\n  no values\n" : "\n";
  if (histogram.counts.empty()) return text;
  const Histogram bins = coarser(histogram, 20);
  double highest = 0;
  for (std::size_t i = 0; i < bins.counts.size(); ++i) highest = std::max(highest, bins.density(i));
  const int digits = digits_that_tell(bins.edges, 6);
  int edge_width = 12;
  for (const double edge : bins.edges)
    edge_width =
        std::max(edge_width, static_cast<int>(fmt::formatted_size("{:.{}g}", edge, digits)));
  const int bar_width = width - edge_width - 11;
  const double eighths = 8.0 * (bar_width - 1);
  for (std::size_t i = 0; i < bins.counts.size(); ++i)
    text += fmt::format("{:>{}.{}g} │{:<{}}{:>9}\n", bins.edges[i], edge_width, digits,
                        bar(std::lround(eighths * bins.density(i) / highest)), bar_width,
                        bins.counts[i]);
  return text + fmt::format("{:>{}.{}g} ┘\n", bins.edges.back(), edge_width, digits);
}

} // namespace wingspread
