/// Folders that have parts of the same runs: which of them they have, which are missing, and what makes those.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace wingspread {

/// A folder, and the runs that it has: one range, unless it is broken or not finished.
struct Part {
  std::filesystem::path folder;
  std::filesystem::path out; ///< what --out names to make it: the folder, or the one with all cases
  Stamp stamp;
  RunRange own; ///< that it should have
  std::vector<RunRange> present{};

  /// @pre runs come in order
  void add(long run);
  /// How many it has.
  [[nodiscard]] long count() const;
};

/// Runs are missing, and known is what makes them.
class MissingRuns : public SpecError {
public:
  MissingRuns(std::vector<Problem> problems, std::vector<std::string> commands)
      : SpecError(std::move(problems)), commands_(std::move(commands)) {}

  /// A command for each shard that is missing or not finished, to be typed as it is; none for runs of no shard.
  [[nodiscard]] const std::vector<std::string>& commands() const { return commands_; }

private:
  std::vector<std::string> commands_;
};

/// What keeps parts from being put together.
class PartFaults {
public:
  /// What is the same in several cases of a campaign is said once.
  void add(Problem problem);
  void add(std::string command);
  /// @throws MissingRuns when commands would help, else SpecError; nothing without a problem
  void refuse() const;

private:
  std::vector<Problem> problems_;
  std::vector<std::string> commands_;
};

/// How shards of these runs are made.
struct ShardMaker {
  std::string command;   ///< less --out and what follows, e.g. "wingspread run part1/campaign.json"
  std::string more = ""; ///< behind that
};

/// A word of a command as a shell takes it.
[[nodiscard]] std::string shell_word(const std::string& word);

/// @param file of each folder that has its stamp
/// @throws SpecError with each folder that is not of the first one's campaign, seed and version, or is a preview
void refuse_strangers(const std::vector<Part>& parts, const char* file);

/// A problem for each folder that has runs of those before it.
void find_doubles(const std::vector<Part>& parts, PartFaults& faults);

/// A problem for each folder that lacks runs of its own, and one for runs that no folder should have had.
/// @param runs of the whole
void find_missing(const std::vector<Part>& parts, long runs, const ShardMaker& maker,
                  PartFaults& faults);

} // namespace wingspread
