#include "montecarlo/results/summary/verdict.hpp"

#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

namespace wingspread {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Values of this magnitude or more are treated as infinite: least_margin() returns it if nothing resists.
constexpr double no_number = std::numeric_limits<double>::max();

/// A run and its value times sign_of(): larger is worse.
struct BreakingRun {
  long run;
  double value;
};

const Column* column_of(const Results& results, std::span<const Column> besides,
                        const Requirement& requirement) {
  for (const std::span<const Column> columns : {std::span(results.outputs), besides})
    if (const auto found = std::ranges::find(columns, requirement.output, &Column::name);
        found != columns.end())
      return &*found;
  if (requirement.output != deployed_output)
    throw std::logic_error("a requirement on an output without a column: " + requirement.output);
  return nullptr;
}

/// How an output's values are compared with a limit.
struct HowJudged {
  bool absolute = false;
  PeakKind peak = PeakKind::none; ///< of which a value cut by t_end is read as infinite,
  bool from_below = false;        ///< but not here: the peak is at least what it had come to
};

HowJudged how_judged(const Column* column, bool absolute, bool from_below) {
  return {absolute, column ? peak_kind(column->name) : PeakKind::none, from_below};
}

/// The value if the run deployed and the value counts; else infinite.
double value_or_infinite(const Results& results, std::size_t row, double value,
                         const HowJudged& how) {
  if (results.status[row] != Status::deployed || std::isnan(value) ||
      (!how.from_below && results.is_cut(row, how.peak)))
    return infinity;
  return how.absolute ? std::abs(value) : value;
}

/// Counts a run that breaks the requirement among those of the earlier analyses.
void count_before(const InterimAnalyses& interim, long run, bool is_open, Verdict& verdict) {
  for (std::size_t k = 0; k < interim.before.size(); ++k) {
    if (run >= interim.before[k]) continue;
    ++verdict.failed_before[k];
    if (!is_open) ++verdict.surely_before[k];
  }
}

/// Sets the runs that break the requirement, the worst first, ties by run number; and why they do.
void add_breaking(const Results& results, const Column* column, const InterimAnalyses& interim,
                  Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  const double sign = sign_of(requirement), limit = limit_of(requirement);
  const HowJudged how = how_judged(column, requirement.absolute, requirement.min.has_value());
  Spilled<long>& broken = verdict.broken; // begins with the runs that are worse than any number
  std::vector<BreakingRun> beyond;
  for (std::size_t row = 0; row < results.size(); ++row) {
    const double seen = column ? column->values[row] : 0;
    const double value = value_or_infinite(results, row, seen, how);
    if (value == infinity)
      broken.push_back(results.runs[row]);
    else if (sign * value > limit)
      beyond.push_back({results.runs[row], sign * value});
    else
      continue;
    const bool cut = results.status[row] == Status::deployed && results.is_cut(row, how.peak);
    if (column && (cut || value == infinity)) ++(cut ? verdict.cut : verdict.absent);
    const bool is_open = cut && may_meet(requirement, seen);
    verdict.open += is_open;
    count_before(interim, results.runs[row], is_open, verdict);
  }
  results.release();
  std::ranges::sort(beyond, [](const BreakingRun& a, const BreakingRun& b) {
    return a.value != b.value ? a.value > b.value : a.run < b.run;
  });
  for (const auto& [run, value] : beyond) broken.push_back(run);
}

Decision decision_of(const Verdict& verdict) {
  if (verdict.allowed && verdict.failures() <= *verdict.allowed) return Decision::pass;
  if (rests_on_cut_peaks(verdict)) return Decision::undecided;
  if (verdict.allowed) return Decision::fail;
  return verdict.disproved ? Decision::fail : Decision::undecided;
}

/// Sets the values of the output.
void add_values(const RankedOutput& output, Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  const auto value_at = [&](long place) -> std::optional<double> { // place 0 is the worst run
    const auto index = static_cast<std::size_t>(place);
    const auto values = requirement.min ? output.worst_below() : output.worst_above();
    const double value = values[requirement.min ? index : values.size() - 1 - index];
    return std::abs(value) < no_number ? std::optional(value) : std::nullopt;
  };
  if (verdict.runs > 0)
    verdict.observed =
        value_at(verdict.runs - quantile_rank(verdict.runs, requirement.probability));
  if (verdict.allowed) verdict.guaranteed = value_at(*verdict.allowed);
  if (verdict.guaranteed)
    verdict.margin = limit_of(requirement) - sign_of(requirement) * *verdict.guaranteed;
  const auto numbers = output.numbers();
  if (!numbers.empty())
    verdict.beyond_zero = beyond_zero(numbers.front(), numbers.back(), requirement);
}

/// @param ranks      sorted values of the output; null for "deployed"
/// @param confidence at which the requirement would be judged in a single analysis
Verdict judge_one(const Requirement& requirement, const Results& results, const Column* column,
                  const RankedOutput* ranks, double confidence, const InterimAnalyses& interim) {
  Verdict verdict;
  verdict.requirement = requirement;
  verdict.runs = static_cast<long>(results.size());
  verdict.failed_before.assign(interim.before.size(), 0);
  verdict.surely_before = verdict.failed_before;
  add_breaking(results, column, interim, verdict);
  decide(confidence, interim, verdict);
  if (ranks)
    add_values(*ranks, verdict);
  else if (verdict.allowed)
    verdict.margin = verdict.guaranteed_share - requirement.probability;
  return verdict;
}

} // namespace

