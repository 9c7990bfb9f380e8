#include "montecarlo/results/results_folder/merge.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

namespace wingspread {
namespace {

void refuse_stopping(const StoredCampaign& stored) {
  if (!stored.campaign.until.empty())
    throw SpecError({{(stored.folder / campaign_file).string(), "/until",
                      "a campaign that may stop early", "one that can have shards"}});
}

/// The campaign as stored in one of its folders.
StoredCampaign stored_in(const Part& part, const StoredCampaign& whole) {
  StoredCampaign stored = whole;
  stored.folder = part.folder;
  stored.stamp = part.stamp;
  return stored;
}

void find_present(Part& part, const StoredCampaign& whole) {
  (void)for_each_stored_row(stored_in(part, whole),
                            [&](const ResultRow& row) { part.add(row.run); });
}

bool is_preview(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / campaign_file) &&
         read_stored_campaign(folder).stamp.preview;
}

/// @throws SpecError unless `out` is new or empty, an interrupted merge of the same folders, or an earlier preview
void refuse_other_folder(const std::filesystem::path& out, const std::string& text) {
  if (read_text(out / campaign_file) != text && !is_preview(out))
    refuse_used_folder(out, "a new or an empty folder for the merged results");
}

/// Refuses a folder whose statistics are there, because another `analyze` may have made them.
/// @param last the file that is written last
void refuse_finished(const std::filesystem::path& out, const char* last) {
  if (!std::filesystem::exists(out / last) || is_preview(out)) return;
  throw SpecError({{out.string(), "", "a finished results folder of this campaign",
                    fmt::format("another --out; `wingspread analyze {}` makes its statistics again",
                                shell_word(out.string()))}});
}

/// The checked input of a merge.
struct Merging {
  StoredCampaign whole;
  std::vector<Part> parts;
  std::string campaign; ///< campaign.json's text
};

/// The cases found in any of the folders, in the campaign's order.
std::vector<CaseSpec> cases_in(const std::vector<std::filesystem::path>& folders) {
  std::vector<CaseSpec> cases;
  for (const CaseSpec& spec : read_stored_campaign(folders.front()).campaign.cases)
    if (std::ranges::any_of(folders, [&](const std::filesystem::path& folder) {
          return std::filesystem::exists(folder / spec.name / campaign_file);
        }))
      cases.push_back(spec);
  return cases;
}

/// The command that makes a shard of the campaign in the first folder.
ShardMaker maker_of(const std::vector<std::filesystem::path>& folders) {
  const std::filesystem::path campaign = folders.front() / campaign_file;
  ShardMaker maker{"wingspread run " + shell_word(campaign.string()), ""};
  const std::vector<CaseSpec> made = cases_in(folders);
  if (made.size() < read_stored_campaign(folders.front()).campaign.cases.size())
    for (const CaseSpec& spec : made) maker.more += " --case " + shell_word(spec.name);
  return maker;
}

/// Labels the merge as a preview if some of its `of` runs are missing; adds a fault if there is no run at all.
void preview(Merging& merging, long of, PartFaults& faults) {
  long there = 0;
  for (const Part& part : merging.parts) there += part.count();
  if (there == 0)
    faults.add(Problem{merging.parts.front().folder.string(), "", "no runs", "at least one"});
  if (there < of) merging.whole.stamp.preview = Preview{there, of};
}

/// Checks the folders of a campaign, or of one of its cases, and collects the reasons why they cannot be merged.
/// @param of_case empty: the folders themselves; else the case's folders in them
/// @throws SpecError if they are not folders of one campaign
Merging merging_of(const std::vector<std::filesystem::path>& folders, const std::string& of_case,
                   const std::filesystem::path& out, MergeKind kind, PartFaults& faults) {
  // of all cases: a case's own campaign.json does not know of runs that were added to others only
  const long runs = read_stored_campaign(folders.front()).campaign.sampling.runs;
  Merging merging;
  auto& [whole, parts, text] = merging;
  std::vector<Part> not_begun;
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path its = of_case.empty() ? folder : folder / of_case;
    if (!of_case.empty() && !std::filesystem::exists(its / campaign_file)) {
      not_begun.push_back({its, folder, read_stored_campaign(folder).stamp, {}});
      continue;
    }
    StoredCampaign stored = read_stored_campaign(its);
    parts.push_back({its, folder, stored.stamp, shard_runs(runs, stored.stamp.shard)});
    if (parts.size() == 1) whole = std::move(stored);
  }
  if (parts.empty()) { // no folder has begun the case
    whole.campaign = chosen_case(read_stored_campaign(folders.front()).campaign, of_case);
    whole.stamp = stamp_of(whole.campaign, {});
  } else {
    refuse_other_campaigns(parts, campaign_file);
  }
  refuse_stopping(whole);
  for (Part& part : not_begun) {
    part.own = shard_runs(runs, part.stamp.shard);
    parts.push_back(std::move(part));
  }
  whole.folder = out;
  whole.stamp.shard.reset();
  for (Part& part : parts) find_present(part, whole);
  find_doubles(parts, faults);
  if (kind == MergeKind::preview)
    preview(merging, runs, faults);
  else
    find_missing(parts, runs, maker_of(folders), faults);
  text = campaign_text(whole.campaign, whole.stamp);
  refuse_other_folder(out, text);
  return merging;
}

