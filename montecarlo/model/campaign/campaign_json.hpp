/// A campaign from JSON, and parts of it put in place of what its file says.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace wingspread {

/// @param directory that the files named in the text are relative to
/// @param file      the name that problems carry
/// @throws SpecError with all that is wrong
[[nodiscard]] Campaign read_campaign(const std::string& text,
                                     const std::filesystem::path& directory,
                                     const std::string& file = "");

/// The same, with all that is asked of the document on the way. @param questions has it, whatever is thrown
[[nodiscard]] Campaign read_campaign(const Json& document, std::vector<Question>& questions);

/// @throws SpecError with all that is wrong
[[nodiscard]] Campaign read_campaign_file(const std::filesystem::path& path);
[[nodiscard]] Scene read_scene_file(const std::filesystem::path& path);

/// Reads either, told apart by their keys: a campaign has a scene, a scene has bodies.
/// @throws SpecError with all that is wrong
[[nodiscard]] std::variant<Scene, Campaign> read_file(const std::filesystem::path& path);
/// The same of a text. @param directory that the files named in it are relative to
[[nodiscard]] std::variant<Scene, Campaign>
read_scene_or_campaign(const std::string& text, const std::filesystem::path& directory);

/// Replaces the number of runs and the seed, where given; `resolved` follows. @pre runs ≥ 1
/// @throws SpecError when the runs are fewer than the design's replicates
void override_sampling(Campaign& campaign, std::optional<std::int64_t> runs,
                       std::optional<std::uint64_t> seed);

/// The campaign with another nominal scene of the same structure; all else, `resolved` too, follows.
/// @throws SpecError with what does not fit it: a case that would be unphysical
[[nodiscard]] Campaign with_scene(const Campaign& campaign, const Scene& scene);

/// The campaign of one of its cases alone, ready to be run: its scene is the case's, it has no cases, and `of_case` is
/// the case's name. Of the same seed it has the same draws, but for laws that the case replaces.
[[nodiscard]] Campaign campaign_of_case(const Campaign& campaign, const CaseSpec& spec);

/// One for each case, in their order; the campaign itself where it has none.
[[nodiscard]] std::vector<Campaign> campaigns_of(const Campaign& campaign);

/// Says at which numbers of runs its results were looked at before it was extended; `resolved`
/// follows. @pre each less than the next, and than the number of runs
void note_extension(Campaign& campaign, std::vector<std::int64_t> extended_from);

/// Replaces the goals at which it stops by those that stand here, and notes what is wrong with
/// them; `resolved` follows.
void override_stopping(Campaign& campaign, const JsonCursor& at);

/// Reads requirements that stand in a file of their own, by the campaign's rules: an array.
/// @throws SpecError with all that is wrong
[[nodiscard]] std::vector<Requirement> read_requirements_file(const std::filesystem::path& path,
                                                              const Campaign& campaign);

} // namespace wingspread
