/// The runs of a design for Sobol' indices, kept in a folder of their own.
///
///   design.json       the campaign in full, the number of rows, version and hash
///   design_runs.csv   a row for each run, as in a campaign's runs.csv
///
/// Its runs are no sample of the campaign (they depend on each other), so it is not a results
/// folder, and no command takes it for one.
#pragma once

#include "montecarlo/analyses/sensitivity/saltelli.hpp"
#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/results_folder/row_writer.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace wingspread {

inline constexpr const char* design_file = "design.json";
inline constexpr const char* design_runs_file = "design_runs.csv";
inline constexpr const char* sensitivity_json_file = "sensitivity.json";
inline constexpr const char* sensitivity_csv_file = "sensitivity.csv";

/// What there is to know of a design.
struct SaltelliDesign {
  Campaign campaign;
  long rows = 0;              ///< N
  std::optional<Shard> shard; ///< the part of its runs that is meant; none: all of them
};

/// Those runs. @throws SpecError when there are more than can be counted
[[nodiscard]] RunRange runs_of(const SaltelliDesign& design);

/// Whether the folder holds a design, and no campaign's results.
[[nodiscard]] bool is_design_folder(const std::filesystem::path& folder);

/// design.json's text.
[[nodiscard]] std::string design_text(const SaltelliDesign& design);

/// Whether the file is a design's, and not a campaign's.
[[nodiscard]] bool is_design_file(const std::filesystem::path& path);

/// Reads design.json. @throws SpecError when it is broken, or not what its hash says
[[nodiscard]] SaltelliDesign read_design_file(const std::filesystem::path& path);
[[nodiscard]] SaltelliDesign read_design(const std::filesystem::path& folder);

/// Reads the runs that are there, less a last line that was cut off.
/// @param first of them
/// @throws SpecError when the file is broken, or has a gap
[[nodiscard]] ResultsFile read_design_runs(const std::filesystem::path& folder, const RunPlan& plan,
                                           long first = 0);

/// Hands them on one after another. @param own the runs that the folder may have
/// @throws SpecError when the file is broken, or has another run
void for_each_design_row(const std::filesystem::path& folder, const RunPlan& plan, RunRange own,
                         const std::function<void(const ResultRow&)>& take);

/// What identifies a design: version, seed, hash and shard; the hash is that of all of its shards.
[[nodiscard]] Stamp stamp_of(const SaltelliDesign& design);

/// Grows design_runs.csv; a folder left at any moment can be opened again to go on.
class DesignFolderWriter {
public:
  /// @param resume the folder is new, or has the same design, by the same version; otherwise it is
  ///   new, or empty
  /// @throws SpecError otherwise; MachineError when another process has it, or it cannot be written
  DesignFolderWriter(const std::filesystem::path& folder, const SaltelliDesign& design,
                     const RunPlan& plan, bool resume);

  [[nodiscard]] const Results& results() const { return rows_.results(); }
  /// How many runs are in the file.
  [[nodiscard]] long count() const { return rows_.count(); }
  void add(const Batch& batch) { rows_.add(batch); }
  /// All rows are on the device, and the file is closed. Once, behind the last batch.
  void finish() { rows_.finish(); }

private:
  std::optional<FolderLock> lock_;
  RowWriter rows_;
};

} // namespace wingspread
