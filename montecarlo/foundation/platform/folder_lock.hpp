/// A lock that lets one process write to a folder.
#pragma once

#include <filesystem>
#include <string>

namespace wingspread {

/// The lock file, which names its holder. It exists while the holder lives; a file left by a crash does not lock.
inline constexpr const char* lock_file = ".lock";

/// The process that holds the folder, "process 123 on HOST"; empty if none does.
[[nodiscard]] std::string holder_of(const std::filesystem::path& folder);

/// Holds a folder for this process. The lock is the system's (flock), which ends with the process. On a file system
/// without flock, the folder is locked while the process named in the file is alive: on this machine, and since its
/// last boot. There a process on another machine is not noticed.
class FolderLock {
public:
  enum class For {
    writing,
    reading ///< locks where this process can write; elsewhere takes no lock, but refuses a folder that is locked
  };

  /// Creates the folder if needed. For writing, it removes temporary files that a killed program left.
  /// @throws MachineError that names the holder if another process holds the folder; as refuse_path (machine_error.hpp)
  /// @param expected for the message where the folder cannot be written; a command's names its --out
  explicit FolderLock(std::filesystem::path folder, For purpose = For::writing,
                      const char* expected = "a folder that can be locked for one writer");
  /// Releases the lock, and removes the folder if this object created it and it is empty.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

private:
  std::filesystem::path folder_, path_;
  bool made_ = false; ///< whether this object created the folder
  int file_ = -1;     ///< -1: no lock
};

} // namespace wingspread
