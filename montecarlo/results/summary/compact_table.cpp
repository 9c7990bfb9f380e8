#include "montecarlo/results/summary/compact_table.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/results/summary/overtravel.hpp"
#include "montecarlo/results/summary/warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

namespace wingspread {
namespace {

constexpr std::size_t compact_name_width = 32, unit_width = 8, compact_case_width = 20;
constexpr std::size_t most_cases =
    (table_width - compact_name_width - unit_width) / compact_case_width;

using CompactCases = std::span<const CaseSummary>;
using CompactCell = std::function<std::string(const CaseSummary&)>;

std::string compact_line(std::string_view name, CompactCases cases, const CompactCell& cell) {
  std::string text = in_column(name, compact_name_width + unit_width);
  for (const CaseSummary& each : cases) text += right_aligned(cell(each), compact_case_width);
  return text + '\n';
}

std::string compact_heading(std::string_view name, CompactCases cases) {
  return '\n' + compact_line(name, cases, [](const CaseSummary& each) { return each.name; });
}

/// A line for each status that some run has, and one for all others together.
std::string compact_outcomes(CompactCases cases) {
  std::string text = compact_heading("OUTCOME", cases);
  text += compact_line("  runs", cases,
                       [](const CaseSummary& each) { return std::to_string(each.summary.runs); });
  std::vector<std::string> none;
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    const auto has = [i](const CaseSummary& each) { return each.summary.statuses[i].count > 0; };
    const std::string name = spaced(to_string(statuses[i]));
    if (statuses[i] == Status::deployed || std::ranges::any_of(cases, has))
      text += compact_line("  " + name, cases, [i](const CaseSummary& each) {
        return share_text(each.summary.statuses[i].rate);
      });
    else
      none.push_back(name);
  }
  if (!none.empty())
    text += compact_line(fmt::format("  {}", fmt::join(none, ", ")), cases,
                         [](const CaseSummary&) { return std::string("0"); });
  text += compact_line("  the nominal wing", cases, [](const CaseSummary& each) {
    return each.summary.nominal ? spaced(to_string(each.summary.nominal->status)) : "–";
  });
  for (const CaseSummary& each : cases)
    if (each.summary.nominal && !each.summary.nominal->reason.empty())
      text += fmt::format(
          "    {}\n", wrapped(fmt::format("{}: {}", each.name, each.summary.nominal->reason), 4));
  return text;
}

std::string four_digits(double value) {
  return std::isnan(value) ? "–" : fmt::format("{:.4g}", value);
}

double quantile_of(const OutputSummary& output, std::size_t index) {
  return output.quantiles[index].all.value;
}

/// Whether a line in words says all of an output: it is quiet in each case, and a constant is the same in all.
bool is_quiet_in_all(CompactCases cases, std::size_t output) {
  const Moments& first = cases.front().summary.outputs[output].moments;
  return std::ranges::all_of(cases, [&](const CaseSummary& each) {
    const OutputSummary& found = each.summary.outputs[output];
    const Moments& own = found.moments;
    return is_quiet(found) && (found.name.ends_with(".overtravel") ||
                               (own.count == 0 ? first.count == 0 : own.min == first.min));
  });
}

/// The heading names the two quantiles.
std::string compact_outputs(CompactCases all, CompactCases cases) {
  const auto& outputs = cases.front().summary.outputs;
  if (outputs.empty()) return "";
  const auto& quantiles = outputs.front().quantiles;
  const std::size_t last = quantiles.empty() ? 0 : quantiles.size() - 1;
  std::string text =
      compact_heading(quantiles.empty() ? "OUTPUT, mean"
                      : last == 0       ? fmt::format("OUTPUT, {}", quantile_name(quantiles[0].p))
                                  : fmt::format("OUTPUT, {} and {}", quantile_name(quantiles[0].p),
                                                quantile_name(quantiles[last].p)),
                      cases);
  bool explained = false; // whether it needs the note
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto of = [i](const CaseSummary& each) -> const OutputSummary& {
      return each.summary.outputs[i];
    };
    if (is_quiet_in_all(all, i)) continue;
    text += compact_line(
        in_column("  " + outputs[i].name, compact_name_width) +
            std::string(parse_output_name(outputs[i].name).unit),
        cases, [&](const CaseSummary& each) {
          if (quantiles.empty()) return four_digits(of(each).moments.mean);
          const std::string low = four_digits(quantile_of(of(each), 0));
          return last == 0 ? low
                           : low + right_aligned(four_digits(quantile_of(of(each), last)), 10);
        });
    explained = explained || outputs[i].name.ends_with(".overtravel");
  }
  if (explained) text += fmt::format("  {}\n", overtravel_note);
  return text;
}

