/// Files: written whole or not at all, and read within limits.
#pragma once

#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/output_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace wingspread {

/// The end of the name under which a file is written before it gets its own.
inline constexpr std::string_view part_suffix = ".part";

/// A file that is written beside its place and moved there when it is on the device: whoever reads it, and whatever
/// crashes, there is the old one or the new one. Nothing is left of it when that cannot be done. What is no regular
/// file (/dev/stdout) is written as it stands. One at a time.
class WholeFile {
public:
  /// @throws as refuse_path (machine_error.hpp) does, here and below
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::string_view text) { part_.write(text); }
  /// Where it is until then, for a library that writes files by their names.
  [[nodiscard]] const std::filesystem::path& part() const { return part_.path(); }
  /// Moves it to its place. Once, and as the last.
  void finish();

private:
  std::filesystem::path path_;
  OutputFile part_;
};

/// Writes a whole file.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Takes away the beginning of a file that is still to be finished. For a signal's handler that ends the program.
void drop_part() noexcept;

/// Takes away what a program that was killed had begun in the folder.
void remove_parts(const std::filesystem::path& folder);

/// Makes the folder and those it lies in. @throws as refuse_path does
void make_folder(const std::filesystem::path& path);

/// A text that a person may have written, or a program for a person's eyes, is no longer.
inline constexpr std::size_t most_text_bytes = std::size_t{64} << 20;

/// The bytes of a file; nothing when there is no such file, or a folder in its place.
/// @throws SpecError when it is no regular file, or longer than most_text_bytes; MachineError when it cannot be read
[[nodiscard]] std::optional<std::string> read_text(const std::filesystem::path& path);

} // namespace wingspread
