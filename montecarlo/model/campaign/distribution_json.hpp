/// A distribution from JSON and back to it.
#pragma once

#include "distributions/distribution.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <filesystem>
#include <string_view>

namespace wingspread {

/// Reads { "type": …, its parameters, "truncate": … }. Problems go to the cursor's list; when that
/// grew, what is returned is of no use.
/// @param directory that the file of an empirical law is relative to
/// @param unit      of what is drawn: numbers of that dimension may be strings with their unit; empty: none may
[[nodiscard]] Distribution read_distribution(const JsonCursor& at,
                                             const std::filesystem::path& directory,
                                             std::string_view unit = "");

/// The distribution in full; an empirical one with its values, whatever file they came from.
[[nodiscard]] Json write_distribution(const Distribution& distribution);

/// The law's name in a campaign, e.g. "normal".
[[nodiscard]] std::string_view type_of(const Law& law);

} // namespace wingspread
