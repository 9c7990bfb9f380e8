/// One folder, one writer.
#pragma once

#include <filesystem>

namespace wingspread {

/// The file that its holder locks and writes its name into. It is there as long as the holder lives; one that a
/// crash left does not hold.
inline constexpr const char* lock_file = ".lock";

/// A folder that this process alone writes to. The system's lock (flock) goes with the process, however it ends;
/// where a file system has none, the name in the file counts as long as a process of that number lives on this
/// machine and in this boot of it.
class FolderLock {
public:
  enum class For {
    writing,
    reading ///< a folder that this process may not write to is read without the lock, unless another holds it
  };

  /// Makes the folder if it is not there, and takes away what a killed program had begun in it.
  /// @throws MachineError when another process holds it, and says which; and as refuse_path does
  explicit FolderLock(std::filesystem::path folder, For purpose = For::writing);
  /// Lets go of it, and of the folder too if it was made and nothing was written.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

private:
  std::filesystem::path folder_, path_;
  bool made_ = false; ///< the folder
  int file_ = -1;     ///< none: there is no lock
};

} // namespace wingspread
