/// The folder of a study while it is made.
#pragma once

#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/checkpoint/checkpoint.hpp"

#include <filesystem>
#include <optional>

namespace wingspread {

/// The log of a study that is not finished.
inline constexpr const char* checkpoint_file = "looks.log";

/// Held by this process alone, with the study's log in it from its first look to its last file.
class StudyFolder {
public:
  /// Opens the folder, and makes it if it is not there.
  ///
  /// To resume: it is new or empty, or has the log of the same study, or is finished. Not to resume: it is new or
  /// empty.
  /// @param about whose study it is (checkpoint.hpp): values that the last file has too
  /// @param last  the file that it writes last: JSON
  /// @throws SpecError otherwise; MachineError when another process has it, or it cannot be written
  StudyFolder(std::filesystem::path folder, const Json& about, const char* last, bool resume);

  /// Whether nothing is left to do: the last file is there, and the log is not.
  [[nodiscard]] bool is_finished() const { return !log_; }
  /// @pre it is not finished
  [[nodiscard]] Checkpoint& log() { return *log_; }

  /// Takes the log away. Once, when the last file is written.
  void finish();

private:
  std::filesystem::path folder_;
  std::optional<FolderLock> lock_;
  std::optional<Checkpoint> log_;
};

/// Says on standard error when rows of its log were of no use, and were made again.
void warn_if_damaged(const Checkpoint& log, const std::filesystem::path& folder);

} // namespace wingspread
