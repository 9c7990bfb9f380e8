#include "montecarlo/folder/row_writer.hpp"

#include "montecarlo/formats/files.hpp"

#include <fmt/format.h>

#include <utility>

namespace wingspread {

RowWriter::RowWriter(std::filesystem::path file, const ResultNames& names)
    : file_(std::move(file)), results_(names) {}

void RowWriter::go_on_behind(ResultsFile&& read, long first) {
  refuse_gaps(read.results, first, file_);
  if (std::filesystem::exists(file_)) std::filesystem::resize_file(file_, read.complete_bytes);
  results_ = std::move(read.results);
}

void RowWriter::open(const ResultNames& names) {
  out_.open(file_, std::ios::binary | std::ios::app);
  if (!out_) throw unwritable(file_);
  if (std::filesystem::file_size(file_) > 0) return;
  std::string header;
  append_header(header, names);
  if (!(out_ << header << std::flush)) throw unwritable(file_);
}

void RowWriter::add(const Batch& batch) {
  for (const ResultRow& row : batch.rows) results_.append(row);
  if (!(out_ << batch.csv << std::flush)) throw unwritable(file_);
}

void refuse_gaps(const Results& results, long first, const std::filesystem::path& file) {
  for (std::size_t i = 0; i < results.size(); ++i)
    if (const long expected = first + static_cast<long>(i); results.runs[i] != expected)
      throw SpecError({{file.string(), "", fmt::format("run {}", results.runs[i]),
                        fmt::format("run {}, the next one", expected)}});
}

} // namespace wingspread
