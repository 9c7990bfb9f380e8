/// The folder of a study while it runs.
#pragma once

#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/checkpoint/checkpoint.hpp"

#include <filesystem>
#include <optional>

namespace wingspread {

/// The checkpoint of an unfinished study.
inline constexpr const char* checkpoint_file = "looks.log";

/// Locked by this process. Holds the study's checkpoint from its first analysis to its last file.
class StudyFolder {
public:
  /// Opens or creates the folder. To resume, the folder is new or empty, has the checkpoint of the same study, or is
  /// finished. Otherwise it is new or empty.
  /// @param about which study it is (checkpoint.hpp); recorded in the last file too
  /// @param last  the file that the study writes last: JSON
  /// @throws SpecError otherwise; MachineError if another process holds it, or it cannot be written
  StudyFolder(std::filesystem::path folder, const Json& about, const char* last, bool resume);

  /// Whether the last file exists and the checkpoint does not.
  [[nodiscard]] bool is_finished() const { return !log_; }
  /// @pre the study is not finished
  [[nodiscard]] Checkpoint& log() { return *log_; }

  /// Removes the checkpoint. Once, after the last file was written. So a folder is the same whether the study was
  /// interrupted or not.
  void finish();

private:
  std::filesystem::path folder_;
  std::optional<FolderLock> lock_;
  std::optional<Checkpoint> log_;
};

/// Warns on standard error if damaged records were ignored and their runs repeated.
void warn_if_damaged(const Checkpoint& log, const std::filesystem::path& folder);

} // namespace wingspread
