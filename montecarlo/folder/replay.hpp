/// A run of a results folder, made again.
#pragma once

#include "montecarlo/folder/results_folder.hpp"

#include <optional>

namespace wingspread {

struct Replayed {
  Outcome outcome;
  ResultRow row;
  ResultNames names;
  bool recorded = false; ///< whether runs.csv has the run
  /// A line for each column in which the recorded row differs from this one by as much as a bit.
  std::vector<std::string> differences;
};

/// Asks for run k of a folder.
class ReplayRequest {
public:
  /// @pre the campaign outlives the request
  /// @throws SpecError when the campaign has no such run, or runs.csv is broken
  ReplayRequest(const StoredCampaign& stored, long run);

  /// @param observer sees the trajectory
  [[nodiscard]] Replayed replay(const Observer& observer) const;

private:
  const StoredCampaign* stored_;
  long run_;
  std::optional<ResultRow> recorded_;
};

/// A line for each column in which two rows of one table differ, by as much as a bit.
[[nodiscard]] std::vector<std::string>
differences(const ResultNames& names, const ResultRow& recorded, const ResultRow& computed);

} // namespace wingspread
