/// The cases of a campaign: the same wing cold and hot, at the end of its life, with a spring out. Each changes the
/// nominal scene before all dispersion; all are run with the same draws, so that they differ by the case alone.
///
///     "cases": [ { "name": "cold", "scale": { "hinges.*.damper.scale": 3 }, "set": { PATH: value },
///                  "add": { PATH: value },
///                  "distributions": { "temperature": { "type": "normal", "mean": -60, "std": 3 } } }, … ]
///
/// Within a case what is set comes first, then what is scaled, then what is added.
#pragma once

#include "montecarlo/model/campaign/dispersion.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// One parameter of the nominal scene, changed.
struct CaseChange {
  Apply apply = Apply::set;
  SceneParameter target;
  double value = 0; ///< SI
};

/// Another law for a dispersion of the campaign: its draws are made of the same random numbers.
struct CaseDistribution {
  std::string dispersion; ///< as the campaign lists it: an `each` with all of its copies
  Distribution distribution;
};

struct CaseSpec {
  std::string name; ///< and of its results folder: letters, digits, '_' and '-'
  std::vector<CaseChange> changes;
  std::vector<CaseDistribution> distributions;
  Json resolved; ///< as it was read, in SI, with the values of files in their place
};

/// Whether a case, and so a folder, can have that name.
[[nodiscard]] bool is_case_name(const std::string& name);

/// Reads the list of cases. Notes a problem, besides what cannot be read, for names that two have, paths that the scene
/// does not have, parameters changed twice in one way, those that a dispersion sets in every run (the case would be
/// lost), scenes that are unphysical, and laws for dispersions that there are none of.
/// @param scene       null when it has problems of its own: then paths are not looked up
/// @param dispersions null likewise
/// @param directory   that the files of empirical laws are relative to
[[nodiscard]] std::vector<CaseSpec> read_cases(const JsonCursor& at, const Scene* scene,
                                               const Dispersions* dispersions,
                                               const std::filesystem::path& directory);

[[nodiscard]] Json write_cases(std::span<const CaseSpec> cases);

/// The nominal scene as the case has it.
[[nodiscard]] Scene scene_of_case(Scene nominal, const CaseSpec& spec);

/// One change of a scene from outside of its file, as `--set PATH=VALUE` is: notes what is wrong with either.
/// @param value a number, or text of a number with its unit
void read_change(const JsonCursor& value, std::string_view path, Apply apply, const Scene& scene,
                 std::vector<CaseChange>& changes);
void make_changes(std::span<const CaseChange> changes, Scene& scene);

} // namespace wingspread
