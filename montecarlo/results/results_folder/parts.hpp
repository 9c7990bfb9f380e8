/// Folders with parts of the same runs: which runs they have, which are missing, and the commands that make those.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace wingspread {

/// A folder and its runs: one range, unless it is broken or unfinished.
struct Part {
  std::filesystem::path folder;
  std::filesystem::path
      out; ///< argument of --out that makes it: the folder, or the one with all cases
  Stamp stamp;
  RunRange own; ///< runs that it should have
  std::vector<RunRange> present{};

  /// @pre runs increase
  void add(long run);
  /// Number of runs present.
  [[nodiscard]] long count() const;
};

/// Runs are missing, and the commands that make them are known.
class MissingRuns : public SpecError {
public:
  MissingRuns(std::vector<Problem> problems, std::vector<std::string> commands)
      : SpecError(std::move(problems)), commands_(std::move(commands)) {}

  /// A command for each missing or unfinished shard, ready to type; none for runs without a shard.
  [[nodiscard]] const std::vector<std::string>& commands() const { return commands_; }

private:
  std::vector<std::string> commands_;
};

/// Collects the reasons why parts cannot be merged.
class PartFaults {
public:
  /// A problem that several cases share is listed once.
  void add(Problem problem);
  void add(std::string command);
  /// @throws MissingRuns if commands would help, else SpecError; does nothing without a problem
  void refuse() const;

private:
  std::vector<Problem> problems_;
  std::vector<std::string> commands_;
};

/// The command that makes a shard.
struct ShardMaker {
  std::string command;   ///< up to --out, e.g. "wingspread run part1/campaign.json"
  std::string more = ""; ///< after --out and --shard
};

/// Quotes a word for a shell.
[[nodiscard]] std::string shell_word(const std::string& word);

/// @param file of each folder that has its stamp
/// @throws SpecError with each folder of another campaign, seed or version than the first one, and each preview
void refuse_strangers(const std::vector<Part>& parts, const char* file);

/// Adds a problem for each folder that repeats runs of an earlier one.
void find_doubles(const std::vector<Part>& parts, PartFaults& faults);

/// Adds a problem for each folder that lacks runs of its own, and one for runs that no folder should have had.
/// @param runs of the whole
void find_missing(const std::vector<Part>& parts, long runs, const ShardMaker& maker,
                  PartFaults& faults);

} // namespace wingspread
