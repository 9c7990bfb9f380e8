#include "montecarlo/results/checkpoint/checkpoint.hpp"

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/results/checkpoint/analysis_id.hpp"
#include "montecarlo/results/checkpoint/row_records.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <fmt/format.h>

#include <utility>

namespace wingspread {
namespace {

constexpr char analysis_mark = 'L';

/// Reads the first record: the identity of the study.
Json read_about(RecordReader& in, const std::filesystem::path& file) {
  if (!in.next())
    throw SpecError({{file.string(), "", "a checkpoint whose first record is damaged",
                      "one that names its study (remove the file to start again)"}});
  return parse_json(in.record(), file.string());
}

} // namespace

void refuse_other_study(const std::filesystem::path& file, const Json& there, const Json& ours) {
  std::vector<Problem> problems;
  const Json values = ours.flatten();
  for (const auto& [pointer, value] : values.items()) {
    const Json::json_pointer at(pointer);
    Json found = there.contains(at) ? there.at(at) : Json();
    if (found.is_array()) found = found.size();
    if (found != value)
      problems.push_back(
          {file.string(), pointer, found.dump(), value.dump() + ", to continue what is there"});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

Json about_of_log(const std::filesystem::path& file) {
  RecordReader in(file);
  return read_about(in, file);
}

Checkpoint::Checkpoint(std::filesystem::path file, Json about)
    : file_(std::move(file)), about_(std::move(about)) {
  if (!std::filesystem::exists(file_)) return;
  in_.emplace(file_);
  const Json there = read_about(*in_, file_);
  refuse_other_study(file_, there, about_);
  refuse_other_study(file_, about_, there); // values recorded there that we do not have
  read_ahead();
}

void Checkpoint::read_ahead() {
  if (in_->next()) return;
  end_ = in_->end();
  damaged_ = in_->tail() == RecordsTail::damaged;
  in_.reset();
}

bool Checkpoint::has(char mark) const { return in_ && in_->record().starts_with(mark); }

SpecError Checkpoint::other_analysis(const std::string& id) const {
  return SpecError({{file_.string(), "",
                     fmt::format("analysis {}: {}", analyses_,
                                 has(analysis_mark) ? in_->record().substr(1) : "cut short"),
                     id + ": what this study asks for (pass the same shards with --from again)"}});
}

bool Checkpoint::has_next(const RunPlan& plan, RunRange range) const {
  return in_ && in_->record() == analysis_mark + analysis_id(plan, range);
}

void Checkpoint::begin(const std::string& id) {
  if (!out_ && end_)
    out_.emplace(file_, *end_);
  else if (!out_)
    out_.emplace(file_, about_.dump());
  out_->add(analysis_mark + id);
}

long Checkpoint::enter(const RunPlan& plan, RunRange range, const BatchSink& sink,
                       const std::atomic<bool>& stop) {
  const std::string id = analysis_id(plan, range);
  ++analyses_;
  if (!in_) {
    begin(id);
    return 0;
  }
  if (in_->record() != analysis_mark + id) throw other_analysis(id);
  read_ahead();
  RunRange left = range;
  while (has(rows_mark) && !stop) {
    Batch batch{rows_of_record(in_->record(), plan, left, file_.string()), {}};
    left.first += std::ssize(batch.rows);
    rows_ = read_ += std::ssize(batch.rows);
    read_ahead();
    if (!in_) refuse_other_row(plan, batch.rows.back(), file_);
    if (sink.wants_csv)
      for (const ResultRow& row : batch.rows) append_row(batch.csv, row);
    sink.take(batch);
  }
  if (in_ && !stop && (left.size() > 0 || !has(analysis_mark))) throw other_analysis(id);
  return range.size() - left.size();
}

void Checkpoint::add(const Batch& batch) {
  if (!out_) out_.emplace(file_, *end_);
  for_each_record(batch.rows, [&](std::string_view record) { out_->add(record); });
  rows_ += std::ssize(batch.rows);
  if (Clock::now() - synced_ < std::chrono::seconds(5)) return;
  sync();
}

void Checkpoint::sync() {
  if (out_) out_->sync();
  synced_ = Clock::now();
}

} // namespace wingspread
