/// The folder of a design for Sobol' indices.
///
///   design.json       the campaign in full, the number of rows, version and hash, and the bounds asked for
///   design_runs.csv   a row for each run, as in a campaign's runs.csv
///
/// The runs of a design depend on each other and are no sample of the campaign, so the folder is not a results folder.
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

/// How the bounds of the indices were asked for by options; nothing: the defaults.
struct BoundsAsked {
  std::optional<long> resamples{};
  std::optional<double> confidence{};
  bool operator==(const BoundsAsked&) const = default;
};

/// A design: the campaign, its rows, its shard, and the bounds asked for, which no run depends on.
struct SaltelliDesign {
  Campaign campaign;
  long rows = 0;              ///< N
  std::optional<Shard> shard; ///< the part of the runs; none: all of them
  BoundsAsked bounds{};
};

/// The runs of the design or its shard. @throws SpecError on overflow
[[nodiscard]] RunRange runs_of(const SaltelliDesign& design);

/// Whether the folder contains a design and no results of a campaign.
[[nodiscard]] bool is_design_folder(const std::filesystem::path& folder);

/// design.json's text.
[[nodiscard]] std::string design_text(const SaltelliDesign& design);

/// Whether the file is a design.json, not a campaign.
[[nodiscard]] bool is_design_file(const std::filesystem::path& path);

/// Reads design.json. @throws SpecError if it is broken or does not match its hash
[[nodiscard]] SaltelliDesign read_design_file(const std::filesystem::path& path);
[[nodiscard]] SaltelliDesign read_design(const std::filesystem::path& folder);

/// Reads the runs so far, without a torn last line.
/// @param first the first expected run
/// @throws SpecError if the file is broken or has a gap
[[nodiscard]] ResultsFile read_design_runs(const std::filesystem::path& folder, const RunPlan& plan,
                                           long first = 0);

/// Calls `take` with each row. @param own the runs that the folder may have
/// @throws SpecError if the file is broken or has a run outside `own`
void for_each_design_row(const std::filesystem::path& folder, const RunPlan& plan, RunRange own,
                         const std::function<void(const ResultRow&)>& take);

/// Version, seed, hash and shard of a design; all its shards have the same hash.
[[nodiscard]] Stamp stamp_of(const SaltelliDesign& design);

/// Appends to design_runs.csv; an interrupted folder can be resumed.
class DesignFolderWriter {
public:
  /// @param resume true: the folder may already have this design, made by the same version; false: it must be new or
  ///   empty
  /// @throws SpecError for any other content; MachineError if another process has locked the folder, or cannot write it
  DesignFolderWriter(const std::filesystem::path& folder, const SaltelliDesign& design,
                     const RunPlan& plan, bool resume);

  [[nodiscard]] const Results& results() const { return rows_.results(); }
  /// The number of runs in the file.
  [[nodiscard]] long count() const { return rows_.count(); }
  void add(const Batch& batch) { rows_.add(batch); }
  /// Syncs and closes the file. Call once, after the last batch.
  void finish() { rows_.finish(); }

private:
  std::optional<FolderLock> lock_;
  RowWriter rows_;
};

} // namespace wingspread