double sign_of(const Requirement& requirement) { return requirement.min ? -1 : 1; }

double limit_of(const Requirement& requirement) {
  if (requirement.max) return *requirement.max;
  return requirement.min ? -*requirement.min : 0;
}

bool may_meet(const Requirement& requirement, double cut_peak) {
  return requirement.min || !(cut_peak > limit_of(requirement));
}

bool rests_on_cut_peaks(const Verdict& verdict) {
  return verdict.allowed && verdict.failures() > *verdict.allowed &&
         verdict.failures() - verdict.open <= *verdict.allowed;
}

std::string_view to_string(Decision decision) {
  switch (decision) {
  case Decision::pass:
    return "pass";
  case Decision::fail:
    return "fail";
  case Decision::undecided:
    break;
  }
  return "undecided";
}

void decide(double confidence, const InterimAnalyses& interim, Verdict& verdict) {
  verdict.confidence_alone = confidence;
  const double p = verdict.requirement.probability;
  const long n = verdict.runs, broken = verdict.failures();
  const PassingRule rule = passing_rule(interim, n, p, confidence, verdict.failed_before);
  const double c = rule.confidence;
  verdict.confidence = c;
  verdict.interim = interim;
  verdict.joint = rule.joint;
  verdict.allowed = rule.allowed;
  if (!rule.joint || !rule.joint->allowed_alone) verdict.least_runs = runs_to_show(p, c, 0);
  verdict.disproved =
      is_disproved(interim, n, p, confidence, broken - verdict.open, verdict.surely_before);
  verdict.share = static_cast<double>(n - broken) / static_cast<double>(n);
  verdict.guaranteed_share = clopper_pearson_lower(n - broken, n, c);
  verdict.decision = decision_of(verdict);
}

std::optional<std::array<double, 2>> beyond_zero(double least, double largest,
                                                 const Requirement& requirement) {
  if (requirement.static_margin) return std::nullopt; // has no magnitude: below 0 it is not met
  const double limit = requirement.max ? *requirement.max : requirement.min.value_or(0);
  const bool apart = (limit > 0 && largest < 0) || (limit < 0 && least > 0);
  return apart ? std::optional(std::array{least, largest}) : std::nullopt;
}

