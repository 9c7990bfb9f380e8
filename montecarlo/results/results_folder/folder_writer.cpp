#include "montecarlo/results/results_folder/folder_writer.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/differences.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

/// Why runs cannot be added to the existing ones; nothing if they can.
std::optional<std::string> fixed_runs(const StoredCampaign& there, const Campaign& ours,
                                      const Stamp& stamp) {
  if (ours.sampling.runs < there.campaign.sampling.runs)
    return fmt::format("more can be added to them, but none taken away; --runs {} goes on with "
                       "them, or run it into a new folder",
                       there.campaign.sampling.runs);
  if (ours.sampling.design == DesignKind::latin_hypercube)
    return "a Latin hypercube's strata, and so all of its draws, depend on the number of runs; "
           "run it into a new folder";
  if (!ours.until.empty() || !there.campaign.until.empty())
    return "the interim analyses of a campaign that may stop early depend on the number of runs; "
           "run it "
           "into a new folder";
  if (stamp.shard || there.stamp.shard)
    return "a shard's runs depend on the number of all; run it into a new folder";
  return std::nullopt;
}

/// Adds problems if the campaign differs from the stored one: the first values that differ, or the hashes if only the
/// order of keys differs.
/// @param reported pointer of a value that is already reported
void refuse_differences(const StoredCampaign& there, const Campaign& ours,
                        std::string_view reported, std::vector<Problem>& problems) {
  const std::string file = (there.folder / campaign_file).string();
  const std::string hash = campaign_hash(ours.resolved);
  if (there.stamp.hash == hash) return;
  std::vector<Difference> all = find_differences(there.campaign.resolved, ours.resolved);
  std::string reason = all.empty() ? "the same values in another order" : "";
  std::erase_if(all, [&](const Difference& each) { return each.pointer == reported; });
  // Earlier extensions are not the user's: a campaign that is the same otherwise continues them.
  const auto is_extension = [](const Difference& each) {
    return each.pointer == "/sampling/extended_from";
  };
  if (!std::ranges::all_of(all, is_extension)) std::erase_if(all, is_extension);
  for (std::size_t i = 0; i < std::min(all.size(), most_differences); ++i)
    problems.push_back(
        {file, all[i].pointer, describe_or_nothing(all[i].found) + " (when the folder was made)",
         describe_or_nothing(all[i].expected) + " (now), to continue what is there"});
  if (all.size() > most_differences) reason = fmt::format("{} values differ", all.size());
  if (!reason.empty())
    problems.push_back({file, "/wingspread/hash", there.stamp.hash,
                        fmt::format("{}, to continue what is there: {}", hash, reason)});
}

/// The interim analyses so far, if more runs are added to these rows.
std::vector<std::int64_t> analyses_before(const Sampling& there, std::int64_t rows) {
  std::vector<std::int64_t> analyses = there.extended_from;
  if (rows > 0 && (analyses.empty() || rows > analyses.back())) analyses.push_back(rows);
  return analyses;
}

/// Refuses a shard of a campaign with a stopping rule: an interim analysis needs all runs up to that point.
void refuse_stopping_shard(const Campaign& campaign, const std::optional<Shard>& shard) {
  if (shard && !campaign.until.empty())
    throw SpecError({{"", "", describe(shard) + " of a campaign that may stop early",
                      "all runs: only they tell when to stop"}});
}

} // namespace

bool is_new_folder(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) return true;
  if (!std::filesystem::is_directory(folder)) return false;
  const auto is_nothing = [](const std::filesystem::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return (name.starts_with('.') && name.ends_with(part_suffix)) || name == lock_file;
  };
  return std::ranges::all_of(std::filesystem::directory_iterator(folder), is_nothing);
}

