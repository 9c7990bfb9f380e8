/// The page's template with style, scripts and d3, compiled into the program (page_files.cmake).
#pragma once

#include <string_view>

namespace wingspread {

/// The page's text before and after its data.
extern const std::string_view page_before_data, page_after_data;

} // namespace wingspread
