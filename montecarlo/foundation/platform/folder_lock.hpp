/// A lock that lets one process write to a folder.
#pragma once

#include <filesystem>

namespace wingspread {

/// The lock file, which names its holder. It exists while the holder lives; a file left by a crash does not lock.
inline constexpr const char* lock_file = ".lock";

/// Holds a folder for this process. The lock is the system's (flock), which ends with the process. On a file system
/// without flock, the name in the file counts as long as that process lives on this machine since its last boot.
class FolderLock {
public:
  enum class For {
    writing,
    reading ///< if this process cannot write to the folder, read it without a lock unless another process holds it
  };

  /// Creates the folder if needed, and removes temporary files that a killed program left.
  /// @throws MachineError that names the process holding the folder; as refuse_path does
  explicit FolderLock(std::filesystem::path folder, For purpose = For::writing);
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
