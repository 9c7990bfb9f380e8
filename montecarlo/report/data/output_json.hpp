/// Every output of a set, as the page draws it: OUTPUT of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

/// Cost: each column sorted once and gone through five times; memory: 16 bytes a run for each thread.
/// @param threads as of thread_count (team.hpp); the bytes do not depend on them
[[nodiscard]] Json outputs_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
