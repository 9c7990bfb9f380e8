#include "montecarlo/results/summary/broken_runs.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace wingspread {
namespace {

/// Number of hinges in a latch order: "root>mid" has two.
long hinges_in(std::string_view order) {
  return order.empty() ? 0 : 1 + std::ranges::count(order, '>');
}

/// Keeps the `most` elements that `before` ranks first. Ties go to the lowest run, because runs come in order.
template <class Element, class Before>
void keep_first(std::vector<Element>& kept, const Element& added, std::size_t most, Before before) {
  if (kept.size() == most && (most == 0 || !before(added, kept.back()))) return;
  kept.insert(std::upper_bound(kept.begin(), kept.end(), added, before), added);
  if (kept.size() > most) kept.pop_back();
}

template <class IsCounted>
std::vector<LatchedRun> fewest_latched_of(const Results& results, std::size_t most,
                                          IsCounted is_counted) {
  std::vector<LatchedRun> fewest;
  for (std::size_t row = 0; row < results.size(); ++row)
    if (is_counted(results.status[row]))
      keep_first(fewest, LatchedRun{results.runs[row], hinges_in(results.latch_order[row])}, most,
                 [](const LatchedRun& a, const LatchedRun& b) { return a.latched < b.latched; });
  return fewest;
}

/// Counts the deployed runs without a value, with a cut peak, and beyond the limit.
void add_deployed(const Requirement& requirement, const Results& results, const Column& column,
                  std::size_t most, BrokenRuns& broken) {
  const double sign = sign_of(requirement), limit = limit_of(requirement);
  const PeakKind peak = peak_kind(column.name);
  const auto worse = [&](const JudgedRun& a, const JudgedRun& b) {
    return sign * a.value > sign * b.value;
  };
  for (std::size_t row = 0; row < results.size(); ++row) {
    if (results.status[row] != Status::deployed) continue;
    const double value = requirement.absolute ? std::abs(column.values[row]) : column.values[row];
    const JudgedRun each{results.runs[row], value};
    if (std::isnan(value)) {
      ++broken.without_value;
      continue;
    }
    if (!broken.worst || worse(each, *broken.worst)) broken.worst = each;
    if (results.is_cut(row, peak)) { // at a `min` already it only rises further (verdict.hpp)
      broken.cut += requirement.max || sign * value > limit ? 1 : 0;
    } else if (sign * value > limit) {
      ++broken.beyond;
      keep_first(broken.beyond_runs, each, most, worse);
    }
  }
}

} // namespace

BrokenRuns broken_runs(const Verdict& verdict, const Results& results, std::size_t most) {
  BrokenRuns broken;
  const auto failed = [](Status status) { return status != Status::deployed; };
  broken.not_deployed = std::ranges::count_if(results.status, failed);
  broken.not_deployed_runs = fewest_latched_of(results, most, failed);
  const auto column = std::ranges::find(results.outputs, verdict.requirement.output, &Column::name);
  if (column != results.outputs.end())
    add_deployed(verdict.requirement, results, *column, most, broken);
  else // a static margin: its column is not kept
    broken.beyond = verdict.failures() - broken.not_deployed;
  results.release();
  return broken;
}

std::vector<LatchedRun> fewest_latched(const Results& results, Status status, std::size_t most) {
  return fewest_latched_of(results, most, [&](Status each) { return each == status; });
}

} // namespace wingspread
