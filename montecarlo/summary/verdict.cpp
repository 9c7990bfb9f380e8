#include "montecarlo/summary/verdict.hpp"

#include "montecarlo/statistics/binomial_bounds.hpp"
#include "montecarlo/statistics/bonferroni.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace wingspread {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How bad a run is: its value seen from the limit's side, so that larger is worse; the limit in
/// the same way. Of "deployed", 0 where it did.
struct Badness {
  long run;
  double value;
};

double sign_of(const Requirement& requirement) { return requirement.min ? -1 : 1; }

double limit_of(const Requirement& requirement) {
  if (requirement.max) return *requirement.max;
  return requirement.min ? -*requirement.min : 0;
}

const Column* column_of(const Results& results, const Requirement& requirement) {
  const auto found = std::ranges::find(results.outputs, requirement.output, &Column::name);
  assert(found != results.outputs.end() || requirement.output == deployed_output);
  return found == results.outputs.end() ? nullptr : &*found;
}

/// The value, where the run deployed and has one; else infinite.
double value_or_infinite(const Results& results, std::size_t row, double value) {
  return results.status[row] == Status::deployed && !std::isnan(value) ? value : infinity;
}

/// The numbers of the runs that break it, the worst first; those that are equally bad by their number.
Spilled<long> breaking(const Requirement& requirement, const Results& results,
                       const Column* column) {
  const double sign = sign_of(requirement), limit = limit_of(requirement);
  Spilled<long> broken; // first those that are worse than any number, as they come: by their number
  std::vector<Badness> beyond;
  for (std::size_t row = 0; row < results.size(); ++row) {
    const double value = value_or_infinite(results, row, column ? sign * column->values[row] : 0);
    if (value == infinity)
      broken.push_back(results.runs[row]);
    else if (value > limit)
      beyond.push_back({results.runs[row], value});
  }
  results.release();
  std::ranges::sort(beyond, [](const Badness& a, const Badness& b) {
    return a.value != b.value ? a.value > b.value : a.run < b.run;
  });
  for (const auto& [run, value] : beyond) broken.push_back(run);
  return broken;
}

Decision decide(const Verdict& verdict) {
  if (verdict.allowed)
    return std::ssize(verdict.broken) <= *verdict.allowed ? Decision::pass : Decision::fail;
  return verdict.disproved ? Decision::fail : Decision::undecided;
}

/// Fills in what is said of the output's own values.
void add_values(const RankedOutput& output, Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  const auto value_at = [&](long place) -> std::optional<double> { // the worst has place 0
    const auto index = static_cast<std::size_t>(place);
    const auto values = requirement.min ? output.worst_below() : output.worst_above();
    const double value = values[requirement.min ? index : values.size() - 1 - index];
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  };
  if (verdict.runs > 0)
    verdict.observed =
        value_at(verdict.runs - quantile_rank(verdict.runs, requirement.probability));
  if (verdict.allowed) verdict.guaranteed = value_at(*verdict.allowed);
  if (verdict.guaranteed)
    verdict.margin = limit_of(requirement) - sign_of(requirement) * *verdict.guaranteed;
}

/// @param ranks the output's; null for "deployed"
Verdict judge_one(const Requirement& requirement, const Results& results, const Column* column,
                  const RankedOutput* ranks, long looks) {
  Verdict verdict;
  verdict.requirement = requirement;
  verdict.runs = static_cast<long>(results.size());
  verdict.confidence = at_each_of(requirement.confidence, looks);
  verdict.broken = breaking(requirement, results, column);
  const double p = requirement.probability, c = verdict.confidence;
  const long n = verdict.runs, broken = std::ssize(verdict.broken);
  verdict.allowed = allowed_failures(n, p, c);
  verdict.least_runs = runs_to_show(p, c, 0);
  verdict.disproved = is_disproved(n, p, c, broken);
  verdict.share = static_cast<double>(n - broken) / static_cast<double>(n);
  verdict.guaranteed_share = clopper_pearson_lower(n - broken, n, c);
  verdict.decision = decide(verdict);
  if (ranks)
    add_values(*ranks, verdict);
  else if (verdict.allowed)
    verdict.margin = verdict.guaranteed_share - p;
  return verdict;
}

} // namespace

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

RankedOutput::RankedOutput(const Results& results, const Column& output) {
  const std::size_t runs = results.size();
  values_.reserve(runs);
  for (std::size_t row = 0; row < runs; ++row)
    if (const double value = output.values[row]; value_or_infinite(results, row, value) != infinity)
      values_.push_back(value);
  results.release();
  std::ranges::sort(values_);
  worse_ = runs - values_.size();
  if (worse_ == 0) return;
  values_.insert(values_.begin(), worse_, -infinity);
  values_.insert(values_.end(), worse_, infinity);
}

Verdict judge(const Requirement& requirement, const Results& results, long looks) {
  return std::move(judge_all({&requirement, 1}, results, looks).front());
}

std::vector<Verdict> judge_all(std::span<const Requirement> requirements, const Results& results,
                               long looks) {
  std::vector<Verdict> verdicts(requirements.size());
  std::vector<bool> judged(requirements.size(), false);
  for (std::size_t first = 0; first < requirements.size(); ++first) {
    if (judged[first]) continue;
    const Column* column = column_of(results, requirements[first]);
    std::optional<RankedOutput> ranks;
    if (column) ranks.emplace(results, *column);
    for (std::size_t k = first; k < requirements.size(); ++k) {
      if (requirements[k].output != requirements[first].output) continue;
      verdicts[k] = judge_one(requirements[k], results, column, ranks ? &*ranks : nullptr, looks);
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
  for (const Verdict& verdict : verdicts) confidences.push_back(verdict.requirement.confidence);
  return joint_confidence(confidences);
}

std::string evidence(const Verdict& verdict) {
  const long broken = std::ssize(verdict.broken);
  const std::string found =
      fmt::format("{} of {} {} {} it", broken, verdict.runs, verdict.runs == 1 ? "run" : "runs",
                  broken == 1 ? "breaks" : "break");
  if (verdict.allowed) {
    const bool open = verdict.decision == Decision::fail && !verdict.disproved;
    return fmt::format("{}, and {} may{}", found, *verdict.allowed,
                       open ? ": not shown, and not disproved either" : "");
  }
  if (verdict.disproved) return found + ": disproved";
  const std::string least = verdict.least_runs
                                ? fmt::format("it takes {}", *verdict.least_runs)
                                : fmt::format("it takes more than {}", most_runs_sized);
  return fmt::format("{} runs cannot show it, even if none breaks it: {} ({})", verdict.runs, least,
                     found);
}

std::string replay_command(std::string_view folder, long run) {
  return fmt::format("wingspread replay {} --run {}", folder, run);
}

Bounds output_limits(const RankedOutput& output, const ToleranceLimitSpec& spec, long looks) {
  return tolerance_limits(spec.side == Side::lower ? output.worst_below() : output.worst_above(),
                          spec.side, spec.probability, at_each_of(spec.confidence, looks));
}

} // namespace wingspread