std::string compact_requirements(CompactCases cases) {
  const auto count = cases.front().summary.requirements.size();
  if (count == 0) return "";
  std::string text = compact_heading("REQUIREMENT, broken / allowed", cases);
  for (std::size_t i = 0; i < count; ++i) {
    const auto verdict = [i](const CaseSummary& each) -> const Verdict& {
      return each.summary.requirements[i];
    };
    text += compact_line(
        "  " + to_string(verdict(cases.front()).requirement), cases, [&](const CaseSummary& each) {
          const auto& allowed = verdict(each).allowed;
          return fmt::format("{} {} / {}", to_string(verdict(each).decision),
                             verdict(each).failures(), allowed ? std::to_string(*allowed) : "–");
        });
  }
  return text;
}

/// The smallest and largest value of an output in all summaries; NaN where none has it.
struct Reach {
  double least = std::nan(""), most = std::nan("");
  void add(const OutputSummary& output) {
    if (output.moments.count == 0) return;
    least = std::fmin(least, output.moments.min);
    most = std::fmax(most, output.moments.max);
  }
};

std::string described_quiet(const std::vector<std::pair<std::string, Reach>>& quiet) {
  std::vector<std::string> hinges, constants;
  double largest = 0;
  for (const auto& [name, reach] : quiet) {
    const auto parts = parse_output_name(name);
    if (parts.quantity == "overtravel") {
      hinges.push_back(parts.hinge), largest = std::fmax(largest, reach.most);
    } else if (std::isnan(reach.most)) {
      constants.push_back(name + " has no value");
    } else {
      constants.push_back(
          fmt::format("{} = {:.5g}{}{}", name, reach.most, *parts.unit ? " " : "", parts.unit));
    }
  }
  std::string text;
  const auto add = [&](const std::string& sentence) { text += "  " + wrapped(sentence, 2) + '\n'; };
  if (!hinges.empty())
    add(fmt::format("overtravel (backwards, beyond stowed) of {}: {}", fmt::join(hinges, ", "),
                    largest == 0 ? "none" : fmt::format("at most {} deg", degrees_text(largest))));
  if (!constants.empty()) add(fmt::format("the same in every run: {}", fmt::join(constants, ", ")));
  return text;
}

/// An error: two digits.
std::string in_two_digits(double error) {
  return std::isnan(error) ? "–" : fmt::format("{:.2g}", error);
}

/// The largest errors of the integration. An output that does not vary, or of a single run or replicate, has no
/// standard error: its error is compared with its value.
struct LargestErrors {
  /// Over the standard error of the mean; NaN if no output has one, infinite if no run could be repeated.
  double of_standard_error = undefined;
  double of_value = undefined; ///< over |mean|, of outputs without one; NaN if there are none
  std::string of_zero;         ///< "1e-12 rad of base.peak_angle", an output that is 0; or empty
};

LargestErrors largest_errors(const Summary& summary) {
  LargestErrors found;
  if (summary.accuracy->runs == 0) found.of_standard_error = HUGE_VAL;
  for (std::size_t i = 0; i < summary.accuracy->outputs.size(); ++i) {
    const auto& [name, runs, error, rms] = summary.accuracy->outputs[i];
    const double sampling = summary.outputs[i].mean_error;
    const double value = std::abs(summary.outputs[i].moments.mean);
    if (std::isnan(error)) continue;
    if (sampling > 0)
      found.of_standard_error = std::fmax(found.of_standard_error, error / sampling);
    else if (value > 0 || error == 0)
      found.of_value = std::fmax(found.of_value, error == 0 ? 0 : error / value);
    else if (found.of_zero.empty())
      found.of_zero = fmt::format("{:.1g} {} of {}", error, parse_output_name(name).unit, name);
  }
  return found;
}

/// Why some output has no standard error.
std::string_view why_no_standard_error(const Summary& summary) {
  if (summary.runs == 1) return "a single run";
  return summary.replicates == 1 ? "one replicate has none: take two or more" : "it does not vary";
}

/// "≤ 8e-06 % of a standard error, ≤ 2e-07 % of a value that does not vary".
std::string errors_text(const Summary& summary) {
  const LargestErrors found = largest_errors(summary);
  std::vector<std::string> parts;
  if (!std::isnan(found.of_standard_error))
    parts.push_back(fmt::format("≤ {:.1g} % of a standard error", 100 * found.of_standard_error));
  // next to an error of a standard error, exactness needs no word
  if (parts.empty() ? !std::isnan(found.of_value) : found.of_value > 0)
    parts.push_back(fmt::format("≤ {:.1g} % of a value without standard error ({})",
                                100 * found.of_value, why_no_standard_error(summary)));
  if (!found.of_zero.empty()) parts.push_back(found.of_zero + ", which is 0");
  return parts.empty() ? "unknown" : fmt::format("{}", fmt::join(parts, ", "));
}

