#include "montecarlo/folder/folder_writer.hpp"

#include "montecarlo/folder/replay.hpp"
#include "montecarlo/formats/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace wingspread {
namespace {

/// Not there, or without a file in its place.
bool is_new(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) return true;
  if (!std::filesystem::is_directory(folder)) return false;
  const auto is_nothing = [](const std::filesystem::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return name.ends_with(part_suffix) || name == lock_file;
  };
  return std::ranges::all_of(std::filesystem::directory_iterator(folder), is_nothing);
}

/// Why a campaign cannot be continued with another number of runs.
std::string fixed_runs(const Sampling& sampling) {
  return sampling.design == DesignKind::latin_hypercube
             ? "a Latin hypercube's strata, and so all of its draws, depend on the number of runs; "
               "run it into a new folder"
             : "the number of runs is part of a campaign; run it into a new folder";
}

/// Refuses to mix the rows of two campaigns, seeds, shards or versions.
void refuse_other_campaign(const StoredCampaign& there, const Campaign& campaign,
                           const Stamp& stamp) {
  std::vector<Problem> problems;
  const auto compare = [&](const char* key, const std::string& found, const std::string& ours) {
    if (found != ours)
      problems.push_back({(there.folder / campaign_file).string(),
                          fmt::format("/wingspread/{}", key), found,
                          fmt::format("{}, to continue what is there", ours)});
  };
  const Sampling &found = there.campaign.sampling, &ours = campaign.sampling;
  if (found.runs != ours.runs)
    problems.push_back({(there.folder / campaign_file).string(), "/sampling/runs",
                        std::to_string(found.runs),
                        fmt::format("{}: {}", ours.runs, fixed_runs(ours))});
  compare("hash", there.stamp.hash, stamp.hash);
  compare("shard", describe(there.stamp.shard), describe(stamp.shard));
  compare("version", there.stamp.version, stamp.version);
  if (!problems.empty()) throw SpecError(std::move(problems));
}

/// A shard cannot tell what all runs up to a checkpoint come to.
void refuse_stopping_shard(const Campaign& campaign, const std::optional<Shard>& shard) {
  if (shard && !campaign.until.empty())
    throw SpecError({{"", "", describe(shard) + " of a campaign that stops at a width",
                      "all runs: only they tell when to stop"}});
}

} // namespace

void refuse_used_folder(const std::filesystem::path& folder, const char* expected) {
  if (is_new(folder)) return;
  const bool is_folder = std::filesystem::is_directory(folder);
  throw SpecError(
      {{folder.string(), "", is_folder ? "a folder with files in it" : "a file", expected}});
}

FolderWriter::FolderWriter(std::filesystem::path folder, const RunPlan& plan,
                           const std::optional<Shard>& shard, bool resume)
    : stored_{std::move(folder), plan.campaign(), stamp_of(plan.campaign(), shard)},
      rows_(stored_.folder / runs_file, plan.names()) {
  refuse_stopping_shard(stored_.campaign, shard);
  constexpr const char* expected = "a new or an empty folder (--resume continues a campaign)";
  if (!resume)
    refuse_used_folder(stored_.folder, expected);
  else if (!is_new(stored_.folder))
    (void)read_stored_campaign(stored_.folder); // before anything is made in what is no such folder
  lock_.emplace(stored_.folder);
  const bool fresh = is_new(stored_.folder);
  if (!resume) refuse_used_folder(stored_.folder, expected);
  if (!fresh) {
    refuse_other_campaign(read_stored_campaign(stored_.folder), stored_.campaign, stored_.stamp);
    ResultsFile read = read_stored_results(stored_);
    refuse_other_rows(plan, read.results, stored_.folder / runs_file);
    rows_.go_on_behind(std::move(read), stored_.runs().first);
  } else {
    write_file(stored_.folder / campaign_file, campaign_text(stored_.campaign, stored_.stamp));
  }
  rows_.open(plan.names());
}

RunRange FolderWriter::remaining() const {
  const RunRange runs = stored_.runs();
  const long done = rows_.count();
  const bool may_stop = !stored_.campaign.until.empty();
  if (done >= runs.size() || (may_stop && is_complete(stored_, results())))
    return {runs.first + done, runs.first + done};
  return {runs.first + done, may_stop ? next_checkpoint(done, runs.size()) : runs.last};
}

} // namespace wingspread
