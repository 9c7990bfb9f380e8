/// Envelopes of angles and rates over many runs: ENVELOPES of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

/// Quantiles, over time, of runs that are spread evenly through the campaign and repeated here. Failed and invalid runs
/// are left out. A run that did not deploy keeps its angles after its end, with zero rates. Times go from 0 to 8 %
/// after the last latch of the deployed runs. Null if no run can be replayed.
/// @param threads as of thread_count (thread_pool.hpp); the bytes do not depend on them
[[nodiscard]] Json envelopes_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
