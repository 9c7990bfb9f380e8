/// The version of this program, and the commit that it was built from.
#pragma once

#include <string_view>

namespace wingspread {

/// "0.1.0+g1a2b3c4d5e6f" with the commit, followed by ".dirty" if sources were changed after it; "0.1.0" outside a
/// repository.
[[nodiscard]] std::string_view version();

} // namespace wingspread
