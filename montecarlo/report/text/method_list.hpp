/// The integration methods side by side: for `wingspread methods`.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <span>
#include <string>

namespace wingspread {

/// A table of what can be compared, then what is to be said of each. UTF-8,
/// as wide as the other tables unless a kind takes more.
[[nodiscard]] std::string methods_text(std::span<const MethodInfo> methods);

/// An array of objects. What does not apply is null; a limit that is infinite is "unbounded".
[[nodiscard]] Json methods_json(std::span<const MethodInfo> methods);

} // namespace wingspread
