/// The integration methods side by side: for `wingspread methods`.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <span>
#include <string>

namespace wingspread {

/// A table of order, stability limits and kind, then a note on each method. UTF-8, at most 100 columns unless a kind is
/// longer.
[[nodiscard]] std::string methods_text(std::span<const MethodInfo> methods);

/// An array of objects; null if not applicable; an infinite limit is "unbounded".
[[nodiscard]] Json methods_json(std::span<const MethodInfo> methods);

} // namespace wingspread
