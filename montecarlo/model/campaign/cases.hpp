/// The cases of a campaign: the same wing cold, hot, at the end of its life, or with a spring out. A case changes the
/// nominal scene before dispersion. All cases use the same random numbers, so that they differ by the case only.
///
///     "cases": [ { "name": "cold", "scale": { "hinges.*.damper.scale": 3 }, "set": { PATH: value },
///                  "add": { PATH: value },
///                  "distributions": { "temperature": { "type": "normal", "mean": -60, "std": 3 } } }, … ]
///
/// A case applies "set" first, then "scale", then "add".
#pragma once

#include "montecarlo/model/campaign/dispersion.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// One change of a parameter of the nominal scene.
struct CaseChange {
  Apply apply = Apply::set;
  SceneParameter target;
  double value = 0; ///< SI; a factor if the change scales
};

/// A case's law for a dispersion of the campaign; it uses the same random numbers.
struct CaseDistribution {
  std::string dispersion; ///< name in the campaign; the name of an `each` means all of its copies
  Distribution distribution;
};

struct CaseSpec {
  std::string name; ///< also names the results folder: letters, digits, '_' and '-'
  std::vector<CaseChange> changes;
  std::vector<CaseDistribution> distributions;
  Json resolved; ///< the JSON in SI, with values instead of file names
};

/// Whether the name is valid for a case and its folder.
[[nodiscard]] bool is_case_name(const std::string& name);

/// Reads the list of cases. Notes problems: repeated names, unknown paths and dispersions, a parameter changed twice in
/// one way, a parameter that a dispersion sets in every run (the change would be lost), and unphysical scenes.
/// @param scene       null if the scene has problems: then paths are not looked up
/// @param dispersions null if they have problems
/// @param directory   base of the file names of empirical laws
[[nodiscard]] std::vector<CaseSpec> read_cases(const JsonCursor& at, const Scene* scene,
                                               const Dispersions* dispersions,
                                               const std::filesystem::path& directory);

[[nodiscard]] Json write_cases(std::span<const CaseSpec> cases);

/// Applies a case to the nominal scene.
[[nodiscard]] Scene scene_of_case(Scene nominal, const CaseSpec& spec);

/// Reads one change (`--set PATH=VALUE`, a case's entry) and appends it for every match of the path; notes problems.
/// @param value a number, or a string with a unit
void read_change(const JsonCursor& value, std::string_view path, Apply apply, const Scene& scene,
                 std::vector<CaseChange>& changes);
/// Applies the changes in their order.
void make_changes(std::span<const CaseChange> changes, Scene& scene);

} // namespace wingspread