/// Removes the files of an earlier preview, and those computed from them, but for campaign.json.
void drop_files(const std::filesystem::path& folder) {
  for (const char* file : {summary_file, histograms_json_file, histograms_csv_file, runs_file,
                           cases_file, "sensitivity.json", "sensitivity.csv", "report.html"})
    std::filesystem::remove(folder / file);
}

/// Removes an earlier preview with its cases. Its campaign.json stays until the next one replaces it: if interrupted
/// before that, the folder is still one that may be replaced.
/// @param again the cases that are written again: for the same reason their campaign.json stays too
void drop_preview(const std::filesystem::path& folder, std::span<const Merging> again = {}) {
  if (!is_preview(folder)) return;
  for (const CaseSpec& spec : made_cases(read_stored_campaign(folder))) {
    const bool stays = std::ranges::any_of(
        again, [&](const Merging& merging) { return merging.whole.campaign.of_case == spec.name; });
    const std::filesystem::path own = folder / spec.name;
    {
      const FolderLock lock(own);
      drop_files(own);
      if (!stays) std::filesystem::remove(own / campaign_file);
    }
    std::error_code not_empty; // somebody else's files stay
    if (!stays) std::filesystem::remove(own, not_empty);
  }
  drop_files(folder);
}

/// @pre the input was checked
Summary write_merged(Merging&& merging) {
  auto& [whole, parts, text] = merging;
  const FolderLock lock(whole.folder);
  refuse_other_folder(whole.folder, text);
  drop_preview(whole.folder);
  write_file(whole.folder / campaign_file, text);
  write_in_order(std::move(parts), RunPlan(whole.campaign).names(), whole.folder / runs_file,
                 [&](const Part& part, const auto& take) {
                   (void)for_each_stored_row(stored_in(part, whole), take);
                 });
  return write_statistics(whole, read_stored_results(whole).results);
}

} // namespace

Summary merge_folders(const std::vector<std::filesystem::path>& folders,
                      const std::filesystem::path& out, MergeKind kind) {
  PartFaults faults;
  Merging merging = merging_of(folders, "", out, kind, faults);
  faults.refuse();
  refuse_finished(out, histograms_csv_file);
  return write_merged(std::move(merging));
}

std::vector<CaseSummary> merge_cases(const std::vector<std::filesystem::path>& folders,
                                     const std::filesystem::path& out, MergeKind kind) {
  std::vector<Part> tops;
  for (const auto& folder : folders)
    tops.push_back({folder, folder, read_stored_campaign(folder).stamp, {}, {}});
  refuse_other_campaigns(tops, campaign_file);
  StoredCampaign whole = read_stored_campaign(folders.front());
  PartFaults faults;
  std::vector<Merging> mergings; // all cases are checked before anything is written
  Preview all;
  const std::vector<CaseSpec> begun = cases_in(folders);
  for (const CaseSpec& spec : begun.empty() ? whole.campaign.cases : begun) {
    mergings.push_back(merging_of(folders, spec.name, out / spec.name, kind, faults));
    const Stamp& stamp = mergings.back().whole.stamp;
    all.of += whole.campaign.sampling.runs;
    all.runs += stamp.preview ? stamp.preview->runs : whole.campaign.sampling.runs;
  }
  faults.refuse();
  whole.folder = out;
  whole.stamp.shard.reset();
  if (all.runs < all.of) whole.stamp.preview = all;
  const std::string text = campaign_text(whole.campaign, whole.stamp);
  refuse_other_folder(out, text);
  refuse_finished(out, cases_file);
  const FolderLock lock(out);
  refuse_other_folder(out, text);
  drop_preview(out, mergings);
  write_file(out / campaign_file, text);
  std::vector<CaseSummary> cases;
  for (Merging& merging : mergings) {
    std::string name = merging.whole.campaign.of_case;
    cases.push_back(case_summary(whole, std::move(name), write_merged(std::move(merging))));
  }
  write_cases_file(whole, cases, out);
  return cases;
}

} // namespace wingspread
