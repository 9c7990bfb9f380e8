/// A set of runs with all that the page says of it: SET of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

/// @param threads as of thread_count (team.hpp); the bytes do not depend on them
[[nodiscard]] Json set_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