RankedOutput::RankedOutput(const Results& results, const Column& output, bool absolute) {
  const std::size_t runs = results.size();
  const HowJudged from_above = how_judged(&output, absolute, false);
  const HowJudged from_below = how_judged(&output, absolute, true);
  std::vector<double> cut;
  values_.reserve(runs);
  for (std::size_t row = 0; row < runs; ++row) {
    const double value = value_or_infinite(results, row, output.values[row], from_above);
    const double least = value_or_infinite(results, row, output.values[row], from_below);
    if (value != infinity)
      values_.push_back(value);
    else if (least != infinity)
      cut.push_back(least);
  }
  results.release();
  sort_values(values_);
  worse_ = runs - values_.size();
  cut_ = cut.size();
  if (!cut.empty()) {
    below_.assign(worse_ - cut.size(), -infinity);
    below_.insert(below_.end(), values_.begin(), values_.end());
    below_.insert(below_.end(), cut.begin(), cut.end());
    sort_values(below_);
  }
  if (worse_ == 0) return;
  values_.insert(values_.begin(), worse_, -infinity);
  values_.insert(values_.end(), worse_, infinity);
}

Verdict judge(const Requirement& requirement, const Results& results,
              const InterimAnalyses& interim) {
  return std::move(judge_all({&requirement, 1}, results, interim).front());
}

std::vector<Verdict> judge_all(std::span<const Requirement> requirements, const Results& results,
                               const InterimAnalyses& interim, std::span<const Column> besides) {
  std::vector<Verdict> verdicts(requirements.size());
  std::vector<bool> judged(requirements.size(), false);
  for (std::size_t first = 0; first < requirements.size(); ++first) {
    if (judged[first]) continue;
    const Requirement& like = requirements[first];
    const Column* column = column_of(results, besides, like);
    std::optional<RankedOutput> ranks;
    if (column) ranks.emplace(results, *column, like.absolute);
    for (std::size_t k = first; k < requirements.size(); ++k) {
      const Requirement& own = requirements[k];
      if (own.output != like.output || own.absolute != like.absolute) continue;
      verdicts[k] = judge_one(own, results, column, ranks ? &*ranks : nullptr,
                              confidence_alone(requirements, own), interim);
      judged[k] = true;
    }
  }
  return verdicts;
}

bool is_decided(const Verdict& verdict) {
  return verdict.decision == Decision::pass || verdict.disproved;
}

double joint_confidence(std::span<const Verdict> verdicts) {
  std::vector<double> confidences;
  for (const Verdict& verdict : verdicts) confidences.push_back(verdict.confidence_alone);
  return joint_confidence(confidences);
}

std::vector<GroupVerdict> judge_groups(std::span<const Verdict> verdicts) {
  std::vector<GroupVerdict> groups;
  for (const Verdict& verdict : verdicts) {
    const auto& [name, confidence] =
        std::pair(verdict.requirement.group, verdict.requirement.confidence);
    if (name.empty()) continue;
    auto group = std::ranges::find(groups, name, &GroupVerdict::name);
    if (group == groups.end())
      group = groups.insert(group, {name, confidence, 0, 0, Decision::pass});
    ++group->members;
    group->passed += verdict.decision == Decision::pass ? 1 : 0;
    if (verdict.decision == Decision::fail) group->decision = Decision::fail;
    if (verdict.decision == Decision::undecided && group->decision == Decision::pass)
      group->decision = Decision::undecided;
  }
  return groups;
}

std::string joint_risk(const Verdict& verdict) {
  if (!verdict.joint) return "";
  const auto& [risk, risk_alone, allowed_alone] = *verdict.joint;
  return fmt::format(". This is analysis {} of the same draws, after {} runs: the risk of a wrong "
                     "pass at any of them is at most {:.3g} %, however the numbers of runs were "
                     "chosen; with these numbers it is {:.3g} % if each is judged alone ({} may "
                     "break it then)",
                     verdict.interim.count(), fmt::join(verdict.interim.before, ", "), 100 * risk,
                     100 * risk_alone, allowed_alone.value_or(0));
}

