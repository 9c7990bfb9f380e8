#include "montecarlo/summary/verdict.hpp"

#include "montecarlo/statistics/binomial_bounds.hpp"
#include "montecarlo/statistics/bonferroni.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

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

/// Of every run, the worst first; those that are equally bad by their number.
std::vector<Badness> rank(const Requirement& requirement, const Results& results) {
  const Column* column = column_of(results, requirement);
  const double sign = sign_of(requirement);
  std::vector<Badness> ranked;
  ranked.reserve(results.size());
  for (std::size_t row = 0; row < results.size(); ++row)
    ranked.push_back({results.runs[row],
                      value_or_infinite(results, row, column ? sign * column->values[row] : 0)});
  results.release();
  std::ranges::sort(ranked, [](const Badness& a, const Badness& b) {
    return a.value != b.value ? a.value > b.value : a.run < b.run;
  });
  return ranked;
}

Decision decide(const Verdict& verdict) {
  if (verdict.allowed)
    return std::ssize(verdict.broken) <= *verdict.allowed ? Decision::pass : Decision::fail;
  return verdict.disproved ? Decision::fail : Decision::undecided;
}

/// Fills in what is said of the output's own values.
void add_values(const std::vector<Badness>& ranked, Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  const auto value_at = [&](long index) -> std::optional<double> {
    const double value = ranked[static_cast<std::size_t>(index)].value;
    return std::isfinite(value) ? std::optional(sign_of(requirement) * value) : std::nullopt;
  };
  if (requirement.output == deployed_output) {
    if (verdict.allowed) verdict.margin = verdict.guaranteed_share - requirement.probability;
    return;
  }
  if (verdict.runs > 0)
    verdict.observed =
        value_at(verdict.runs - quantile_rank(verdict.runs, requirement.probability));
  if (verdict.allowed) verdict.guaranteed = value_at(*verdict.allowed);
  if (verdict.guaranteed)
    verdict.margin = limit_of(requirement) - sign_of(requirement) * *verdict.guaranteed;
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

Verdict judge(const Requirement& requirement, const Results& results, long looks) {
  const std::vector<Badness> ranked = rank(requirement, results);
  Verdict verdict;
  verdict.requirement = requirement;
  verdict.runs = std::ssize(ranked);
  verdict.confidence = at_each_of(requirement.confidence, looks);
  const double p = requirement.probability, c = verdict.confidence;
  for (const auto& [run, value] : ranked)
    if (value > limit_of(requirement)) verdict.broken.push_back(run);
  const long n = verdict.runs, broken = std::ssize(verdict.broken);
  verdict.allowed = allowed_failures(n, p, c);
  verdict.least_runs = runs_to_show(p, c, 0);
  verdict.disproved = is_disproved(n, p, c, broken);
  verdict.share = static_cast<double>(n - broken) / static_cast<double>(n);
  verdict.guaranteed_share = clopper_pearson_lower(n - broken, n, c);
  verdict.decision = decide(verdict);
  add_values(ranked, verdict);
  return verdict;
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

Bounds output_limits(const Results& results, const Column& output, const ToleranceLimitSpec& spec,
                     long looks) {
  const double sign = spec.side == Side::lower ? -1 : 1;
  std::vector<double> values;
  values.reserve(results.size());
  for (std::size_t row = 0; row < results.size(); ++row)
    values.push_back(sign * value_or_infinite(results, row, sign * output.values[row]));
  results.release();
  std::ranges::sort(values);
  return tolerance_limits(values, spec.side, spec.probability, at_each_of(spec.confidence, looks));
}

} // namespace wingspread
