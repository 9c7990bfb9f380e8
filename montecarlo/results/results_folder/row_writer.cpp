#include "montecarlo/results/results_folder/row_writer.hpp"

#include "montecarlo/results/results_folder/row_columns.hpp"

#include <fmt/format.h>

#include <utility>

namespace wingspread {
RowWriter::RowWriter(std::filesystem::path file, const ResultNames& names)
    : file_(std::move(file)), names_(names), results_(names) {}

void RowWriter::continue_after(ResultsFile&& read, long first) {
  if (read.complete_bytes > 0) refuse_other_columns(file_, names_);
  refuse_gaps(read.results, first, file_);
  std::error_code why;
  if (read.unterminated) std::filesystem::resize_file(file_, read.complete_bytes, why);
  if (why) refuse_path(file_, why.value(), "a file that can be written");
  results_ = std::move(read.results);
  count_ = std::ssize(results_.runs);
}

void RowWriter::open() {
  out_.emplace(file_, OutputFile::From::end);
  if (std::filesystem::file_size(file_) > 0) return;
  std::string header;
  append_header(header, names_);
  out_->write(header);
}

void RowWriter::add(const Batch& batch) {
  out_->write(batch.csv);
  count_ += std::ssize(batch.rows);
  keep(batch);
  if (Clock::now() - synced_ < std::chrono::seconds(10)) return;
  out_->sync();
  synced_ = Clock::now();
}

void RowWriter::keep(const Batch& batch) {
  if (no_room_) return;
  try {
    for (const ResultRow& row : batch.rows) results_.append(row);
  } catch (const MachineError& error) {
    no_room_ = error;
    results_ = {};
  }
}

void RowWriter::finish() {
  out_->sync();
  out_->close();
}

const Results& RowWriter::results() const {
  if (no_room_) throw *no_room_;
  return results_;
}

void refuse_gaps(const Results& results, long first, const std::filesystem::path& file) {
  for (std::size_t i = 0; i < results.size(); ++i)
    if (const long expected = first + static_cast<long>(i); results.runs[i] != expected)
      throw SpecError(
          {{file.string(), "", fmt::format("run {}", results.runs[i]),
            fmt::format("run {}, the next one: delete the rows from run {} on, and --resume makes "
                        "them again",
                        expected, results.runs[i])}});
}

} // namespace wingspread
