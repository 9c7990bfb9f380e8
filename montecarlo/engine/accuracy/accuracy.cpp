#include "montecarlo/engine/accuracy/accuracy.hpp"

#include "montecarlo/engine/accuracy/drawn_runs.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

namespace wingspread {
namespace {

/// Tolerance of a reference, as a share of the campaign's. The reference's own error is then about a hundredth of the
/// error that it measures, and dopri5 takes 100^{1/5} = 2.5 times the steps.
constexpr double tighter = 1e-2;
/// At a smaller rtol round-off dominates the error estimate of a step.
constexpr double tightest_explicit = 1e-13;
constexpr double tightest_implicit = 1e-12; ///< at a smaller rtol seulex takes ten times the steps
/// Largest rtol of a reference. Heuristic: with a larger one the reference of a loose campaign is loose itself.
constexpr double loosest = 1e-8;
constexpr long times_the_steps = 100, least_steps = 20'000;
/// Runs that show whether a reference is usable. They fill the eight AVX-512 lanes of two threads, so they take hardly
/// longer than one.
constexpr std::size_t probed = 16;

/// Rounds to three decimal digits, so that 1e-9 · 1e-2 is reported as 1e-11 and not as 1.0000000000000001e-11.
double in_three_digits(double x) {
  std::array<char, 32> text{};
  char* const first = text.data();
  const auto written =
      std::to_chars(first, first + text.size(), x, std::chars_format::scientific, 2);
  std::from_chars(first, written.ptr, x);
  return x;
}

/// Sets rtol and scales atol with it.
Integration with_tolerance(Integration integration, std::string method, double rtol) {
  integration.method = std::move(method);
  integration.atol *= rtol / integration.rtol;
  integration.rtol = rtol;
  return integration;
}

/// Whether two rows have the same status and latch order, and the same outputs happened. Only then is the difference of
/// their numbers an integration error.
bool agree(const ResultRow& a, const ResultRow& b) {
  const auto happened_alike = [](double x, double y) { return std::isnan(x) == std::isnan(y); };
  return a.status == b.status && a.latch_order == b.latch_order &&
         std::ranges::equal(a.outputs, b.outputs, happened_alike);
}

OutputAccuracy error_of(const std::string& name, std::size_t column,
                        std::span<const std::pair<const ResultRow*, const ResultRow*>> pairs) {
  OutputAccuracy found{name, 0, undefined, undefined};
  std::vector<double> errors;
  for (const auto& [row, reference] : pairs)
    if (!std::isnan(row->outputs[column]))
      errors.push_back(std::abs(row->outputs[column] - reference->outputs[column]));
  if (errors.empty()) return found;
  found.runs = std::ssize(errors);
  found.largest = *std::ranges::max_element(errors);
  Sum squares; // of error/largest, because the square of an error of 1e-170 underflows to 0
  for (const double error : errors)
    if (found.largest > 0) squares.add(error / found.largest * (error / found.largest));
  found.rms = found.largest * std::sqrt(squares.value() / static_cast<double>(found.runs));
  return found;
}

/// The larger step limit of the references of the first and the middle run.
long steps_allowed(const Campaign& campaign, std::span<const long> runs) {
  const RunPlan plan(campaign);
  Runner runner(plan);
  const auto allowed = [&](std::size_t i) {
    return steps_of_reference(runner.replay(runs[i], {}).outcome.work.steps);
  };
  return std::max(allowed(0), allowed(runs.size() / 2));
}

/// Notes the outputs that moved and the runs in which they did. Differences up to unresolved(), and up to rtol times
/// the output's largest value, do not count.
void note_moved(const ResultNames& names,
                std::span<const std::pair<const ResultRow*, const ResultRow*>> pairs,
                const Integration& integration, Accuracy& accuracy) {
  std::vector<bool> has_moved(pairs.size(), false);
  for (std::size_t column = 0; column < names.outputs.size(); ++column) {
    double largest = 0;
    for (const auto& [row, reference] : pairs)
      largest = std::fmax(largest, std::abs(reference->outputs[column]));
    const double least =
        std::max(unresolved(names.outputs[column], integration), integration.rtol * largest);
    bool any = false;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (moved(pairs[i].first->outputs[column], pairs[i].second->outputs[column], least))
        any = has_moved[i] = true;
    if (any) accuracy.moved_outputs.push_back(names.outputs[column]);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (has_moved[i]) accuracy.moved.push_back(pairs[i].first->run);
}

} // namespace

bool moved(double value, double reference, double unresolved) {
  const double difference = std::abs(value - reference);
  return difference > moved_share * std::max(std::abs(value), std::abs(reference)) &&
         difference > unresolved;
}

double unresolved(const std::string& output, const Integration& integration) {
  const std::string_view unit = parse_output_name(output).unit;
  return unit == "rad" || unit == "rad/s" ? integration.atol : 0;
}

double share_at_most(const Accuracy& accuracy, std::size_t found, double confidence) {
  const auto unknown = static_cast<long>(accuracy.in_doubt.size()) + accuracy.unreached;
  return clopper_pearson_upper(static_cast<long>(found) + unknown,
                               accuracy.runs + accuracy.unreached, confidence);
}

// 100 times the steps of the run, at least 20,000. Heuristic: at a tolerance 100 times tighter, dopri5 takes about 3
// times the steps of a non-stiff run, and far more than 100 times those of a stiff one. A smaller factor would reject
// usable references, a larger one wastes time on stiff runs.
long steps_of_reference(long steps) { return std::max(least_steps, times_the_steps * steps); }

std::vector<Integration> references_of(const Integration& integration) {
  const double rtol = integration.rtol;
  const auto at = [&](const char* method, double tightest) {
    const double wanted = in_three_digits(std::clamp(rtol * tighter, tightest, loosest));
    return with_tolerance(integration, method, std::min(wanted, rtol));
  };
  const bool is_dopri5 = integration.method == "dopri5", is_seulex = integration.method == "seulex";
  return {at(is_dopri5 ? "dop853" : "dopri5", tightest_explicit),
          at(is_seulex ? "auto" : "seulex", tightest_implicit)};
}

Accuracy compare_rows(const ResultNames& names, std::span<const ResultRow> rows,
                      std::span<const ResultRow> reference, const Integration& integration) {
  Accuracy accuracy;
  std::vector<std::pair<const ResultRow*, const ResultRow*>> pairs;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (reference[i].status == Status::failed) {
      ++accuracy.unreached;
      continue;
    }
    ++accuracy.runs;
    if (agree(rows[i], reference[i]))
      pairs.emplace_back(&rows[i], &reference[i]);
    else
      accuracy.in_doubt.push_back(rows[i].run);
  }
  for (std::size_t column = 0; column < names.outputs.size(); ++column)
    accuracy.outputs.push_back(error_of(names.outputs[column], column, pairs));
  note_moved(names, pairs, integration, accuracy);
  return accuracy;
}

std::vector<ResultRow> repeat_runs(const Campaign& campaign, const Integration& integration,
                                   std::span<const long> runs, const ThreadPool& pool) {
  Campaign again = campaign;
  again.integration = integration;
  const RunPlan plan(again);
  std::vector<ResultRow> rows(runs.size());
  std::atomic<std::size_t> claimed = 0;
  const auto next = [&]() -> std::optional<long> {
    const std::size_t i = claimed++;
    return i < runs.size() ? std::optional(runs[i]) : std::nullopt;
  };
  const auto keep = [&](ResultRow&& row) {
    const auto place = std::ranges::lower_bound(runs, row.run) - runs.begin();
    rows[static_cast<std::size_t>(place)] = std::move(row);
  };
  run_on_threads(
      threads_for(pool.threads, runs.size()),
      [&] { (void)Runner(plan).run_all(pool.set, next, keep); }, [&] { claimed = runs.size(); });
  return rows;
}

Accuracy compare_with_reference(const Campaign& campaign, std::span<const ResultRow> rows,
                                const ThreadPool& pool) {
  const ResultNames names = RunPlan(campaign).names();
  std::vector<long> runs;
  std::ranges::transform(rows, std::back_inserter(runs), &ResultRow::run);
  const long steps = steps_allowed(campaign, runs);
  const std::size_t first = std::min(runs.size(), probed);
  Integration best;
  std::vector<ResultRow> made; // by the best reference
  long finished = -1;          // of them
  for (Integration reference : references_of(campaign.integration)) {
    reference.max_steps = steps;
    std::vector<ResultRow> probe =
        repeat_runs(campaign, reference, std::span(runs).first(first), pool);
    const bool finishes_first = probe.front().status != Status::failed;
    const long count =
        std::ssize(probe) - std::ranges::count(probe, Status::failed, &ResultRow::status);
    if (finishes_first || count > finished)
      best = reference, made = std::move(probe), finished = count;
    if (finishes_first) break;
  }
  if (finished > 0)
    std::ranges::move(repeat_runs(campaign, best, std::span(runs).subspan(first), pool),
                      std::back_inserter(made));
  Accuracy accuracy = compare_rows(names, rows.first(made.size()), made, campaign.integration);
  accuracy.reference_method = best.method;
  accuracy.reference_rtol = best.rtol;
  accuracy.method = campaign.integration.method;
  accuracy.rtol = campaign.integration.rtol;
  return accuracy;
}

std::size_t count_repeated(const Campaign& campaign, std::size_t runs) {
  if (const auto& asked = campaign.statistics.accuracy_runs)
    return std::min(static_cast<std::size_t>(*asked), runs);
  constexpr std::size_t fewest = 10, most = 100;
  return std::min(std::clamp((runs + 99) / 100, fewest, most), (runs + 9) / 10);
}

std::optional<Accuracy> measure_accuracy(const Campaign& campaign, const Results& results,
                                         const ThreadPool& pool) {
  const auto began = std::chrono::steady_clock::now();
  std::vector<ResultRow> rows;
  const std::size_t count = count_repeated(campaign, results.size());
  for (const std::size_t row : drawn_rows(results, campaign.sampling.seed, count))
    rows.push_back(results.row(row));
  results.release();
  if (rows.empty()) return std::nullopt;
  Accuracy accuracy = compare_with_reference(campaign, rows, pool);
  accuracy.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return accuracy;
}

} // namespace wingspread
