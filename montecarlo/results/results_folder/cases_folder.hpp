/// The results folder of a campaign with cases, with a results folder per case.
///
///   campaign.json    the campaign in full with its cases, and its stamp
///   NAME/            the results folder of the case NAME (its campaign: campaign_of_case)
///   cases.json       all cases side by side
///
/// A case's folder can be read, replayed and analysed like any results folder.
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

/// Whether the folder belongs to a campaign with cases.
[[nodiscard]] bool is_cases_folder(const std::filesystem::path& folder);

/// The results folder of a case; the folder itself for a campaign without cases.
/// @param name of the case; empty: none
/// @throws SpecError if the campaign has cases and the name is empty, or if no case has the name
[[nodiscard]] std::filesystem::path folder_of_case(const std::filesystem::path& folder,
                                                   const std::string& name);

/// The cases with these names, in the campaign's order; all of them without names.
/// @throws SpecError with each unknown name
[[nodiscard]] std::vector<CaseSpec> chosen_cases(const Campaign& campaign,
                                                 std::span<const std::string> names);
/// The campaign of the case with this name; the campaign itself if it has no cases.
/// @throws SpecError as folder_of_case
[[nodiscard]] Campaign chosen_case(const Campaign& campaign, const std::string& name);

/// Locks the whole folder while its cases run.
class CasesFolder {
public:
  /// Opens the folder, or creates it with its campaign.json. Refuses what FolderWriter refuses, cases' folders too.
  CasesFolder(std::filesystem::path folder, const Campaign& campaign,
              const std::optional<Shard>& shard, bool resume);

  /// Gives the folder's campaign.json the interim analyses of all its cases (Sampling::extended_from), so that running
  /// that file anew judges the draws as often as these cases have.
  void note_extensions();

  [[nodiscard]] const StoredCampaign& stored() const { return stored_; }

private:
  StoredCampaign stored_;
  std::optional<FolderLock> lock_;
};

/// The cases that have a folder, in the campaign's order.
[[nodiscard]] std::vector<CaseSpec> made_cases(const StoredCampaign& whole);

/// Reads the folders of cases that are not in `known`, computes their statistics by the campaign's own requirements, and
/// writes them, unless the case's folder has those of another `analyze`.
/// @return all cases that have a folder, in the campaign's order
[[nodiscard]] std::vector<CaseSummary>
complete_cases(const StoredCampaign& whole, std::vector<CaseSummary> known, int threads = 0);

/// A case's summary for the comparison. The case is partial if it lacks runs of the whole campaign: its own, or those
/// that were added to other cases only. @param whole the outer folder
[[nodiscard]] CaseSummary case_summary(const StoredCampaign& whole, std::string name,
                                       Summary summary);

/// Writes cases.json. @param to its folder
void write_cases_file(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
                      const std::filesystem::path& to);

} // namespace wingspread
