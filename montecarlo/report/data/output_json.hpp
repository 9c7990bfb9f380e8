/// The outputs of a set: OUTPUT of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

/// The indices of the outputs that the page shows, in the columns' order: all, or as many as it has room for, first those
/// with a requirement.
[[nodiscard]] std::vector<std::size_t> shown_outputs(const PageSource& source,
                                                     const PageDetail& detail);

/// The digits that show three digits of the spread of an output's values: at least those of the page.
[[nodiscard]] int digits_of(const Moments& moments);

/// Cost per column: one sort and five passes. Memory: 16 bytes per run and thread.
/// @param threads as of thread_count (thread_pool.hpp); the bytes do not depend on them
[[nodiscard]] Json outputs_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
