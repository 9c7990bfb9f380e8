#include "montecarlo/results/streaming/streaming_folder.hpp"

#include "montecarlo/engine/runs/row_reader.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/input_file.hpp"
#include "montecarlo/results/results_folder/row_columns.hpp"
#include "montecarlo/results/streaming/streaming_summary.hpp"
#include "montecarlo/results/summary/judge_campaign.hpp"
#include "montecarlo/results/summary/summary_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace wingspread {
namespace {

constexpr std::string_view magic = "wingspread run --no-rows, 2";

std::string broken_header(const ResultNames& names) {
  std::string header;
  append_header(header, names);
  return header;
}

/// The required static margins of each row.
std::vector<std::vector<double>> margins_of(const RunPlan& plan, const Batch& batch) {
  const auto takes_margins = [](const Requirement& requirement) {
    return requirement.static_margin.has_value();
  };
  std::vector<std::vector<double>> margins(batch.rows.size());
  if (std::ranges::none_of(plan.campaign().requirements, takes_margins)) return margins;
  Results rows(plan.names());
  for (const ResultRow& row : batch.rows) rows.append(row);
  for (const Column& column : static_margin_columns(plan.campaign(), rows))
    for (std::size_t i = 0; i < margins.size(); ++i) margins[i].push_back(column.values[i]);
  return margins;
}

/// The campaign and its shard: the shards of a campaign have the same hash.
std::string identity_of(const Stamp& stamp) {
  return stamp.shard ? stamp.hash + ", " + describe(stamp.shard) : stamp.hash;
}

/// The file's length; 0 if it is missing.
std::uint64_t bytes_of(const std::filesystem::path& path) {
  std::error_code missing;
  const std::uint64_t bytes = std::filesystem::file_size(path, missing);
  return missing ? 0 : bytes;
}

[[noreturn]] void refuse(const char* found, const char* expected) {
  throw SpecError({{"", "--no-rows", found, expected}});
}

} // namespace

void refuse_without_rows(const Campaign& campaign) {
  if (campaign.sampling.design != DesignKind::random)
    refuse("dependent draws", "the design \"random\": bounds from replicates need the rows");
  if (!campaign.until.empty()) refuse("stopping goals", "none: interim analyses need the rows");
  if (!campaign.cases.empty())
    refuse("a campaign with cases", "one without: run each case's campaign by itself");
  if (!campaign.sampling.extended_from.empty())
    refuse("a campaign that was extended", "a number of runs that is fixed beforehand");
}

std::string streaming_statistics_text(const StoredCampaign& stored,
                                      const StreamingStatistics& statistics,
                                      std::uint64_t broken_bytes) {
  StateWriter to;
  to.put(magic);
  to.put(std::string_view(identity_of(stored.stamp)));
  to.put(std::string_view(stored.stamp.version));
  to.put(broken_bytes);
  statistics.write(to);
  return std::move(to).finish();
}

StoredStatistics read_streaming_statistics(const StoredCampaign& stored) {
  const std::filesystem::path path = stored.folder / statistics_file;
  InputFile in(path);
  StateReader from({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()},
                   path.string());
  if (from.get_text() != magic) throw from.broken("a format of this version");
  if (from.get_text() != identity_of(stored.stamp))
    throw from.broken("the campaign and shard of campaign.json");
  (void)from.get_text();
  const auto broken_bytes = from.get<std::uint64_t>();
  StoredStatistics read{
      StreamingStatistics(stored.campaign, RunPlan(stored.campaign).names(), from), broken_bytes};
  if (!from.at_end()) throw from.broken("no bytes after the end");
  const std::filesystem::path broken = stored.folder / broken_runs_file;
  if (const std::uint64_t there = bytes_of(broken); there < broken_bytes)
    throw SpecError({{broken.string(), "", fmt::format("{} bytes", there),
                      fmt::format("at least {}, as {} says: rows were lost, so run it into a new "
                                  "folder",
                                  broken_bytes, statistics_file)}});
  return read;
}

Results read_broken_runs(const StoredCampaign& stored, std::uint64_t bytes) {
  const std::filesystem::path path = stored.folder / broken_runs_file;
  const ResultNames names = RunPlan(stored.campaign).names();
  Results results(names);
  InputFile in(path);
  RowReader reader(in, path.string(), names, UnterminatedRow::drop);
  while (reader.next() && reader.complete_bytes() <= bytes) results.append(reader.row());
  return results;
}

