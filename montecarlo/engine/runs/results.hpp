/// The results table of a campaign: one row per run, and its file runs.csv.
///
/// Columns of runs.csv in the order written: `run` (counted from 0; the number that `replay --run` takes), `status`,
/// the draws by name, the outputs by name, `peaks_final` if peaks are among them, `latch_order`, and `reason` (why a
/// run did not deploy, or latches_may_let_go; else empty). The readers accept the columns in any order.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/engine/runs/finality.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/platform/spilled.hpp"
#include "montecarlo/foundation/platform/text_column.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

inline constexpr std::string_view peaks_final_column = "peaks_final";

/// The column names that depend on the campaign.
struct ResultNames {
  std::vector<std::string> draws;
  std::vector<std::string> outputs; ///< numbers, with `deployment_time`; without `latch_order`
  bool peaks_final = false;         ///< whether the column exists
  bool operator==(const ResultNames&) const = default;
};

/// One run. An output that did not happen is not finite, and an empty cell in the file.
struct ResultRow {
  long run = 0; ///< counted from 0
  Status status = Status::failed;
  std::vector<double> draws;               ///< in the order of ResultNames::draws
  std::vector<double> outputs;             ///< in the order of ResultNames::outputs
  std::string latch_order;                 ///< "root>mid>tip"; empty when no hinge latched
  std::string reason;                      ///< why it did not deploy; or latches_may_let_go
  std::optional<PeaksFinal> peaks_final{}; ///< nothing if the column does not exist
};

/// A named column of numbers; NaN if the quantity did not happen.
struct Column {
  std::string name;
  Spilled<double> values;
};

/// The results table, stored by columns of equal length. Long columns lie in temporary files: call release() after
/// reading them.
struct Results {
  Spilled<long> runs; ///< counted from 0, increasing
  Spilled<Status> status;
  std::vector<Column> draws;
  std::vector<Column> outputs;
  Spilled<PeaksFinal> peaks_final; ///< `unknown` if not recorded
  DictionaryColumn latch_order;
  TextColumn reason;
  bool has_peaks_final = false; ///< whether peaks_final was recorded

  Results() = default;
  /// An empty table with these columns.
  explicit Results(const ResultNames& names);

  [[nodiscard]] std::size_t size() const { return runs.size(); }
  /// @pre the row has as many draws and outputs as the table has columns.
  void append(const ResultRow& row);
  [[nodiscard]] ResultRow row(std::size_t index) const;
  /// Whether t_end cut a run's peaks of this kind.
  [[nodiscard]] bool is_cut(std::size_t index, PeakKind kind) const {
    return wingspread::is_cut(kind, peaks_final[index]);
  }
  /// Whether a run deployed, and it is not proven that its latches stay engaged.
  [[nodiscard]] bool may_let_go(std::size_t index) const {
    return status[index] == Status::deployed && reason[index] == latches_may_let_go;
  }
  /// Releases the memory of all columns that lie in files (spilled.hpp).
  void release() const;
};

/// The number of runs whose value of the output is a peak that t_end cut.
[[nodiscard]] long count_cut(const Results& results, std::string_view output);

/// The number of runs that deployed, and of which it is not proven that their latches stay engaged.
[[nodiscard]] long count_open_latches(const Results& results);

/// The column names of runs.csv in the order written.
[[nodiscard]] std::vector<std::string> header_cells(const ResultNames& names);

/// Appends the header of runs.csv and its line feed.
void append_header(std::string& buffer, const ResultNames& names);

/// Appends one line of runs.csv with its line feed.
/// @pre the row's texts have no line breaks, so that a crash can cut only the last line
void append_row(std::string& buffer, const ResultRow& row);

/// How to read a last line without a line break.
enum class UnterminatedRow {
  read, ///< an ordinary row (other tools may leave the line break out)
  drop  ///< ignore it: a crash cut it, and the run is computed again
};

struct ResultsFile {
  Results results;
  std::size_t complete_bytes = 0; ///< length of the file up to its last complete line; 0: no header
  bool unterminated = false;      ///< whether bytes follow the last complete line
};

/// Reads runs.csv. Expects the columns of `names` with `run`, `status` and `latch_order`, in any order; `reason` may
/// be missing.
/// @param file name for error messages
/// @throws SpecError at the first fault: a missing, unknown or repeated column, a row with more or fewer cells than
///   the header, a cell of the wrong kind, run numbers that do not increase
[[nodiscard]] ResultsFile read_results(std::istream& in, const std::string& file,
                                       const ResultNames& names, UnterminatedRow last);

} // namespace wingspread
