/// The runs that the page shows in motion: MOTION of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// A run to show, and the reason.
struct ChosenRun {
  std::string label, why;
  long run = 0; ///< counted from 0
};

/// The deployed run with the median deployment time, the worst run of each requirement, and one run of each other
/// status. Without requirements, the runs with the largest peaks and the slowest deployment replace the worst runs. No
/// run appears twice.
[[nodiscard]] std::vector<ChosenRun> chosen_runs(const PageSource& source, std::size_t most = 11);

/// The nominal run, then the chosen runs replayed; empty if the set's runs cannot be replayed (PageSource::replayable).
/// @param threads as of thread_count (thread_pool.hpp)
[[nodiscard]] Json motions_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
