/// Folders that each have a part of a campaign's runs: which runs are there, which are missing, and the commands that
/// make the missing ones.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <unordered_set>
#include <vector>

namespace wingspread {

/// A folder and its runs.
struct Part {
  std::filesystem::path folder;
  /// Argument of --out that makes the folder: the folder itself, or the folder that holds the folders of all cases.
  std::filesystem::path out;
  Stamp stamp;
  RunRange own;                    ///< runs that the folder should have
  std::vector<RunRange> present{}; ///< runs that it has: several ranges if some are missing

  /// @pre runs increase
  void add(long run);
  /// Number of runs present.
  [[nodiscard]] long count() const;
};

/// Runs are missing, and the commands that make them are known.
class MissingRuns : public SpecError {
public:
  MissingRuns(std::vector<Problem> problems, std::vector<std::string> commands, bool can_preview)
      : SpecError(std::move(problems)), commands_(std::move(commands)), can_preview_(can_preview) {}

  /// A command for each missing or unfinished shard, ready to type; none for runs without a shard.
  [[nodiscard]] const std::vector<std::string>& commands() const { return commands_; }
  /// Whether the folders have runs, and each of them once.
  [[nodiscard]] bool can_preview() const { return can_preview_; }

private:
  std::vector<std::string> commands_;
  bool can_preview_;
};

/// Collects the reasons why parts cannot be merged.
class PartFaults {
public:
  /// A problem that several cases share is listed once.
  void add(Problem problem);
  void add(std::string command);
  /// Notes that a preview would be refused too.
  void forbid_preview() { can_preview_ = false; }
  /// @throws MissingRuns if commands would help, else SpecError; does nothing without a problem
  void refuse() const;

private:
  std::vector<Problem> problems_;
  std::vector<std::string> commands_;
  std::unordered_set<std::string> known_; ///< both, as texts
  bool can_preview_ = true;
};

/// The command that makes a shard.
struct ShardMaker {
  std::string command;   ///< up to --out, e.g. "wingspread run part1/campaign.json"
  std::string more = ""; ///< after --out and --shard
};

/// Refuses folders that do not belong together.
/// @param file name of the file in each folder that has the stamp
/// @throws SpecError with each folder of another campaign, seed or version than the first folder, and each preview
void refuse_other_campaigns(const std::vector<Part>& parts, const char* file);

/// Writes the rows of parts as one file, in the order of their runs.
/// @param parts complete and disjoint
/// @param for_each_row calls its second argument with each row of a part
template <class ForEachRow>
void write_in_order(std::vector<Part> parts, const ResultNames& names,
                    const std::filesystem::path& file, const ForEachRow& for_each_row) {
  constexpr std::size_t block_bytes = 1 << 16;
  std::ranges::sort(parts, {}, [](const Part& part) { return part.own.first; });
  WholeFile out(file);
  std::string lines;
  append_header(lines, names);
  const auto take = [&](const ResultRow& row) {
    append_row(lines, row);
    if (lines.size() < block_bytes) return;
    out.write(lines);
    lines.clear();
  };
  for (const Part& part : parts) for_each_row(part, take);
  out.write(lines);
  out.finish();
}

/// Adds a problem for each two folders that have runs in common.
void find_doubles(const std::vector<Part>& parts, PartFaults& faults);

/// Adds a problem for each folder that lacks some of its own runs, and one problem for the runs that belong to none of
/// the folders. Adds the commands that make these runs.
/// @param runs number of runs of the whole campaign
void find_missing(const std::vector<Part>& parts, long runs, const ShardMaker& maker,
                  PartFaults& faults);

} // namespace wingspread
