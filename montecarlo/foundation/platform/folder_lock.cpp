#include "montecarlo/foundation/platform/folder_lock.hpp"

#include "montecarlo/foundation/formats/files.hpp"

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <fcntl.h>
#include <fstream>
#include <optional>
#include <signal.h>
#include <string>
#include <unistd.h>
#include <utility>

namespace wingspread {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Identifies the machine's current boot; empty if unknown.
std::string boot_name() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string name;
  return std::getline(in, name) ? name : "";
}

/// The file's content: "process 123 on HOST, boot BOOT".
std::string own_name() {
  return fmt::format("process {} on {}, boot {}", getpid(), host_name(), boot_name());
}

std::string name_in(int file) {
  std::array<char, 512> text{};
  const auto size = pread(file, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : "";
}

/// Whether the named process is alive: on this machine, since its last boot. @param name as own_name()
bool is_alive(const std::string& name) {
  pid_t process = 0;
  constexpr std::size_t number_at = std::string_view("process ").size();
  if (name.size() <= number_at) return false;
  std::from_chars(name.data() + number_at, name.data() + name.size(), process);
  const bool of_this_boot =
      name.ends_with(fmt::format(" on {}, boot {}", host_name(), boot_name()));
  return of_this_boot && process > 0 && (kill(process, 0) == 0 || errno == EPERM);
}

std::string without_boot(const std::string& holder) {
  return holder.empty() ? "another process" : holder.substr(0, holder.find(", boot "));
}

[[noreturn]] void refuse_second(const std::filesystem::path& folder, const std::string& holder) {
  throw MachineError({folder.string(), "", without_boot(holder) + " at work in it",
                      "a folder that no other process writes to"});
}

int open_without_signals(const std::filesystem::path& path, int flags) {
  int file = -1;
  do file = open(path.c_str(), flags | O_CLOEXEC, 0666);
  while (file < 0 && errno == EINTR);
  return file;
}

int open_lock(const std::filesystem::path& path, const char* expected) {
  const int file = open_without_signals(path, O_RDWR | O_CREAT);
  if (file < 0) refuse_path(path, errno, expected);
  return file;
}

/// Whether this process cannot create or change the folder's lock. A missing folder can be created.
bool is_read_only(const std::filesystem::path& folder, const std::filesystem::path& path) {
  const auto may_write = [](const std::filesystem::path& its) {
    return faccessat(AT_FDCWD, its.c_str(), W_OK, AT_EACCESS) == 0 ||
           (errno != EACCES && errno != EROFS && errno != EPERM);
  };
  return !may_write(folder) || !may_write(path);
}

/// Locks the file without waiting for another holder. @return 0, or the error
int lock(int file) {
  for (;;) {
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return 0;
    if (errno != EINTR) return errno;
  }
}

/// Whether the path still names the open file; false if the file was removed or replaced.
bool is_at(int file, const std::filesystem::path& path) {
  struct stat open_file {
  }, named{};
  return fstat(file, &open_file) == 0 && stat(path.c_str(), &named) == 0 &&
         open_file.st_dev == named.st_dev && open_file.st_ino == named.st_ino;
}

/// Locks and returns the file; nothing if its last holder removed it between opening and locking.
std::optional<int> take(const std::filesystem::path& folder, const std::filesystem::path& path,
                        const char* expected) {
  const int file = open_lock(path, expected);
  const std::string holder = name_in(file);
  const int error = lock(file);
  const bool has_no_locks = error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP;
  if (error == 0 || (has_no_locks && !is_alive(holder))) {
    if (is_at(file, path)) return file;
    close(file);
    return std::nullopt;
  }
  close(file);
  if (error == EWOULDBLOCK || has_no_locks) refuse_second(folder, holder);
  refuse_path(path, error, expected);
}

/// The name in the lock's file if a process holds the lock; nothing if none does.
std::optional<std::string> name_of_holder(const std::filesystem::path& path) {
  const int file = open_without_signals(path, O_RDONLY);
  if (file < 0) return std::nullopt; // not locked
  std::string holder = name_in(file);
  const bool held = flock(file, LOCK_SH | LOCK_NB) != 0 &&
                    (errno == EWOULDBLOCK || (errno != EINTR && is_alive(holder)));
  close(file);
  return held ? std::optional(std::move(holder)) : std::nullopt;
}

/// Writes this process's name into the file. @return 0, or the error
int write_name(int file) {
  const std::string name = own_name();
  if (ftruncate(file, 0) != 0) return errno;
  for (std::size_t at = 0; at < name.size();) {
    const auto written = pwrite(file, name.data() + at, name.size() - at, static_cast<off_t>(at));
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) at += static_cast<std::size_t>(written);
  }
  return 0;
}

} // namespace

std::string holder_of(const std::filesystem::path& folder) {
  const std::optional<std::string> holder = name_of_holder(folder / lock_file);
  return holder ? without_boot(*holder) : "";
}

FolderLock::FolderLock(std::filesystem::path folder, For purpose, const char* expected)
    : folder_(std::move(folder)), path_(folder_ / lock_file) {
  if (purpose == For::reading && is_read_only(folder_, path_)) {
    // This process cannot write there.
    if (const auto holder = name_of_holder(path_)) refuse_second(folder_, *holder);
    return;
  }
  std::error_code unknown;
  made_ = !std::filesystem::exists(folder_, unknown);
  make_folder(folder_);
  std::optional<int> taken;
  while (!taken) taken = take(folder_, path_, expected);
  file_ = *taken;
  if (const int error = write_name(file_)) {
    unlink(path_.c_str());
    close(file_);
    refuse_path(path_, error, expected);
  }
  if (purpose == For::writing) remove_parts(folder_);
}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  unlink(
      path_.c_str()); // before closing: a process that opens the path afterwards gets another file
  close(file_);
  if (made_) rmdir(folder_.c_str()); // only if nothing is in it
}

} // namespace wingspread
