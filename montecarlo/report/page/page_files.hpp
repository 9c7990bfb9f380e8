/// The report's page, as it stands in page/, with d3: in the program since it was built (page_files.cmake).
#pragma once

#include <string_view>

namespace wingspread {

/// All that comes before the block of data, and all behind it.
extern const std::string_view page_before_data, page_behind_data;

} // namespace wingspread
