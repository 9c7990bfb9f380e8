/// A file that is read from its beginning to its end: what is there and nothing else, or an error.
#pragma once

#include <filesystem>
#include <istream>
#include <streambuf>
#include <vector>

namespace wingspread {

/// The bytes of a regular file. Of a pipe or a device nobody knows where it ends.
class InputBuffer : public std::streambuf {
public:
  /// @throws SpecError when there is no such file, or it is of another kind; MachineError when it cannot be read
  explicit InputBuffer(std::filesystem::path path);
  ~InputBuffer() override;
  InputBuffer(const InputBuffer&) = delete;
  InputBuffer& operator=(const InputBuffer&) = delete;

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Goes on at that byte.
  void seek(std::size_t byte);

protected:
  int_type underflow() override;

private:
  std::filesystem::path path_;
  int file_ = -1;
  std::size_t size_ = 0; ///< when it was opened
  std::vector<char> block_;
};

/// The same as a stream. A device that fails is not taken for the end of the file: it throws MachineError.
class InputFile : public std::istream {
public:
  explicit InputFile(const std::filesystem::path& path);
  [[nodiscard]] std::size_t size() const { return buffer_.size(); }
  void seek(std::size_t byte);

private:
  InputBuffer buffer_;
};

} // namespace wingspread
