/// A file that is written block by block, to the last byte or not without a word.
#pragma once

#include <filesystem>
#include <string_view>

namespace wingspread {

class OutputFile {
public:
  enum class From {
    beginning, ///< of a new file, or in place of what was there
    end        ///< behind what is there
  };

  /// @param called how messages name it, where that is not its path
  /// @throws as refuse_path (machine_error.hpp) does, here and below
  OutputFile(std::filesystem::path path, From from, std::filesystem::path called = {});
  /// Closes it without a word, for when something else has gone wrong.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  /// All of the text: what a signal breaks off, or is taken in part, is gone on with.
  void write(std::string_view text);
  /// Returns when all is on the device.
  void sync();
  /// Closes it; some file systems tell only then that there was no room. Once, and as the last.
  void close();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_, called_;
  int file_ = -1;
};

/// Returns when the folder's list of names is on the device: after a file in it was made or renamed.
void sync_folder(const std::filesystem::path& folder);

} // namespace wingspread
