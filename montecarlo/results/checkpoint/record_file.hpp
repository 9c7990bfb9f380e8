/// Append-only file of records. A torn or altered tail is detected and ignored.
///
///   magic                                   a line of text
///   size u32 · sum u64 · size bytes         a record; repeated
///
/// The sum is FNV-1a over size and bytes, starting from the sum of the record before. So a changed byte invalidates its
/// record, and a lost, doubled or moved record the next one. Reading ends at the first invalid record.
#pragma once

#include "montecarlo/foundation/formats/input_file.hpp"
#include "montecarlo/foundation/formats/output_file.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// Longest record. Heuristic: records have some 64 KiB. A larger size counts as damage, so that damaged bytes do not
/// cause a huge allocation.
inline constexpr std::size_t most_record_bytes = std::size_t{64} << 20;

/// The end of the valid records, where new records are appended.
struct RecordsEnd {
  std::size_t bytes = 0; ///< length up to the last valid record
  std::uint64_t sum = 0; ///< of that record
};

/// The state of the file behind the last valid record.
enum class RecordsTail {
  clean,   ///< nothing
  cut_off, ///< less than a record: left by a crash
  damaged  ///< bytes that are no valid record
};

class RecordReader {
public:
  /// @throws SpecError if the file does not begin with `magic`; as InputFile does
  explicit RecordReader(const std::filesystem::path& path);

  /// Reads the next record; false if no valid one is left.
  [[nodiscard]] bool next();
  /// The record read last; next() overwrites the record.
  [[nodiscard]] const std::string& record() const { return record_; }

  /// The end of the record read last.
  [[nodiscard]] RecordsEnd end() const { return end_; }
  /// @pre next() returned false
  [[nodiscard]] RecordsTail tail() const { return tail_; }

private:
  InputFile in_;
  std::string record_;
  RecordsEnd end_;
  RecordsTail tail_ = RecordsTail::clean;
};

class RecordWriter {
public:
  /// Creates a file with its first record, atomically.
  RecordWriter(const std::filesystem::path& path, std::string_view first);
  /// Appends after the last valid record, and cuts off what follows.
  /// @throws as refuse_path (machine_error.hpp), here and below
  RecordWriter(const std::filesystem::path& path, RecordsEnd end);

  void add(std::string_view record);
  /// Returns when everything is on the device.
  void sync() { out_->sync(); }

private:
  std::optional<OutputFile> out_;
  std::string framed_;
  std::uint64_t sum_ = 0;
};

} // namespace wingspread
