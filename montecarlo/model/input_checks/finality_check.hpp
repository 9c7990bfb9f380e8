/// Where no peak of a deployed wing can be proven final, whatever t_end is.
#pragma once

#include "core/scene/scene.hpp"

#include <string_view>

namespace wingspread {

/// @return the reason, to follow "a limit on root.peak_moment"; empty where a proof may exist
[[nodiscard]] std::string_view why_never_final(const Scene& scene);

} // namespace wingspread
