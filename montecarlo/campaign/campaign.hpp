/// A campaign: a scene, what varies in it, how often it is run, and what is wanted of the runs.
#pragma once

#include "core/scene/scene.hpp"
#include "distributions/dependence.hpp"
#include "montecarlo/campaign/campaign_settings.hpp"
#include "montecarlo/campaign/dispersion.hpp"
#include "montecarlo/campaign/margin_spec.hpp"
#include "montecarlo/campaign/outputs.hpp"
#include "montecarlo/campaign/requirement.hpp"
#include "montecarlo/campaign/stopping_rule.hpp"
#include "montecarlo/formats/json_parse.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace wingspread {

struct Campaign {
  Scene scene; ///< nominal
  std::vector<Dispersion> dispersions;
  std::vector<RankCorrelation> correlations; ///< between dispersions; their matrix is possible
  Sampling sampling;
  Integration integration;
  Outputs outputs = default_outputs();
  StatisticsSpec statistics;
  std::vector<Requirement> requirements;
  StoppingRule until;               ///< it may stop before all of its runs are made
  std::optional<MarginSpec> margin; ///< what `wingspread margin` sizes; of no account to its runs
  /// The same in full as JSON: defaults explicit, the scene and empirical values in place of their
  /// files. Reads back to the same campaign, wherever it is put.
  Json resolved;
};

/// @param directory that the files named in the text are relative to
/// @param file      the name that problems carry
/// @throws SpecError with all that is wrong
[[nodiscard]] Campaign read_campaign(const std::string& text,
                                     const std::filesystem::path& directory,
                                     const std::string& file = "");

/// @throws SpecError with all that is wrong
[[nodiscard]] Campaign read_campaign_file(const std::filesystem::path& path);
[[nodiscard]] Scene read_scene_file(const std::filesystem::path& path);

/// Reads either, told apart by their keys: a campaign has a scene, a scene has bodies.
/// @throws SpecError with all that is wrong
[[nodiscard]] std::variant<Scene, Campaign> read_file(const std::filesystem::path& path);

/// Replaces the number of runs and the seed, where given; `resolved` follows. @pre runs ≥ 1
/// @throws SpecError when the runs are fewer than the design's replicates
void override_sampling(Campaign& campaign, std::optional<std::int64_t> runs,
                       std::optional<std::uint64_t> seed);

/// Replaces the widths at which it stops by those that stand here, and notes what is wrong with
/// them; `resolved` follows.
void override_stopping(Campaign& campaign, const JsonCursor& at);

/// Reads requirements that stand in a file of their own, by the campaign's rules: an array.
/// @throws SpecError with all that is wrong
[[nodiscard]] std::vector<Requirement> read_requirements_file(const std::filesystem::path& path,
                                                              const Campaign& campaign);

/// At how many numbers of runs it may stop.
[[nodiscard]] long count_looks(const Campaign& campaign);

/// What tells campaigns apart: 16 hexadecimal digits that depend on the resolved campaign alone,
/// less its key "wingspread". Stable across platforms and runs of the program.
[[nodiscard]] std::string campaign_hash(const Json& resolved);

/// Makes a scene the one of a run: puts back what the campaign varies to its nominal value, then
/// applies the draws. Allocates nothing.
/// @param draws     one per dispersion, in their order
/// @param nominal   the campaign's scene
/// @param run_scene a copy of `nominal`, as it was or as this function left it
void apply(const Campaign& campaign, std::span<const double> draws, const Scene& nominal,
           Scene& run_scene);

} // namespace wingspread
