/// The folder of a study while it runs.
#pragma once

#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/checkpoint/checkpoint.hpp"

#include <filesystem>
#include <optional>

namespace wingspread {

/// The checkpoint of an unfinished study.
inline constexpr const char* checkpoint_file = "looks.log";

/// Locks the folder of a study. Without `resume` it must be new or empty. With `resume` it may also have a checkpoint, or
/// the study's last file.
/// @throws SpecError for another folder; MachineError if another process holds the folder, or it cannot be written
void lock_study_folder(const std::filesystem::path& folder, const char* last, bool resume,
                       std::optional<FolderLock>& lock);
/// Whether the last file exists and the checkpoint does not. @throws SpecError if it is another study's
[[nodiscard]] bool is_finished_study(const std::filesystem::path& folder, const char* last,
                                     const Json& about);
/// Removes the checkpoint, so that the folder is the same whether the study was interrupted or not.
void remove_checkpoint(const std::filesystem::path& folder);

/// The folder, locked by this process. It holds a checkpoint until the study has written its last file.
class StudyFolder {
public:
  /// Opens or creates the folder, as lock_study_folder and is_finished_study.
  /// @param about identity of the study (checkpoint.hpp); also recorded in the last file
  /// @param last  name of the JSON file that the study writes last
  StudyFolder(std::filesystem::path folder, const Json& about, const char* last, bool resume);

  /// Whether the last file exists and the checkpoint does not.
  [[nodiscard]] bool is_finished() const { return !log_; }
  /// @pre the study is not finished
  [[nodiscard]] Checkpoint& log() { return *log_; }

  /// Removes the checkpoint. Call once, after the last file was written.
  void finish();

private:
  std::filesystem::path folder_;
  std::optional<FolderLock> lock_;
  std::optional<Checkpoint> log_;
};

/// Warns on standard error if damaged records were ignored and their runs repeated.
void warn_if_damaged(const Checkpoint& log, const std::filesystem::path& folder);

} // namespace wingspread
