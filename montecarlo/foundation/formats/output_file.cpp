#include "montecarlo/foundation/formats/output_file.hpp"

#include "montecarlo/foundation/formats/machine_error.hpp"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

namespace wingspread {
namespace {

constexpr const char* writable_file = "a file that can be written";

/// Repeats a system call that a signal interrupted.
template <class Call> auto without_signals(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

/// Pipes and some network drives cannot sync.
bool cannot_sync(int error) { return error == EINVAL || error == ENOTSUP || error == EROFS; }

} // namespace

OutputFile::OutputFile(std::filesystem::path path, From from, std::filesystem::path called)
    : path_(std::move(path)), called_(called.empty() ? path_ : std::move(called)) {
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (from == From::end ? O_APPEND : O_TRUNC);
  file_ = without_signals([&] { return open(path_.c_str(), flags, 0666); });
  if (file_ < 0) refuse_path(called_, errno, writable_file);
}

OutputFile::~OutputFile() {
  if (file_ >= 0) ::close(file_);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), called_(std::move(other.called_)),
      file_(std::exchange(other.file_, -1)) {}

void OutputFile::write(std::string_view text) {
  while (!text.empty()) {
    const auto written = without_signals([&] { return ::write(file_, text.data(), text.size()); });
    if (written < 0) refuse_path(called_, errno, writable_file);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFile::sync() {
  const int failed = without_signals([&] { return fsync(file_); });
  if (failed != 0 && !cannot_sync(errno)) refuse_path(called_, errno, writable_file);
}

void OutputFile::close() {
  // on Linux the file is closed whatever it returns, also when a signal came
  const int failed = ::close(std::exchange(file_, -1));
  if (failed != 0 && errno != EINTR) refuse_path(called_, errno, writable_file);
}

void sync_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder.empty() ? "." : folder;
  const int file =
      without_signals([&] { return open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (file < 0) return; // a folder may be writable but not readable
  const int failed = without_signals([&] { return fsync(file); }) == 0 ? 0 : errno;
  ::close(file);
  if (failed != 0 && !cannot_sync(failed))
    refuse_path(path, failed, "a folder that can be written");
}

} // namespace wingspread
