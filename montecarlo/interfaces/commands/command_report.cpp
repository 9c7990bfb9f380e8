#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/report/page/html_page.hpp"
#include "montecarlo/report/page/study_set.hpp"
#include "montecarlo/results/export/hdf5_export.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <deque>
#include <memory>
#include <vector>

namespace wingspread {
namespace {

constexpr const char* report_file = "report.html";

struct ReportOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
  int threads = 0;
};

/// The command that makes the page, wherever it goes.
std::string command_of(const ReportOptions& options) {
  std::string command = "wingspread report";
  for (const std::filesystem::path& folder : options.folders) command += ' ' + folder.string();
  return command;
}

int report(const ReportOptions& options) {
  refuse_overwriting(options.out, options.folders);
  std::deque<FolderLock> locks;
  for (const std::filesystem::path& folder : options.folders) {
    if (!is_study_folder(folder)) (void)read_any_campaign(folder); // there is one to be locked
    const bool written = options.out.empty() && locks.empty();     // the page goes to the first
    locks.emplace_back(folder, written ? FolderLock::For::writing : FolderLock::For::reading);
    if (!is_study_folder(folder)) warn_of_preview(read_any_campaign(folder));
  }
  const std::filesystem::path out =
      options.out.empty() ? options.folders.front() / report_file : options.out;
  const PageSources sources = read_page_sources(options.folders, options.threads);
  write_file(out, html_page(page_json(sources, command_of(options), options.threads)));
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

} // namespace

void add_report(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report", "One HTML page of a folder's results; of several folders, a comparison");
  command->add_option("folders", options->folders, "Results folders")->required();
  command->add_option("--out", options->out, "The page; DIR/report.html of the first if left out")
      ->type_name("FILE");
  command->add_option("--threads", options->threads, "0: all processors")
      ->check(CLI::Range(0, 1024).description(""));
  command->footer(
      R"(The page opens offline and asks no network for anything: verdicts, every output's distribution, the
wing in motion (runs of the folder are made again for it), what moves what, how statistics settled,
and the inputs. Its size does not grow with the number of runs: at most 4 MB. Of a campaign with
cases it has a set for each. The same folders give the same bytes. Its path is printed; exit code 0
says that it was written, whatever the verdicts on it.

Example:
  wingspread report results/first
  wingspread report results/before results/after --out change.html)");
  command->callback([options, &action] { action = [options] { return report(*options); }; });
}

void add_export(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "A folder's rows as HDF5, for h5py, pandas, MATLAB and Octave");
  command->add_option("folder", options->folder, "The results folder")->required();
  command->add_option("--out", options->out, "The file; one that is there is replaced")
      ->type_name("FILE.h5")
      ->required();
  command->footer(
      R"(One dataset a column, by its name in runs.csv, with its unit and description as attributes;
numbers bit for bit, NaN where a quantity did not happen. Of a campaign with cases there is a
group for each. The campaign, its seed and its hash are attributes of the file. The same folder
gives the same bytes. Where wingspread was built without HDF5 (Debian: libhdf5-dev) it says so,
with exit code 4.

Example:
  wingspread export results/first --out first.h5
  python3 -c 'import h5py; print(list(h5py.File("first.h5")))')");
  command->callback([options, &action] { action = [options] { return export_folder(*options); }; });
}

} // namespace wingspread
