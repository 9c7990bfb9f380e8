#include "montecarlo/foundation/formats/input_file.hpp"

#include "montecarlo/foundation/formats/machine_error.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

namespace wingspread {
namespace {

constexpr const char* readable_file = "a file that can be read";
constexpr std::size_t read_bytes = 1 << 16;

/// The kind of a special file.
const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  return S_ISSOCK(mode) ? "a socket" : "a device";
}

} // namespace

InputBuffer::InputBuffer(std::filesystem::path path) : path_(std::move(path)), block_(read_bytes) {
  do
    file_ =
        open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); // a pipe would wait for its writer
  while (file_ < 0 && errno == EINTR);
  if (file_ < 0) refuse_path(path_, errno, readable_file);
  struct stat found {};
  if (fstat(file_, &found) == 0 && S_ISREG(found.st_mode)) {
    size_ = static_cast<std::size_t>(found.st_size);
    return;
  }
  close(std::exchange(file_, -1));
  throw SpecError({{path_.string(), "", kind_of(found.st_mode), "a regular file"}});
}

InputBuffer::~InputBuffer() {
  if (file_ >= 0) close(file_);
}

void InputBuffer::seek(std::size_t byte) {
  if (lseek(file_, static_cast<off_t>(byte), SEEK_SET) < 0)
    refuse_path(path_, errno, readable_file);
  setg(nullptr, nullptr, nullptr);
}

InputBuffer::int_type InputBuffer::underflow() {
  ssize_t got = 0;
  do got = read(file_, block_.data(), block_.size());
  while (got < 0 && errno == EINTR);
  if (got < 0) refuse_path(path_, errno, readable_file);
  if (got == 0) return traits_type::eof();
  setg(block_.data(), block_.data(), block_.data() + got);
  return traits_type::to_int_type(block_.front());
}

InputFile::InputFile(const std::filesystem::path& path) : std::istream(nullptr), buffer_(path) {
  rdbuf(&buffer_);
  exceptions(std::ios::badbit); // lets exceptions of the buffer reach the caller
}

void InputFile::seek(std::size_t byte) {
  clear();
  buffer_.seek(byte);
}

} // namespace wingspread
