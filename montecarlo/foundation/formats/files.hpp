/// Files: written whole or not at all, and read within limits.
#pragma once

#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/output_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// How a file's name ends while the file is being written: .NAME.part; finish() gives it its own name.
inline constexpr std::string_view part_suffix = ".part";

/// Replaces a file atomically: writes .NAME.part, syncs it to the device and renames it. Readers, and a crash, find
/// the old file or the new one. Without finish() the part is removed. A special file (/dev/stdout) is written directly.
/// At most one object at a time, because a signal handler has to find the part.
class WholeFile {
public:
  /// All functions throw as refuse_path (machine_error.hpp).
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::string_view text) { part_.write(text); }
  /// The path before finish(), for a library that opens files itself.
  [[nodiscard]] const std::filesystem::path& part() const { return part_.path(); }
  /// Moves the file to its path. Call once, as the last function.
  void finish();

private:
  std::filesystem::path path_;
  OutputFile part_;
};

/// Writes a whole file.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Removes the part of an unfinished WholeFile. For a signal handler that ends the program.
void drop_part() noexcept;

/// Removes the folder's files .NAME.part, which a killed program left. NAME.part without the dot may be a user's.
void remove_parts(const std::filesystem::path& folder);

/// Makes the folder and its parents. @throws as refuse_path
/// @param expected for the message where that fails
void make_folder(const std::filesystem::path& path,
                 const char* expected = "a folder that can be made");

/// The largest text file that is read whole.
inline constexpr std::size_t most_text_bytes = std::size_t{64} << 20;

/// The bytes of a file; nothing if the path does not exist or is a folder.
/// @throws SpecError for a special file or more than most_text_bytes; MachineError if reading fails
[[nodiscard]] std::optional<std::string> read_text(const std::filesystem::path& path);

} // namespace wingspread