/// The runs in which the errors are at most so large.
std::string errors_where(const Summary& summary) {
  const Accuracy& found = *summary.accuracy;
  const bool all_known = found.in_doubt.empty() && found.unreached == 0 &&
                         (found.runs == summary.runs || (summary.one_run && found.runs > 0));
  if (all_known && summary.runs == 1) return "in the only run";
  if (all_known) return fmt::format("in all {} runs", summary.runs);
  const double share = 1 - share_at_most(found, 0, summary.confidence_of_bound());
  return fmt::format("in ≥ {} of runs ({:g} % confidence)", percent_at_least(share, 1),
                     100 * summary.confidence);
}

std::string accuracy_lines(const Summary& summary) {
  std::string text;
  const Accuracy& found = *summary.accuracy;
  for (std::size_t i = 0; i < found.outputs.size(); ++i) {
    const auto& [name, runs, largest, rms] = found.outputs[i];
    const double sampling = summary.outputs[i].mean_error, share = 100 * rms / sampling;
    text += fmt::format(
        "{}{:<6}{}{}{}{}\n", in_column("  " + name, 38), parse_output_name(name).unit,
        right_aligned(in_two_digits(largest), 14), right_aligned(in_two_digits(rms), 14),
        right_aligned(in_two_digits(sampling), 18),
        right_aligned(std::isfinite(share) ? fmt::format("{:.1g} %", share) : "–", 10));
  }
  return text;
}

/// The largest error, and the runs that it does not hold for.
std::string accuracy_line(const Summary& summary) {
  const Accuracy& found = *summary.accuracy;
  if (found.runs == 0) return fmt::format("unknown: {} runs without a reference", found.unreached);
  std::string line = "integration errors " + errors_text(summary) + ' ' + errors_where(summary);
  const auto add = [&](std::size_t runs, const char* one, const char* many) {
    if (runs > 0)
      line += fmt::format("; {} of {} repeated {}", runs, found.runs, runs == 1 ? one : many);
  };
  add(found.moved.size(), "moves by more than 1 %", "move by more than 1 %");
  add(found.in_doubt.size(), "ends otherwise", "end otherwise");
  add(static_cast<std::size_t>(found.unreached), "could not be finished", "could not be finished");
  return line;
}

/// The line of the case with the largest error; empty if no case has repeated runs.
std::string worst_accuracy(CompactCases cases) {
  const CaseSummary* worst = nullptr;
  double largest = -1;
  for (const CaseSummary& each : cases) {
    if (!each.summary.accuracy) continue;
    const double share = largest_errors(each.summary).of_standard_error;
    if (worst && !(share > largest)) continue;
    worst = &each, largest = std::isnan(share) ? -1 : share;
  }
  if (!worst) return "";
  return "\nACCURACY  " + wrapped(worst->name + ": " + accuracy_line(worst->summary), 10) + '\n';
}

/// How the errors were measured, and for which share of all runs they hold.
std::string accuracy_note(const Summary& summary) {
  const Accuracy& found = *summary.accuracy;
  const auto at_most = [&](std::size_t runs) {
    return percent_at_most(share_at_most(found, runs, summary.confidence_of_bound()), 2);
  };
  std::string note = fmt::format(
      "{} of {}, drawn at random, repeated by {} at rtol {:g} (campaign: {} at {:g}); ratio is RMS "
      "error to standard error of the mean. At most {} of all runs have an error beyond the "
      "largest, and at most {} an output that moves by more than 1 % ({:g} % confidence). Runs "
      "that move so: {}. Runs whose status or latch order differs: {}.",
      found.runs, counted(summary.runs, "run", "runs"), found.reference_method,
      found.reference_rtol, found.method, found.rtol, at_most(0), at_most(found.moved.size()),
      100 * summary.confidence,
      found.moved.empty() ? "none" : fmt::format("{}", fmt::join(found.moved, ", ")),
      found.in_doubt.empty() ? "none" : fmt::format("{}", fmt::join(found.in_doubt, ", ")));
  if (found.unreached > 0)
    note += fmt::format(" The reference could not finish {} more.", found.unreached);
  return note;
}

} // namespace

