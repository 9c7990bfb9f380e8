#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/report/page/html_page.hpp"
#include "montecarlo/report/page/study_set.hpp"
#include "montecarlo/results/export/hdf5_export.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <fmt/format.h>

#include <deque>
#include <vector>

namespace wingspread {
namespace {

constexpr const char* report_file = "report.html";
constexpr const char* page_elsewhere =
    "a folder that can be written; --out FILE writes the page elsewhere";

struct ReportOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
  int threads = 0;
  ReportHeader header;
};

/// The command that makes this page, without --out.
std::string command_of(const ReportOptions& options) {
  std::string command = "wingspread report";
  for (const std::filesystem::path& folder : options.folders)
    command += ' ' + shell_word(folder.string());
  for (const auto& [key, help, member] : header_words)
    if (const std::string& text = options.header.*member; !text.empty())
      command += fmt::format(" --{} {}", key, shell_word(text));
  return command;
}

void warn_of_shard(const StoredCampaign& stored) {
  if (stored.stamp.shard)
    print_message("warning: {} is {} of its campaign: statistics are those of its own runs, and no "
                  "requirement is judged; `wingspread merge` merges all shards\n",
                  stored.folder.string(), describe(stored.stamp.shard));
}

int report(const ReportOptions& options) {
  refuse_repeated(options.folders);
  refuse_overwriting(options.out, options.folders);
  std::deque<FolderLock> locks;
  for (const std::filesystem::path& folder : options.folders) {
    if (!is_study_folder(folder)) (void)read_any_campaign(folder); // before the lock creates a file
    const bool written = options.out.empty() && locks.empty();     // the page goes into the first
    locks.emplace_back(folder, written ? FolderLock::For::writing : FolderLock::For::reading,
                       page_elsewhere);
    if (is_study_folder(folder)) continue;
    const StoredCampaign stored = read_any_campaign(folder);
    warn_of_preview(stored), warn_of_shard(stored);
  }
  const std::filesystem::path out =
      options.out.empty() ? options.folders.front() / report_file : options.out;
  const PageSources sources = read_page_sources(options.folders, options.threads);
  if (const std::string text = incomplete_text(sources); !text.empty()) {
    const std::string unjudged = unjudged_text(sources);
    print_message("warning: incomplete: {}{}{}\n", text, unjudged.empty() ? "" : "; ", unjudged);
  }
  write_file(out,
             html_page(page_json(sources, options.header, command_of(options), options.threads)));
  fmt::print("{}\n", out.string());
  return exit_code::done;
}

struct ExportOptions {
  std::filesystem::path folder, out;
};

int export_folder(const ExportOptions& options) {
  refuse_overwriting(options.out, {options.folder});
  Interrupt interrupt;
  interrupt.end_at_once("interrupted: nothing is written\n");
  if (std::filesystem::exists(options.folder / campaign_file))
    warn_of_preview(read_any_campaign(options.folder));
  export_hdf5(options.folder, options.out);
  fmt::print("{}\n", options.out.string());
  return exit_code::done;
}

void add_report_options(CLI::App& command, ReportOptions& options) {
  command.add_option("folders", options.folders, "Results folders")->required();
  command
      .add_option("--out", options.out,
                  "The page, which is replaced; default: report.html in the first folder")
      ->type_name("FILE");
  within(command.add_option("--threads", options.threads,
                            "Threads; default: 0, OMP_NUM_THREADS or all processors"),
         0, most_threads)
      ->type_name("N");
  for (const auto& [key, help, member] : header_words)
    command.add_option("--" + std::string(key), options.header.*member, help)->type_name("TEXT");
  command.footer(
      R"(The page opens offline and loads nothing from the network. It shows verdicts, the distribution of
every output, the wing in motion (some runs are made again for it), sensitivities, convergence of
the statistics, and the inputs. Its size does not grow with the number of runs: at most 5 MB. For a
campaign with cases it has a section for each case. The same folders give the same bytes. The path
of the page is printed; exit code 0 means that the page was written, whatever the verdicts.
The words on the first page may also stand in the campaign, as "report": { "title": "…", … }.

Example:
  wingspread report results/first
  wingspread report results/before results/after --out change.html)");
}

void add_export_options(CLI::App& command, ExportOptions& options) {
  command.add_option("folder", options.folder, "The results folder")->required();
  command.add_option("--out", options.out, "The file to write; an existing file is replaced")
      ->type_name("FILE.h5")
      ->required();
  command.footer(
      R"(Writes one dataset for each column, with the column's name in runs.csv, its unit and its
description; numbers bit for bit, NaN for missing values. A campaign with cases has one group for
each case. The campaign, its seed and its hash are attributes of the file. The same folder gives
the same bytes. A wingspread built without HDF5 (Debian: libhdf5-dev) says so and exits with code 4.

Example:
  wingspread export results/first --out first.h5
  python3 -c 'import h5py; print(list(h5py.File("first.h5")))')");
}

} // namespace

void add_report(CLI::App& app, Action& action) {
  add_command<ReportOptions>(app, action, "report",
                             "Write an HTML report of results; of several folders, a comparison",
                             add_report_options, report);
}

void add_export(CLI::App& app, Action& action) {
  add_command<ExportOptions>(app, action, "export",
                             "Export results as HDF5, for h5py, pandas, MATLAB and Octave",
                             add_export_options, export_folder);
}

} // namespace wingspread
