/// The results folder of a campaign with cases: a results folder for each case in it, by its name.
///
///   campaign.json    the campaign in full with its cases, and its stamp
///   NAME/            the results folder of a case: that of its own campaign (campaign_of_case)
///   cases.json       the cases side by side, worked out of theirs
///
/// A case's folder is read, replayed and analysed as any results folder is.
#pragma once

#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/summary/comparison.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

inline constexpr const char* cases_file = "cases.json";

/// Whether the folder is one of a campaign with cases.
[[nodiscard]] bool is_cases_folder(const std::filesystem::path& folder);

/// The folder as it is for a campaign without cases, else that of the case.
/// @param name empty: none is named
/// @throws SpecError when one has to be named and is not, or there is none of that name
[[nodiscard]] std::filesystem::path folder_of_case(const std::filesystem::path& folder,
                                                   const std::string& name);

/// The cases of these names, in the campaign's order; all of them without names.
/// @throws SpecError with each name that none has
[[nodiscard]] std::vector<CaseSpec> chosen_cases(const Campaign& campaign,
                                                 std::span<const std::string> names);
/// The campaign to be used where one is wanted: itself when it has no cases, else that of the case.
/// @throws SpecError as folder_of_case does
[[nodiscard]] Campaign chosen_case(const Campaign& campaign, const std::string& name);

/// Holds the whole folder while its cases are made.
class CasesFolder {
public:
  /// Opens the folder, and makes it with its campaign.json if it is not there; as FolderWriter does for a campaign
  /// without cases, and refuses what that refuses.
  CasesFolder(std::filesystem::path folder, const Campaign& campaign,
              const std::optional<Shard>& shard, bool resume);

  [[nodiscard]] const StoredCampaign& stored() const { return stored_; }

private:
  StoredCampaign stored_;
  std::optional<FolderLock> lock_;
};

/// The cases of which there is a folder, in the campaign's order.
[[nodiscard]] std::vector<CaseSpec> made_cases(const StoredCampaign& whole);

/// Reads a case's folder again and works out its statistics, unless it is among those that are known.
/// @return all cases of which there is a folder, in the campaign's order
[[nodiscard]] std::vector<CaseSummary> complete_cases(const StoredCampaign& whole,
                                                      std::vector<CaseSummary> known);

/// A case's summary as the comparison takes it. @param stored the case's own
[[nodiscard]] CaseSummary case_summary(const StoredCampaign& stored, Summary summary);

/// Writes cases.json. @param to the folder for it
void write_cases_file(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
                      const std::filesystem::path& to);

} // namespace wingspread
