/// Regular files as streams. A read error throws instead of looking like the end of the file.
#pragma once

#include <filesystem>
#include <istream>
#include <streambuf>
#include <vector>

namespace wingspread {

/// A stream buffer on a regular file. Pipes and devices are refused: they may never end.
class InputBuffer : public std::streambuf {
public:
  /// @throws SpecError if the path is no regular file; MachineError if it cannot be read
  explicit InputBuffer(std::filesystem::path path);
  ~InputBuffer() override;
  InputBuffer(const InputBuffer&) = delete;
  InputBuffer& operator=(const InputBuffer&) = delete;

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Continues reading at a byte.
  void seek(std::size_t byte);

protected:
  int_type underflow() override;

private:
  std::filesystem::path path_;
  int file_ = -1;
  std::size_t size_ = 0; ///< at opening
  std::vector<char> block_;
};

/// An input stream on a regular file. Reading throws MachineError if the device fails.
class InputFile : public std::istream {
public:
  explicit InputFile(const std::filesystem::path& path);
  [[nodiscard]] std::size_t size() const { return buffer_.size(); }
  void seek(std::size_t byte);

private:
  InputBuffer buffer_;
};

} // namespace wingspread
