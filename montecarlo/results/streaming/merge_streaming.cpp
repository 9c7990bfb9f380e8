/// Merges shards made with --no-rows.
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/input_file.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace wingspread {
namespace {

/// @throws SpecError unless the folders, sorted by first run, hold all runs of one campaign
void refuse_unlike(const std::vector<StoredCampaign>& parts) {
  std::vector<Problem> problems;
  const StoredCampaign& first = parts.front();
  long next = 0;
  for (const StoredCampaign& part : parts) {
    const std::string folder = part.folder.string();
    if (!is_streaming_folder(part.folder))
      problems.push_back({folder, "", "a folder with rows", "folders of --no-rows, as the others"});
    if (part.stamp.hash != first.stamp.hash || part.stamp.version != first.stamp.version)
      problems.push_back(
          {folder, "",
           fmt::format("campaign {} by version {}", part.stamp.hash, part.stamp.version),
           fmt::format("{} by {}, as in {}", first.stamp.hash, first.stamp.version,
                       first.folder.string())});
    if (part.runs().first != next)
      problems.push_back({folder, "", fmt::format("runs from {}", part.runs().first),
                          fmt::format("run {}: each run in one folder", next)});
    next = part.runs().last;
  }
  if (next != first.campaign.sampling.runs)
    problems.push_back(
        {"", "",
         fmt::format("no folder with runs {} to {}", next, first.campaign.sampling.runs - 1),
         fmt::format("folders with all of the campaign's {} runs", first.campaign.sampling.runs)});
  if (!problems.empty()) throw SpecError(std::move(problems));
}

/// Appends one shard's broken_runs.csv. @return bytes written
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
  std::vector<StoredCampaign> parts;
  for (const std::filesystem::path& folder : folders) parts.push_back(read_stored_campaign(folder));
  std::ranges::sort(parts, {}, [](const StoredCampaign& part) { return part.runs().first; });
  refuse_unlike(parts);
  refuse_used_folder(out, "a new or an empty folder");
  for (const StoredCampaign& part : parts)
    if (const long done = read_streaming_statistics(part).statistics.runs();
        done < part.runs().size())
      throw SpecError(
          {{part.folder.string(), "", fmt::format("{} of {} runs", done, part.runs().size()),
            "all of them: `wingspread run` with --no-rows and --resume goes on"}});
  const FolderLock lock(out);
  const StoredCampaign whole{out, parts.front().campaign, stamp_of(parts.front().campaign, {})};
  write_file(out / campaign_file, campaign_text(whole.campaign, whole.stamp));
  OutputFile broken(out / broken_runs_file, OutputFile::From::beginning);
  std::optional<StoredStatistics> all;
  for (const StoredCampaign& part : parts) {
    StoredStatistics read = read_streaming_statistics(part);
    const std::uint64_t bytes = append_broken(part, read.broken_bytes, !all, broken);
    if (all)
      all->statistics.add(read.statistics);
    else
      all.emplace(StoredStatistics{std::move(read.statistics)});
    all->broken_bytes += bytes;
  }
  broken.sync();
  broken.close();
  write_file(out / statistics_file,
             streaming_statistics_text(whole, all->statistics, all->broken_bytes));
  return write_streaming_statistics(whole, all->statistics, whole.campaign.statistics);
}

} // namespace wingspread
