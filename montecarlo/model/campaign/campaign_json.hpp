/// Reads campaigns from JSON, and replaces parts of a campaign. To add a key: read and write it in the part's file
/// (campaign_settings, outputs, requirement, …), call the part here, and add the key to model/schema/specimens.cpp.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace wingspread {

/// @param directory base of the file names in the text
/// @param file      name for the messages
/// @throws SpecError with all problems
[[nodiscard]] Campaign read_campaign(const std::string& text,
                                     const std::filesystem::path& directory,
                                     const std::string& file = "");

/// The same, and records the readers' questions for the schema. @param questions filled even if it throws
[[nodiscard]] Campaign read_campaign(const Json& document, std::vector<Question>& questions);

/// @throws SpecError with all problems
[[nodiscard]] Campaign read_campaign_file(const std::filesystem::path& path);
[[nodiscard]] Scene read_scene_file(const std::filesystem::path& path);

/// Reads a scene or a campaign: a document with "scene", "dispersions" or "sampling" is a campaign.
/// @throws SpecError with all problems
[[nodiscard]] std::variant<Scene, Campaign> read_file(const std::filesystem::path& path);
/// The same from text. @param directory base of the file names in the text
[[nodiscard]] std::variant<Scene, Campaign>
read_scene_or_campaign(const std::string& text, const std::filesystem::path& directory);

/// Replaces the number of runs and the seed, if given, also in `resolved`. @pre runs ≥ 1
/// @throws SpecError if there are fewer runs than replicates
void override_sampling(Campaign& campaign, std::optional<std::int64_t> runs,
                       std::optional<std::uint64_t> seed);

/// The campaign with another nominal scene of the same structure, validated again.
/// @throws SpecError with all problems, e.g. a case that becomes unphysical
[[nodiscard]] Campaign with_scene(const Campaign& campaign, const Scene& scene);

/// The campaign of one case: with the case's scene and laws, without cases, and with the case's name in `of_case`. It
/// has the same random numbers as the other cases.
[[nodiscard]] Campaign campaign_of_case(const Campaign& campaign, const CaseSpec& spec);

/// The campaign's requirements and statistics that differ from those of its `resolved`, by key; {} if none does.
[[nodiscard]] Json write_analysis(const Campaign& campaign);
/// Replaces the requirements and statistics by those of write_analysis, and notes problems.
void read_analysis(const JsonCursor& at, Campaign& campaign);

/// One campaign for each case, in their order; the campaign itself if it has no cases.
[[nodiscard]] std::vector<Campaign> campaigns_of(const Campaign& campaign);

/// "none" or "laws with a single value only", followed by the names of the cases, if any of these cases varies nothing;
/// else empty. All runs of such a case are one and the same.
/// @param cases empty: all
[[nodiscard]] std::string where_nothing_varies(const Campaign& campaign,
                                               std::span<const CaseSpec> cases = {});

/// Records the numbers of runs of earlier interim analyses, also in `resolved`.
/// @pre the numbers ascend and are below the campaign's number of runs
void note_extension(Campaign& campaign, std::vector<std::int64_t> extended_from);

/// Replaces the goals to stop at, also in `resolved`, in the place that they have in a campaign that was read: its hash
/// depends on the order of keys. Notes problems.
void override_stopping(Campaign& campaign, const JsonCursor& at);

/// Replaces the requirements by those of a file (read_requirements_file), also in `resolved`. Goals to stop at that name
/// none of them go.
/// @throws SpecError with all problems
void override_requirements(Campaign& campaign, const std::filesystem::path& path);

} // namespace wingspread
