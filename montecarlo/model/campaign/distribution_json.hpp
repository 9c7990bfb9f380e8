/// Reads and writes distributions.
#pragma once

#include "distributions/distribution.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Reads { "type": …, its parameters, "truncate": … }. Problems go to the cursor's list; with any, the returned value
/// is not usable.
/// @param directory base of an empirical law's file name
/// @param unit      SI unit of the draws: then parameters may be strings with a unit; empty: numbers only
[[nodiscard]] Distribution read_distribution(const JsonCursor& at,
                                             const std::filesystem::path& directory,
                                             std::string_view unit = "");

/// Reads one column of a CSV file with a header; notes a problem at `at`, if no file can be read, or in the file.
void read_csv_column(const JsonCursor& at, const std::string& name, const std::string& column,
                     const std::filesystem::path& directory, std::vector<double>& values);

/// The distribution as JSON; an empirical law has its values instead of a file name.
[[nodiscard]] Json write_distribution(const Distribution& distribution);

/// The word of `type`, e.g. "normal".
[[nodiscard]] std::string_view type_of(const Law& law);

} // namespace wingspread
