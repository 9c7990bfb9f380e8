#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/results/checkpoint/analysis_id.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {
namespace {

/// The stamp in a shard's checkpoint.
Stamp stamp_in(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / checkpoint_file;
  if (!std::filesystem::exists(path))
    throw SpecError({{folder.string(), "", "no " + std::string(checkpoint_file) + " in it",
                      "a shard of a study: the folder of --out with --shard"}});
  const Json about = about_of_log(path);
  std::vector<Problem> problems;
  Stamp stamp = read_stamp(JsonCursor(about, path.string(), problems));
  if (problems.empty() && !stamp.shard)
    problems.push_back({path.string(), "", "a whole study", "a shard of a study"});
  if (!problems.empty()) throw SpecError(std::move(problems));
  return stamp;
}

bool is_finished(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / shard_file);
}

/// The study's identity with a shard in its stamp.
Json about_shard(Json about, const Shard& shard) {
  about[stamp_key]["shard"] = {{"index", shard.index}, {"of", shard.of}};
  return about;
}

/// All shards in the order of their runs. @throws unless each shard is there once and finished
std::vector<Part> parts_of(const std::vector<std::filesystem::path>& folders, long runs,
                           const ShardMaker& maker) {
  std::vector<Part> parts;
  for (const std::filesystem::path& folder : folders) {
    const Stamp stamp = stamp_in(folder);
    Part& part = parts.emplace_back(Part{folder, folder, stamp, shard_runs(runs, stamp.shard)});
    if (is_finished(folder) && part.own.size() > 0) part.present.push_back(part.own);
  }
  PartFaults faults;
  find_doubles(parts, faults);
  find_missing(parts, runs, maker, faults);
  faults.refuse();
  std::ranges::sort(parts, {}, [](const Part& part) { return part.own.first; });
  return parts;
}

} // namespace

ShardCheckpoints::ShardCheckpoints(const std::vector<std::filesystem::path>& folders,
                                   const Json& about, long runs, const ShardMaker& maker,
                                   Evaluator& inner, const std::atomic<bool>& stop)
    : inner_(inner), stop_(stop) {
  if (folders.empty()) return;
  // Refuses folders of other studies first: missing shards are reported only for this study.
  for (const std::filesystem::path& folder : folders)
    (void)Checkpoint(folder / checkpoint_file, about_shard(about, *stamp_in(folder).shard));
  for (const Part& part : parts_of(folders, runs, maker)) {
    const Shard shard = *part.stamp.shard;
    if (part.own.size() > 0)
      shards_.emplace_back(shard, part.folder / checkpoint_file, about_shard(about, shard));
  }
}

bool ShardCheckpoints::have(const RunPlan& plan, RunRange range) const {
  return !shards_.empty() && std::ranges::all_of(shards_, [&](const ShardLog& each) {
    return each.log.has_next(plan, part_of_analysis(range, each.shard));
  });
}

long ShardCheckpoints::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  if (!have(plan, range)) return inner_.make(plan, range, sink);
  long handed_on = 0;
  const auto count = [&](const Batch& batch) {
    read_ += std::ssize(batch.rows); // before sink.take(), which shows the progress
    sink.take(batch);
  };
  for (ShardLog& each : shards_) {
    const RunRange part = part_of_analysis(range, each.shard);
    const long got = each.log.enter(plan, part, {count, sink.wants_csv}, stop_);
    handed_on += got;
    if (stop_) break;
    if (got < part.size())
      throw SpecError({{each.log.file().string(), "", "missing or damaged rows",
                        "all rows of a finished shard: make it again"}});
  }
  return handed_on;
}

RunRange part_of_analysis(RunRange range, const Shard& shard) {
  const RunRange part = shard_runs(range.size(), shard);
  return {range.first + part.first, range.first + part.last};
}

bool is_shard_folder(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / checkpoint_file) &&
         about_of_log(folder / checkpoint_file)[stamp_key].contains("shard");
}

} // namespace wingspread
