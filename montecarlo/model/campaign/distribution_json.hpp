/// Reads and writes distributions.
#pragma once

#include "core/scene/scene.hpp"
#include "distributions/distribution.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Reads { "type": …, its parameters, "truncate": … }. Problems go to the cursor's list; with any, the returned value
/// is not usable.
/// @param directory base of an empirical law's file name
/// @param unit      SI unit of the draws: then parameters may be strings with a unit; empty: numbers only; nothing:
///   unknown, and no string of a number and a unit is refused
[[nodiscard]] Distribution read_distribution(const JsonCursor& at,
                                             const std::filesystem::path& directory,
                                             std::optional<std::string_view> unit = "");

/// The common unit of all parameters of these paths; empty if there is none, nothing if no path is known.
[[nodiscard]] std::optional<std::string_view> common_unit(const Json& paths, const Scene& scene);

/// The unit of a dispersion's draws: the common unit of all targets for "set" and "add". Empty for "scale", for tables,
/// and without a common unit; nothing if the scene or all paths are unknown.
/// @param spec  the dispersion's JSON
/// @param scene null if the scene has problems
[[nodiscard]] std::optional<std::string_view> unit_of_draws(const Json& spec, const Scene* scene);

/// Removes the problems from index `before` on that refuse a string which begins with a number: the unit is unknown, which
/// another problem already explains. @return whether there was any
bool drop_quantities(std::size_t before, std::vector<Problem>& problems);

/// Reads one column of a CSV file with a header; notes a problem at `at`, if no file can be read, or in the file. A unit
/// in the header's brackets ("z [N*mm]", named "z" or in full) counts.
/// @param unit SI unit of the values; empty: they have none; nothing: not known, and brackets mean nothing
void read_csv_column(const JsonCursor& at, const std::string& name, const std::string& column,
                     const std::filesystem::path& directory, std::optional<std::string_view> unit,
                     std::vector<double>& values);

/// The distribution as JSON; an empirical law has its values instead of a file name.
[[nodiscard]] Json write_distribution(const Distribution& distribution);

/// The word of `type`, e.g. "normal".
[[nodiscard]] std::string_view type_of(const Law& law);

} // namespace wingspread