void refuse_other_campaign(const StoredCampaign& there, const Campaign& ours, const Stamp& stamp) {
  std::vector<Problem> problems;
  const auto compare = [&](const char* key, const std::string& found, const std::string& expected) {
    if (found != expected)
      problems.push_back({(there.folder / campaign_file).string(),
                          fmt::format("/wingspread/{}", key), found,
                          fmt::format("{}, to continue what is there", expected)});
  };
  const std::int64_t found = there.campaign.sampling.runs, runs = ours.sampling.runs;
  const auto fixed = found == runs ? std::nullopt : fixed_runs(there, ours, stamp);
  if (fixed)
    problems.push_back({(there.folder / campaign_file).string(), "/sampling/runs",
                        std::to_string(found), fmt::format("{}: {}", runs, *fixed)});
  Campaign same = ours; // compared with the same number of runs, because that number may grow
  if (!fixed) override_sampling(same, found, std::nullopt);
  refuse_differences(there, same, fixed ? "/sampling/runs" : "", problems);
  compare("shard", describe(there.stamp.shard), describe(stamp.shard));
  compare("version", there.stamp.version, stamp.version);
  if (there.stamp.preview)
    problems.push_back({(there.folder / campaign_file).string(), "/wingspread/preview",
                        describe(*there.stamp.preview),
                        "a folder that runs are made into: go on with the shards, and merge them"});
  if (!problems.empty()) throw SpecError(std::move(problems));
}

void refuse_used_folder(const std::filesystem::path& folder, const char* expected) {
  if (is_new_folder(folder)) return;
  const bool is_folder = std::filesystem::is_directory(folder);
  throw SpecError(
      {{folder.string(), "", is_folder ? "a folder with files in it" : "a file", expected}});
}

void lock_campaign_folder(std::optional<FolderLock>& lock, const std::filesystem::path& folder,
                          bool resume) {
  const auto refuse = [&] {
    refuse_used_folder(folder, "a new or an empty folder (--resume continues a campaign)");
  };
  if (!resume)
    refuse();
  else if (!is_new_folder(folder))
    (void)read_stored_campaign(
        folder); // throws for a folder without one, before a lock file is made in it
  lock.emplace(folder);
  if (!resume) refuse(); // it may have changed before the lock
}

FolderWriter::FolderWriter(std::filesystem::path folder, const RunPlan& plan,
                           const std::optional<Shard>& shard, bool resume)
    : stored_{std::move(folder), plan.campaign(), stamp_of(plan.campaign(), shard)},
      rows_(stored_.folder / runs_file, plan.names()) {
  refuse_stopping_shard(stored_.campaign, shard);
  lock_campaign_folder(lock_, stored_.folder, resume);
  if (is_new_folder(stored_.folder))
    write_file(stored_.folder / campaign_file, campaign_text(stored_.campaign, stored_.stamp));
  else
    read_existing_rows(plan);
  rows_.open();
}

void FolderWriter::read_existing_rows(const RunPlan& plan) {
  const StoredCampaign there = read_stored_campaign(stored_.folder);
  const Sampling& before = there.campaign.sampling;
  // The campaign of all cases names the analyses of each of them: a case has had those of its folder.
  if ((stored_.campaign.sampling.extended_from.empty() || !stored_.campaign.of_case.empty()) &&
      before.seed == stored_.campaign.sampling.seed)
    note_extension(stored_.campaign, before.extended_from);
  refuse_other_campaign(there, stored_.campaign, stored_.stamp);
  if (is_streaming_folder(there.folder))
    throw SpecError({{there.folder.string(), "", "a folder that was begun with --no-rows",
                      "--no-rows beside --resume, or a new folder for a run that keeps its rows"}});
  ResultsFile read = std::filesystem::exists(there.folder / runs_file)
                         ? read_stored_results(there)
                         : ResultsFile{Results(plan.names()), 0, false};
  refuse_other_rows(plan, read.results, stored_.folder / runs_file);
  rows_.continue_after(std::move(read), stored_.runs().first);
  if (before.runs < stored_.campaign.sampling.runs)
    note_extension(stored_.campaign, analyses_before(before, rows_.count()));
  stored_.stamp = stamp_of(stored_.campaign, stored_.stamp.shard);
  if (before.runs < stored_.campaign.sampling.runs)
    write_file(stored_.folder / campaign_file, campaign_text(stored_.campaign, stored_.stamp));
}

RunRange FolderWriter::remaining() const {
  const RunRange runs = stored_.runs();
  const long done = rows_.count();
  const bool may_stop = !stored_.campaign.until.empty();
  if (done >= runs.size() || (may_stop && is_complete(stored_, results())))
    return {runs.first + done, runs.first + done};
  return {runs.first + done, may_stop ? next_interim_analysis(done, runs.size()) : runs.last};
}

} // namespace wingspread
