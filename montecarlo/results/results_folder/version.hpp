/// The version of this program, and the commit that it was built from.
#pragma once

#include <string_view>

namespace wingspread {

/// "0.1.0+g1a2b3c4d5e6f", with ".dirty" behind it where the sources were changed after that commit; "0.1.0" where they
/// are in no repository.
[[nodiscard]] std::string_view version();

} // namespace wingspread
