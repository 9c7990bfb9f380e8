/// The runs that are worth seeing, and what became of them: MOTION of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// A run of a set that the page shows, and why.
struct ChosenRun {
  std::string label, why;
  long run = 0; ///< counted from 0
};

/// The median run that deployed; for each requirement the run that stands worst; one run of each other status. Without
/// requirements the largest peaks and the slowest deployment stand for the worst. Each run once.
[[nodiscard]] std::vector<ChosenRun> chosen_runs(const PageSource& source, std::size_t most = 11);

/// The nominal run, then the chosen ones made again. None where they cannot be (PageSource::replayable).
/// @param threads as of thread_count (team.hpp)
[[nodiscard]] Json motions_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