Summary write_streaming_statistics(const StoredCampaign& stored,
                                   const StreamingStatistics& statistics,
                                   const StatisticsSpec& spec) {
  Summary summary = streaming_summary(stored, statistics, spec);
  write_summary_files(stored, summary);
  write_file(stored.folder / extremes_file,
             extremes_csv(RunPlan(stored.campaign).names(), statistics));
  return summary;
}

StreamingFolder::StreamingFolder(std::filesystem::path folder, const RunPlan& plan,
                                 const std::optional<Shard>& shard, bool resume)
    : plan_(&plan), stored_{std::move(folder), plan.campaign(), stamp_of(plan.campaign(), shard)} {
  refuse_without_rows(stored_.campaign);
  lock_campaign_folder(lock_, stored_.folder, resume);
  if (is_new_folder(stored_.folder)) return;
  const StoredCampaign there = read_stored_campaign(stored_.folder);
  refuse_other_campaign(there, stored_.campaign, stored_.stamp);
  if (there.campaign.sampling.runs != stored_.campaign.sampling.runs)
    throw SpecError({{(stored_.folder / campaign_file).string(), "/sampling/runs",
                      std::to_string(there.campaign.sampling.runs),
                      fmt::format("{}: a campaign without rows cannot be extended",
                                  stored_.campaign.sampling.runs)}});
  if (std::filesystem::exists(stored_.folder / runs_file))
    throw SpecError(
        {{stored_.folder.string(), "", "a folder of a campaign that keeps its rows",
          "one that was begun with --no-rows (without it --resume continues this one)"}});
}

bool StreamingFolder::begin(Evaluator& evaluator) {
  if (is_streaming_folder(stored_.folder)) {
    StoredStatistics read = read_streaming_statistics(stored_);
    statistics_.emplace(std::move(read.statistics));
    resumed_ = statistics_->runs();
    open_broken(read.broken_bytes);
    return true;
  }
  Results pilot(plan_->names());
  Batch own; // the pilot's runs that belong to this shard
  const RunRange range{0, std::min<long>(grid_pilot_runs, plan_->campaign().sampling.runs)};
  const RunRange runs = stored_.runs();
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) {
      pilot.append(row);
      if (runs.first <= row.run && row.run < runs.last) own.rows.push_back(row);
    }
  };
  if (evaluator.make(*plan_, range, {keep}) < range.size()) return false;
  statistics_.emplace(plan_->campaign(), plan_->names(), pilot);
  write_file(stored_.folder / campaign_file, campaign_text(stored_.campaign, stored_.stamp));
  write_file(stored_.folder / statistics_file, streaming_statistics_text(stored_, *statistics_, 0));
  open_broken(0);
  add(own);
  return true;
}

/// Opens broken_runs.csv at the length recorded in the statistics, and cuts off the rest.
void StreamingFolder::open_broken(std::uint64_t bytes) {
  const std::filesystem::path path = stored_.folder / broken_runs_file;
  std::error_code why;
  const std::uint64_t there = bytes_of(path);
  if (bytes > 0) refuse_other_columns(path, plan_->names());
  if (there > bytes) std::filesystem::resize_file(path, bytes, why);
  if (why) refuse_path(path, why.value(), "a file that can be written");
  broken_.emplace(path, OutputFile::From::end);
  broken_bytes_ = bytes;
  if (bytes > 0) return;
  const std::string header = broken_header(plan_->names());
  broken_->write(header);
  broken_bytes_ = header.size();
}

RunRange StreamingFolder::remaining() const {
  const RunRange runs = stored_.runs();
  return {runs.first + count(), runs.last};
}

void StreamingFolder::add(const Batch& batch) {
  const std::vector<std::vector<double>> margins = margins_of(*plan_, batch);
  std::string csv;
  for (std::size_t i = 0; i < batch.rows.size(); ++i)
    if (statistics_->add(batch.rows[i], margins[i])) append_row(csv, batch.rows[i]);
  if (!csv.empty()) broken_->write(csv);
  broken_bytes_ += csv.size();
  if (Clock::now() - saved_ > std::chrono::seconds(30)) save();
}

void StreamingFolder::save() {
  broken_->sync(); // first, because statistics.bin records the length of this file
  write_file(stored_.folder / statistics_file,
             streaming_statistics_text(stored_, *statistics_, broken_bytes_));
  saved_ = Clock::now();
}

void StreamingFolder::finish() {
  if (!broken_) return; // stopped in the pilot
  save();
  broken_->close();
}

} // namespace wingspread
