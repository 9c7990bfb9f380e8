/// Results shown on standard output: as a table on a terminal, else as the paths of their files.
#pragma once

#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <string_view>

namespace CLI {
class App;
}

namespace wingspread {

/// How results are shown on standard output.
struct Display {
  bool table = false;      ///< the table even when standard output is no terminal
  bool histograms = false; ///< and a drawing of each output's histogram below it
};
void add_display_options(CLI::App& command, Display& display);

/// What --help says of it.
inline constexpr const char* display_help =
    "Standard output is the table of results if that is a terminal; otherwise the paths of the\n"
    "files written, one a line.\n";

/// Says on standard error that runs failed numerically.
/// @param consequence behind it, e.g. "; summary.json has their reasons"
/// @return the exit status
int report_failed(long failed, long runs, std::string_view consequence = "");

/// Says on standard error what is missing and then, each on a line of its own, the commands that make it.
/// @param otherwise what can be done without, behind "made by"; empty: nothing
/// @return the exit status
int refuse_missing(const MissingRuns& missing, std::string_view otherwise);

/// Whether it is the table, and not the paths of files.
[[nodiscard]] bool wants_table(const Display& display);

/// The table of the results on standard output, and the histograms below it where they are wanted.
void show_table(const StoredCampaign& stored, const Summary& summary, const Display& display);

/// Says on standard error that a folder is a preview, if it is one.
void warn_of_preview(const StoredCampaign& stored);

/// Says on standard error when runs failed and requirements are not met.
/// @return the exit status: that runs failed numerically comes before a requirement that is not
///   met, a shard alone is not held to those, and a preview meets none
int judge_results(const StoredCampaign& stored, const Summary& summary);

/// The cases of a campaign side by side, or the paths of their files.
/// @param whole the folder that has all of them
void show_cases(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
                const Display& display);

/// Of a study in whose folder nothing is left to do: its last file, or the path of it. @return what is in it
[[nodiscard]] Json show_finished(const std::filesystem::path& file, bool whole);

/// Shows the results, the table or the paths of their files, and says what judge_results says. @return its exit status
int show_results(const StoredCampaign& stored, const Summary& summary, const Display& display);

} // namespace wingspread
