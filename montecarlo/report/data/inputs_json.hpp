/// The inputs of a set of runs: INPUTS of page/DATA.md.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

namespace wingspread {

/// The scene's parameters with the case's changes, the dispersions with their laws, and the settings.
[[nodiscard]] Json inputs_json(const PageSource& source, const PageDetail& detail);

} // namespace wingspread
