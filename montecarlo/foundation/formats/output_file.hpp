/// A file written block by block. Every failed write throws.
#pragma once

#include <filesystem>
#include <string_view>

namespace wingspread {

class OutputFile {
public:
  enum class From {
    beginning, ///< truncates an existing file
    end        ///< appends
  };

  /// All functions throw as refuse_path (machine_error.hpp).
  /// @param called name for the messages; default: the path
  OutputFile(std::filesystem::path path, From from, std::filesystem::path called = {});
  /// Closes the file unless close() did, and ignores errors, because an exception may be under way.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  /// Writes all of the text, even if signals interrupt the write.
  void write(std::string_view text);
  /// Returns when all data are on the device.
  void sync();
  /// Closes the file; some file systems report a full disk only here. Call once, as the last function.
  void close();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_, called_;
  int file_ = -1;
};

/// Returns when the folder's entries are on the device. Call it after making or renaming a file in the folder.
void sync_folder(const std::filesystem::path& folder);

} // namespace wingspread