std::string evidence(const Verdict& verdict) {
  const long broken = verdict.failures();
  if (verdict.one_run)
    return fmt::format("nothing is dispersed: {} it. No probability is shown",
                       verdict.runs == 1
                           ? "the only run meets"
                           : fmt::format("all {} runs are the same and meet", verdict.runs));
  std::string found =
      fmt::format("{} of {} {} {} it", broken, verdict.runs, verdict.runs == 1 ? "run" : "runs",
                  broken == 1 ? "breaks" : "break");
  std::vector<std::string> causes;
  if (verdict.cut > 0)
    causes.push_back(fmt::format("{} of them because t_end cut {}{}", verdict.cut,
                                 verdict.cut == 1 ? "its peak" : "their peaks",
                                 verdict.requirement.min ? " below the limit" : ""));
  if (verdict.absent > 0)
    causes.push_back(fmt::format("{} of them because {}", verdict.absent,
                                 verdict.absent == 1 ? "it did not deploy or has no value"
                                                     : "they did not deploy or have no value"));
  if (verdict.of_part) return "not judged: a part of the campaign's runs. So far " + found;
  if (!causes.empty()) found += fmt::format(" ({})", fmt::join(causes, ", "));
  if (verdict.allowed) {
    const bool open = verdict.decision == Decision::fail && !verdict.disproved;
    return fmt::format(
        "{}; at most {} may{}{}", found, *verdict.allowed,
        rests_on_cut_peaks(verdict)
            ? fmt::format(". A cut peak may still rise {}. {}",
                          verdict.requirement.min ? "to the limit" : "and shows nothing",
                          advice_on_t_end(verdict.never_final))
        : open ? ": not shown, and not disproved either"
               : "",
        joint_risk(verdict));
  }
  if (verdict.disproved) return found + ": disproved";
  if (verdict.joint && verdict.joint->allowed_alone)
    return fmt::format("{} cannot show it, even if none breaks it, after the analyses of {} runs: "
                       "these have left too little of the risk. Add runs ({})",
                       counted(verdict.runs, "run", "runs"),
                       fmt::join(verdict.interim.before, ", "), found);
  const std::string least = verdict.least_runs
                                ? fmt::format("it takes {}", *verdict.least_runs)
                                : fmt::format("it takes more than {}", most_runs_sized);
  return fmt::format("{} cannot show it, even if none breaks it: {} ({})",
                     counted(verdict.runs, "run", "runs"), least, found);
}

namespace {

/// A value of the output in the unit of its limit, with as many digits as tell it from the limit.
std::string beside_limit(const Requirement& requirement, const std::optional<double>& value,
                         int sign) {
  if (!value) return "–";
  const double limit = requirement.max ? *requirement.max : requirement.min.value_or(0);
  return in_digits_beside(in_unit_of_limit(requirement, *value),
                          in_unit_of_limit(requirement, limit), sign);
}

} // namespace

std::string observed_text(const Verdict& verdict) {
  return verdict.requirement.output == deployed_output
             ? percent(verdict.share)
             : beside_limit(verdict.requirement, verdict.observed, 0);
}

std::string guaranteed_text(const Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  if (requirement.output != deployed_output)
    return beside_limit(requirement, verdict.guaranteed, requirement.min ? -1 : 1);
  constexpr int most = 12;
  const double share = verdict.guaranteed_share, required = requirement.probability;
  std::string text = percent_at_least(share);
  for (int decimals = 4; share >= required && decimals <= most; ++decimals) {
    if (std::stod(text) >= 100 * required * (1 - 1e-14)) break;
    text = percent_at_least(share, decimals);
  }
  return text;
}

std::string replay_command(std::string_view folder, long run) {
  return fmt::format("wingspread replay {} --run {}", shell_word(std::string(folder)), run);
}

Bounds output_limits(const RankedOutput& output, const ToleranceLimitSpec& spec,
                     const InterimAnalyses& interim) {
  return tolerance_limits(spec.side == Side::lower ? output.worst_below() : output.worst_above(),
                          spec.side, spec.probability,
                          interim.confidence_of_bound(spec.confidence));
}

} // namespace wingspread
