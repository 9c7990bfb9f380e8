/// The results table of a campaign: one row per run, and its file runs.csv.
///
/// Columns of runs.csv, in the order in which they are written: `run` (counted from 0, the number
/// that `replay --run` takes), `status`, the draws by name, the outputs by name, `peaks_final` where
/// peaks are among them, `latch_order` and `reason` (why a run is not `deployed`; empty otherwise).
/// They are read in any order.
#pragma once

#include "core/deployment.hpp"
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

/// The names of the columns that depend on the campaign.
struct ResultNames {
  std::vector<std::string> draws;
  std::vector<std::string> outputs; ///< numbers, `deployment_time` among them; not `latch_order`
  bool peaks_final = false;         ///< whether there is that column
  bool operator==(const ResultNames&) const = default;
};

/// Whether it is proven that none of a run's peaks would be exceeded were it to go on; `no` when t_end cut them.
/// Not known of a run that failed or was invalid.
enum class PeaksFinal : signed char { unknown, no, yes };
/// "true", "false" or, where nothing is known, an empty cell.
[[nodiscard]] std::string_view to_string(PeaksFinal final);

/// One run. A number that is not finite did not happen: an empty cell in the file.
struct ResultRow {
  long run = 0; ///< counted from 0
  Status status = Status::failed;
  std::vector<double> draws;   ///< in the order of ResultNames::draws
  std::vector<double> outputs; ///< in the order of ResultNames::outputs
  std::string latch_order;     ///< "root>mid>tip"; empty when no hinge latched
  std::string reason;
  std::optional<PeaksFinal> peaks_final{}; ///< none where there is no such column
};

/// A named column of numbers; NaN where the quantity did not happen.
struct Column {
  std::string name;
  Spilled<double> values;
};

/// The table by columns. All columns have the same length. What is long of it lies in temporary
/// files: whoever reads long columns through releases them.
struct Results {
  Spilled<long> runs; ///< counted from 0, increasing
  Spilled<Status> status;
  std::vector<Column> draws;
  std::vector<Column> outputs;
  Spilled<PeaksFinal> peaks_final; ///< as long as the others; unknown where it was not recorded
  DictionaryColumn latch_order;
  TextColumn reason;
  bool has_peaks_final = false; ///< whether it was recorded

  Results() = default;
  /// An empty table with these columns.
  explicit Results(const ResultNames& names);

  [[nodiscard]] std::size_t size() const { return runs.size(); }
  /// @pre the row has as many draws and outputs as the table has columns.
  void append(const ResultRow& row);
  [[nodiscard]] ResultRow row(std::size_t index) const;
  /// Lets go of the memory of all columns that lie in files (spilled.hpp).
  void release() const;
};

/// The columns of runs.csv in the order in which they are written.
[[nodiscard]] std::vector<std::string> header_cells(const ResultNames& names);

/// Appends the header of runs.csv and its line feed.
void append_header(std::string& buffer, const ResultNames& names);

/// Appends one line of runs.csv and its line feed: rows can be written as they come.
/// @pre its texts have no line breaks: what a crash cuts off is then part of the last line
void append_row(std::string& buffer, const ResultRow& row);

/// What to do with a last line that no line break ends.
enum class UnterminatedRow {
  read, ///< it is a row like any other (other tools may leave the break out)
  drop  ///< it is what a crash left: leave it out, to be computed again
};

struct ResultsFile {
  Results results;
  std::size_t complete_bytes = 0; ///< length of the file up to its last complete line; 0: no header
  bool unterminated = false;      ///< something follows after that
};

/// Reads runs.csv. The columns are those of `names` with `run`, `status` and `latch_order`, in any
/// order; `reason` may be missing.
/// @param file name for the error messages.
/// Throws SpecError at the first fault: a column that is missing, unknown or there twice, a row
/// with more or fewer cells than the header, a cell that is not what its column holds, run numbers
/// that do not increase.
[[nodiscard]] ResultsFile read_results(std::istream& in, const std::string& file,
                                       const ResultNames& names, UnterminatedRow last);

} // namespace wingspread
