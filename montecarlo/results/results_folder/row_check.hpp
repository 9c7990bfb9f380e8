/// Checks that the cells of a row of runs.csv do not contradict each other. Rows of this program do so only if they were
/// edited or damaged.
#pragma once

#include "montecarlo/engine/runs/results.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// A cell that cannot be right.
struct RowFault {
  std::string column, found, expected;
};

/// Limits that a campaign sets for its rows.
struct RowRules {
  double t_end = std::numeric_limits<double>::infinity(); ///< s
  bool holds = true; ///< whether a hold may keep a run from deploying after all latches
};

/// Checks, as far as the columns exist:
/// - magnitudes, counts and times are ≥ 0, and times not beyond t_end;
/// - a deployed run has all latch times and a deployment time not before them, and no other run has a deployment time;
/// - a run of a scene without holds in which all latches engaged is neither stalled nor timed out;
/// - the latch order, unless it is empty, names the hinges with a latch time, each once, by ascending latch times.
class RowCheck {
public:
  /// @param names  of the campaign's columns
  explicit RowCheck(const ResultNames& names, const RowRules& rules = {});

  /// The first fault of a row; nothing if there is none. @pre the row has the columns of the names
  [[nodiscard]] std::optional<RowFault> fault_in(const ResultRow& row) const;

private:
  struct Latch {
    std::string hinge;
    std::size_t column;
  };
  struct Output {
    std::string name;
    std::size_t column;
    bool is_time;
  };

  [[nodiscard]] std::optional<RowFault> fault_of_size(const ResultRow& row) const;
  [[nodiscard]] std::optional<RowFault> fault_of_latches(const ResultRow& row) const;
  [[nodiscard]] std::optional<RowFault> fault_of_status(const ResultRow& row) const;
  [[nodiscard]] std::optional<RowFault> fault_of_order(const ResultRow& row) const;

  RowRules rules_;
  std::vector<Output> not_negative_;
  std::vector<Latch> latches_; ///< the hinges with a column latch_time
  std::optional<std::size_t> deployment_time_;
};

} // namespace wingspread
