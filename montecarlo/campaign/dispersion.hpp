/// What a campaign varies: a law, and the parameters of the scene that its draws are applied to.
#pragma once

#include "distributions/distribution.hpp"
#include "montecarlo/formats/json_reader.hpp"
#include "montecarlo/scene_file/scene_parameter.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// What a draw does to its target: becomes its value, multiplies it, or is added to it. Dispersions
/// act in the order in which they are listed, each on what those before it have left; the first
/// finds the nominal value.
enum class Apply { set, scale, add };
inline constexpr std::array<std::string_view, 3> apply_names{"set", "scale", "add"};

/// One draw per run, and the parameters that it is applied to.
struct Dispersion {
  std::string name; ///< of the draw: its column, and its random stream
  Distribution distribution;
  Apply apply = Apply::set;
  std::vector<SceneParameter> targets;
};

struct Dispersions {
  std::vector<Dispersion> list;
  Json resolved; ///< as it was read, not expanded, but with the values of files in their place
};

/// Reads a campaign's list of dispersions, with one for each match of an `each`: `name.panel_1`.
///
/// Notes a problem, besides what cannot be read, for names that cannot head a column of their own,
/// targets that the scene does not have, and draws that would be lost because a later dispersion
/// sets their target. When there is any, what is returned is of no use.
/// @param scene     null when it has problems of its own: then targets are not looked up
/// @param directory that the files of empirical laws are relative to
[[nodiscard]] Dispersions read_dispersions(const JsonCursor& at, const Scene* scene,
                                           const std::filesystem::path& directory);

} // namespace wingspread
