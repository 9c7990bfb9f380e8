/// Prints results: a table on a terminal, otherwise the paths of the written files.
#pragma once

#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <string_view>

namespace CLI {
class App;
}

namespace wingspread {

/// The options --table and --histograms.
struct Display {
  bool table = false;           ///< print the table even when standard output is not a terminal
  bool histograms = false;      ///< print the table and each output's histogram
  bool all = false;             ///< print the table with every line
  bool statistics_only = false; ///< list no campaign and no rows: they were there before
};
void add_display_options(CLI::App& command, Display& display);

/// Describes standard output, for --help.
inline constexpr const char* display_help = "Standard output is a table of results on a terminal, "
                                            "otherwise the paths of the files written.\n";

/// Prints an error when runs failed numerically.
/// @param consequence end of the message, e.g. "; summary.json has their reasons"
/// @return the exit status
int report_failed(long failed, long runs, std::string_view consequence = "");

/// Prints which runs are missing and, one per line, the commands that make them.
/// @param alternative text about another way to make them, printed before the commands; may be empty
/// @return the exit status
int print_missing(const MissingRuns& missing, std::string_view alternative);

/// Whether to print a table, not the paths of files.
[[nodiscard]] bool wants_table(const Display& display);

/// Prints the table of results and, if asked for, the histograms.
void show_table(const StoredCampaign& stored, const Summary& summary, const Display& display);

/// Prints a warning when the folder is a preview.
void warn_of_preview(const StoredCampaign& stored);

/// Prints which runs failed and which requirements are not met. A single shard is not judged. A preview (results in
/// which runs are missing) meets no requirement.
/// @return the exit status; failed runs take precedence over requirements
int judge_results(const StoredCampaign& stored, const Summary& summary);

/// As judge_results for all cases: each requirement once, with its worst case. @return the worst exit status
int judge_cases(const StoredCampaign& whole, const std::vector<CaseSummary>& cases);

/// Prints the comparison of a campaign's cases, or the paths of their files.
/// @param whole the outer folder
void show_cases(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
                const Display& display);

/// Prints the result of a finished study: the file's text if `whole`, else its path.
/// @return the file's content
[[nodiscard]] Json show_finished(const std::filesystem::path& file, bool whole);

/// Prints the table of results or the paths of the files, and judges the results.
/// @return the exit status of judge_results
int show_results(const StoredCampaign& stored, const Summary& summary, const Display& display);

} // namespace wingspread
