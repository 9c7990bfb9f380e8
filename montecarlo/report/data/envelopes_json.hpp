/// Angles and rates of many runs at once: ENVELOPES of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

/// Quantiles over time of runs that are spread evenly through the campaign and made again, but for those that failed or
/// had an unphysical draw. A run that has ended stays where it is, at rest. The times go from 0 to a little behind the
/// last latch of any of them that deployed. Null where no run can be made again.
/// @param threads as of thread_count (team.hpp); the bytes do not depend on them
[[nodiscard]] Json envelopes_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
