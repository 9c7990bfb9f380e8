/// The version of this program.
#pragma once

#include <string_view>

namespace wingspread {

[[nodiscard]] std::string_view version();

} // namespace wingspread
