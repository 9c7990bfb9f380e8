/// The outputs of a set: OUTPUT of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

/// Cost per column: one sort and five passes. Memory: 16 bytes per run and thread.
/// @param threads as of thread_count (thread_pool.hpp); the bytes do not depend on them
[[nodiscard]] Json outputs_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
