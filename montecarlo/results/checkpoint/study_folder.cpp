#include "montecarlo/results/checkpoint/study_folder.hpp"

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <unistd.h>
#include <utility>

namespace wingspread {
namespace {

[[noreturn]] void refuse_folder(const std::filesystem::path& folder, const char* found,
                                const char* expected) {
  throw SpecError({{folder.string(), "", found, expected}});
}

void refuse_unsuitable(const std::filesystem::path& folder, const char* last, bool resume) {
  const bool has_log = std::filesystem::exists(folder / checkpoint_file);
  if (!resume && has_log)
    refuse_folder(folder, "an interrupted study",
                  "a new or an empty folder (--resume continues this one)");
  if (!resume) return refuse_used_folder(folder, "a new or an empty folder");
  if (!has_log && !std::filesystem::exists(folder / last) && !is_new_folder(folder))
    refuse_folder(folder, "no interrupted study", "one to continue, or a new or an empty folder");
}

} // namespace

void lock_study_folder(const std::filesystem::path& folder, const char* last, bool resume,
                       std::optional<FolderLock>& lock) {
  refuse_unsuitable(folder, last, resume);
  lock.emplace(folder);
  refuse_unsuitable(folder, last, resume); // it may have changed before the lock
}

bool is_finished_study(const std::filesystem::path& folder, const char* last, const Json& about) {
  if (!std::filesystem::exists(folder / last) || std::filesystem::exists(folder / checkpoint_file))
    return false;
  refuse_other_study(folder / last, parse_json_file(folder / last), about);
  return true;
}

void remove_checkpoint(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / checkpoint_file;
  if (unlink(file.c_str()) != 0 && errno != ENOENT)
    refuse_path(file, errno, "a file that can be taken away");
  sync_folder(folder);
}

StudyFolder::StudyFolder(std::filesystem::path folder, const Json& about, const char* last,
                         bool resume)
    : folder_(std::move(folder)) {
  lock_study_folder(folder_, last, resume, lock_);
  if (!is_finished_study(folder_, last, about)) log_.emplace(folder_ / checkpoint_file, about);
}

void StudyFolder::finish() {
  log_.reset();
  remove_checkpoint(folder_);
}

void warn_if_damaged(const Checkpoint& log, const std::filesystem::path& folder) {
  if (log.was_damaged())
    print_message(
        "warning: {} was damaged after run {} of the study: the runs after it were repeated\n",
        (folder / checkpoint_file).string(), log.read());
}

} // namespace wingspread
