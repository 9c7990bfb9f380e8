/// The report: one self-contained HTML page. Template and scripts: this folder; the shape of its data: DATA.md.
#pragma once

#include "montecarlo/report/data/page_source.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// A case of a campaign without a results folder, e.g. of an interrupted run.
struct UnmadeCase {
  std::string label;
  long planned;                   ///< its number of runs
  bool has_requirements;          ///< of its campaign
  std::filesystem::path folder{}; ///< that the case would have
  std::size_t argument = 0;       ///< place of its folder among the command's
};

struct PageSources {
  std::vector<std::unique_ptr<PageSource>> runs; ///< sets of runs
  std::vector<Json> studies; ///< sets without runs (study_set.hpp), after `runs`
  std::vector<UnmadeCase> unmade;
};

/// Reads results folders (one set each, or one per case) and folders of `margin`, `sensitivity CAMPAIGN` and `rare`.
/// @param threads as of thread_count (thread_pool.hpp)
/// @throws SpecError for any other folder, for a broken one, for a set that two folders have, e.g. a folder and one of
///   its cases, and for more than 12 sets
[[nodiscard]] PageSources read_page_sources(std::span<const std::filesystem::path> folders,
                                            int threads);

/// Replaces labels by paths where two are equal: those of all sets of the same argument of the command.
void label_by_path(PageSources& sources);

/// The sets and cases that lack runs: "62 of 500 runs of case cold, none of hot"; empty if every planned run is there.
[[nodiscard]] std::string incomplete_text(const PageSources& sources);

/// Which requirements are not judged because runs of their campaign are missing: "requirements of A and B are not
/// judged"; "requirements are not judged" if no set's are; empty if all that are stated are judged.
[[nodiscard]] std::string unjudged_text(const PageSources& sources);

/// The data of the page (DATA.md).
/// @param header  the words on the first page; they replace those of the campaigns
/// @param command the command line that makes the page
[[nodiscard]] Json page_json(const PageSources& sources, const ReportHeader& header,
                             const std::string& command, int threads);

/// The page's HTML. The same folders give the same bytes on any number of threads.
[[nodiscard]] std::string html_page(const Json& data);

} // namespace wingspread
