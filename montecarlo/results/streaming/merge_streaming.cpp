/// Merges shards made with --no-rows.
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/input_file.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/results/results_folder/parts.hpp"
#include "montecarlo/results/results_folder/row_columns.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace wingspread {
namespace {

/// The folders as parts of one campaign, by their runs.
/// @throws SpecError, MissingRuns unless they hold all runs of one campaign, each once
std::vector<StoredCampaign> complete_shards(const std::vector<std::filesystem::path>& folders) {
  std::vector<StoredCampaign> shards;
  std::vector<Part> parts;
  for (const std::filesystem::path& folder : folders) {
    if (std::filesystem::exists(folder / runs_file))
      throw SpecError(
          {{folder.string(), "", "a folder with rows", "folders of --no-rows, as the others"}});
    shards.push_back(read_stored_campaign(folder));
    parts.push_back({folder, folder, shards.back().stamp, shards.back().runs()});
  }
  refuse_other_campaigns(parts, campaign_file);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!is_streaming_folder(parts[i].folder)) { // killed before its first statistics
      if (parts[i].own.size() == 0)
        throw SpecError({{parts[i].folder.string(), "", "no statistics",
                          describe(parts[i].stamp.shard) + ", complete: run it again"}});
      continue;
    }
    const StoredStatistics read = read_streaming_statistics(shards[i]);
    if (read.broken_bytes > 0)
      refuse_other_columns(parts[i].folder / broken_runs_file, RunPlan(shards[i].campaign).names());
    const long first = parts[i].own.first, made = read.statistics.runs();
    if (made > 0) parts[i].present = {{first, first + made}};
  }
  PartFaults faults;
  find_doubles(parts, faults);
  find_missing(
      parts, shards.front().campaign.sampling.runs,
      {"wingspread run " + shell_word((folders.front() / campaign_file).string()), " --no-rows"},
      faults);
  faults.refuse();
  std::ranges::sort(shards, {}, [](const StoredCampaign& shard) { return shard.runs().first; });
  return shards;
}

/// @param text of campaign.json
/// @throws SpecError unless `out` is new or empty, or an interrupted merge of the same shards
void refuse_other_folder_without_rows(const std::filesystem::path& out, const std::string& text) {
  const bool has_rows = std::filesystem::exists(out / runs_file),
             is_finished = std::filesystem::exists(out / extremes_file);
  if (has_rows || is_finished || read_text(out / campaign_file) != text)
    refuse_used_folder(out, "a new or an empty folder");
}

/// Statistics of all shards.
struct MergedStatistics {
  StreamingStatistics all;
  std::vector<std::uint64_t> broken_bytes; ///< of each shard's broken_runs.csv
};

MergedStatistics add_statistics(const std::vector<StoredCampaign>& shards) {
  StoredStatistics first = read_streaming_statistics(shards.front());
  MergedStatistics merged{std::move(first.statistics), {first.broken_bytes}};
  for (const StoredCampaign& shard : std::span(shards).subspan(1)) {
    const StoredStatistics read = read_streaming_statistics(shard);
    merged.all.add(read.statistics);
    merged.broken_bytes.push_back(read.broken_bytes);
  }
  return merged;
}

/// Appends the first bytes of one shard's broken_runs.csv. @return bytes written
std::uint64_t append_broken(const StoredCampaign& part, std::uint64_t bytes, bool with_header,
                            OutputFile& to) {
  InputFile in(part.folder / broken_runs_file);
  std::string line;
  std::uint64_t read = 0, written = 0;
  for (bool header = true; read < bytes && std::getline(in, line); header = false) {
    line += '\n';
    read += line.size();
    if (header && !with_header) continue;
    to.write(line);
    written += line.size();
  }
  return written;
}

} // namespace

Summary merge_streaming(const std::vector<std::filesystem::path>& folders,
                        const std::filesystem::path& out) {
  const std::vector<StoredCampaign> parts = complete_shards(folders);
  const StoredCampaign whole{out, parts.front().campaign, stamp_of(parts.front().campaign, {})};
  const std::string text = campaign_text(whole.campaign, whole.stamp);
  refuse_other_folder_without_rows(out, text);
  const FolderLock lock(out);
  refuse_other_folder_without_rows(out, text);
  const MergedStatistics merged = add_statistics(parts); // before anything is written: may refuse
  std::filesystem::remove(out / statistics_file);        // of an interrupted merge
  write_file(out / campaign_file, text);
  OutputFile broken(out / broken_runs_file, OutputFile::From::beginning);
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
    bytes += append_broken(parts[i], merged.broken_bytes[i], i == 0, broken);
  broken.sync();
  broken.close();
  write_file(out / statistics_file, streaming_statistics_text(whole, merged.all, bytes));
  return write_streaming_statistics(whole, merged.all, whole.campaign.statistics);
}

} // namespace wingspread
