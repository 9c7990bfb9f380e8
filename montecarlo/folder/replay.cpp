#include "montecarlo/folder/replay.hpp"

#include "montecarlo/formats/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace wingspread {
namespace {

/// The same number, or both none.
bool same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::string shown(double value) { return std::isnan(value) ? "nothing" : csv_cell(value); }

} // namespace

std::vector<std::string> differences(const ResultNames& names, const ResultRow& recorded,
                                     const ResultRow& computed) {
  std::vector<std::string> lines;
  const auto differ = [&](std::string_view column, const std::string& there,
                          const std::string& here) {
    lines.push_back(fmt::format("run {}, column {}: recorded as {}, computed as {}", computed.run,
                                column, there, here));
  };
  const auto compare = [&](const std::vector<std::string>& columns,
                           const std::vector<double>& there, const std::vector<double>& here) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (!same(there[i], here[i])) differ(columns[i], shown(there[i]), shown(here[i]));
  };
  const auto compare_text = [&](const char* column, const std::string& there,
                                const std::string& here) {
    if (there != here) differ(column, '"' + there + '"', '"' + here + '"');
  };
  compare_text("status", to_string(recorded.status), to_string(computed.status));
  compare(names.draws, recorded.draws, computed.draws);
  compare(names.outputs, recorded.outputs, computed.outputs);
  compare_text("latch_order", recorded.latch_order, computed.latch_order);
  compare_text("reason", recorded.reason, computed.reason);
  return lines;
}

ReplayRequest::ReplayRequest(const StoredCampaign& stored, long run) : stored_(&stored), run_(run) {
  const long runs = stored.campaign.sampling.runs;
  if (run < 0 || run >= runs)
    throw SpecError({{stored.folder.string(), "", fmt::format("no run {}", run),
                      fmt::format("a run from 0 to {}", runs - 1)}});
  const Results results = read_stored_results(stored).results;
  const auto found = std::ranges::lower_bound(results.runs, run);
  if (found != results.runs.end() && *found == run)
    recorded_ = results.row(static_cast<std::size_t>(found - results.runs.begin()));
}

Replayed ReplayRequest::replay(const Observer& observer) const {
  const RunPlan plan(stored_->campaign);
  auto [outcome, row] = Runner(plan).replay(run_, observer);
  Replayed replayed{std::move(outcome), std::move(row), plan.names(), recorded_.has_value(), {}};
  if (recorded_) replayed.differences = differences(plan.names(), *recorded_, replayed.row);
  return replayed;
}

} // namespace wingspread