std::string accuracy_text(const Summary& summary, bool all) {
  if (!summary.accuracy) return "";
  const bool in_full = all && summary.accuracy->runs > 0;
  if (!in_full) return "\nACCURACY  " + wrapped(accuracy_line(summary), 10) + '\n';
  return fmt::format("\n{:<38}{:<6}{:>14}{:>14}{:>18}{:>10}\n", "ACCURACY of the integration",
                     "unit", "largest error", "RMS error", "std error of mean", "ratio") +
         accuracy_lines(summary) + "  " + wrapped(accuracy_note(summary), 2) + '\n';
}

bool is_quiet(const OutputSummary& output) {
  const Moments& found = output.moments;
  if (parse_output_name(output.name).quantity == "overtravel")
    return found.count == 0 || found.max <= most_overtravel;
  return found.count == 0 || (found.min == found.max && found.count > 1 && output.missing == 0);
}

std::string quiet_outputs(std::span<const CaseSummary> cases) {
  std::vector<std::pair<std::string, Reach>> quiet;
  for (std::size_t i = 0; i < cases.front().summary.outputs.size(); ++i) {
    if (!is_quiet_in_all(cases, i)) continue;
    Reach reach;
    for (const CaseSummary& each : cases) reach.add(each.summary.outputs[i]);
    quiet.emplace_back(cases.front().summary.outputs[i].name, reach);
  }
  return described_quiet(quiet);
}

std::string quiet_outputs(const std::vector<OutputSummary>& outputs) {
  std::vector<std::pair<std::string, Reach>> quiet;
  for (const OutputSummary& output : outputs)
    if (is_quiet(output)) quiet.push_back({output.name, Reach()}), quiet.back().second.add(output);
  return described_quiet(quiet);
}

namespace {

/// @param names of the outputs that some run lacks, by where those runs rank
std::string described_ranks(const std::map<MissingRank, std::vector<std::string>>& names) {
  if (names.empty()) return "";
  const auto in = [&](MissingRank end) {
    const auto found = names.find(end);
    return found == names.end() ? "" : fmt::format(" in {}", fmt::join(found->second, ", "));
  };
  const std::string below = in(MissingRank::below), either = in(MissingRank::either);
  std::string text = "Runs without a value rank";
  if (names.contains(MissingRank::above) || !either.empty())
    text += fmt::format(" {}{}", words_of(MissingRank::above), below.empty() ? "" : ";");
  if (!below.empty()) text += fmt::format(" {}{}", words_of(MissingRank::below), below);
  if (!either.empty())
    text += fmt::format(";{} bounds hold for both ends, which requirements limit", either);
  return text;
}

} // namespace

std::string missing_ranks(std::span<const CaseSummary> cases) {
  std::map<MissingRank, std::vector<std::string>> names;
  for (std::size_t i = 0; i < cases.front().summary.outputs.size(); ++i) {
    const OutputSummary& output = cases.front().summary.outputs[i];
    if (std::ranges::any_of(
            cases, [i](const CaseSummary& each) { return each.summary.outputs[i].missing > 0; }))
      names[output.missing_end].push_back(output.name);
  }
  return described_ranks(names);
}

std::string missing_ranks(const std::vector<OutputSummary>& outputs) {
  std::map<MissingRank, std::vector<std::string>> names;
  for (const OutputSummary& output : outputs)
    if (output.missing > 0) names[output.missing_end].push_back(output.name);
  return described_ranks(names);
}

std::string compact_cases_table(const std::vector<CaseSummary>& cases, std::string_view title,
                                std::string_view folder) {
  std::string text = std::string(title) + '\n';
  for (std::size_t first = 0; first < cases.size(); first += most_cases) {
    const auto block =
        CompactCases(cases).subspan(first, std::min(most_cases, cases.size() - first));
    text += compact_outcomes(block) + compact_outputs(cases, block) + compact_requirements(block);
  }
  if (const std::string quiet = quiet_outputs(cases); !quiet.empty()) text += '\n' + quiet;
  if (const std::string ranks = missing_ranks(cases); !ranks.empty())
    text += "\n  " +
            wrapped("Quantiles are over all runs. " + ranks +
                        ". –: too few runs have a value; --all has the quantile among these.",
                    2) +
            '\n';
  text += stopping_lines(cases) + worst_accuracy(cases) + warning_lines(warnings(cases));
  for (const CaseSummary& each : cases)
    if (each.partial) text += fmt::format("\n{} lacks runs of the campaign\n", each.name);
  return text + "\nFILES  " +
         wrapped(
             fmt::format("{}: cases.json, and a results folder for each case; --all prints every "
                         "statistic",
                         folder),
             7) +
         '\n';
}

} // namespace wingspread
