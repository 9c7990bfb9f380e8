/// A file of records that grows: whatever cuts it off or changes it, what is read of it was written so.
///
///   magic                                   a line of text
///   size u32 · sum u64 · size bytes         a record; so on to the end
///
/// The sum is FNV-1a over the size and the bytes, begun with the sum of the record before: a step of it is one to one,
/// so that a change of any one byte shows in its own record, and a record that is lost, doubled or moved in the next.
/// From the first record that does not hold, nothing is read.
#pragma once

#include "montecarlo/foundation/formats/input_file.hpp"
#include "montecarlo/foundation/formats/output_file.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// No record is longer: a size beyond is no size.
inline constexpr std::size_t most_record_bytes = std::size_t{64} << 20;

/// Where a file of records can be gone on with.
struct RecordsEnd {
  std::size_t bytes = 0; ///< up to its last record that holds
  std::uint64_t sum = 0; ///< of that record
};

/// How it ends behind that.
enum class RecordsTail {
  clean,   ///< nothing follows
  cut_off, ///< less than a record: what a crash leaves
  damaged  ///< something that nobody wrote so
};

class RecordReader {
public:
  /// @throws SpecError when it is no file of records; as InputFile does
  explicit RecordReader(const std::filesystem::path& path);

  /// Reads the next record; false when there is none that holds.
  [[nodiscard]] bool next();
  /// The one that was read; the next one takes its place.
  [[nodiscard]] const std::string& record() const { return record_; }

  /// Behind the record that was read last.
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
  /// Begins a file with its first record: whole, or not at all.
  RecordWriter(const std::filesystem::path& path, std::string_view first);
  /// Goes on behind a file's last record that holds, and cuts off what follows it.
  /// @throws as refuse_path (machine_error.hpp) does, here and below
  RecordWriter(const std::filesystem::path& path, RecordsEnd end);

  void add(std::string_view record);
  /// Returns when all is on the device.
  void sync() { out_->sync(); }

private:
  std::optional<OutputFile> out_;
  std::string framed_;
  std::uint64_t sum_ = 0;
};

} // namespace wingspread
