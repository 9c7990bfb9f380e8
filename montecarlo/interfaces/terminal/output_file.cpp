#include "montecarlo/interfaces/terminal/output_file.hpp"

#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace wingspread {
namespace {

namespace fs = std::filesystem;

/// Files of results folders without the JSON files, which are refused anyway.
constexpr std::array<std::string_view, 10> own_files{runs_file,
                                                     histograms_csv_file,
                                                     statistics_file,
                                                     broken_runs_file,
                                                     checkpoint_file,
                                                     extremes_file,
                                                     margin_csv_file,
                                                     design_runs_file,
                                                     sensitivity_csv_file,
                                                     motorization_csv_file};

bool is_own_file(const fs::path& out, const fs::path& folder) {
  if (std::ranges::find(own_files, out.filename().string()) == own_files.end()) return false;
  const fs::path whole = fs::weakly_canonical(folder), within = fs::weakly_canonical(out);
  return std::ranges::mismatch(whole, within).in1 == whole.end();
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code none_there;
  return fs::equivalent(a, b, none_there) && !none_there;
}

/// Collects the files of empirical laws in a campaign's JSON.
void find_tables(const Json& part, const fs::path& directory, std::vector<fs::path>& tables) {
  if (part.is_object() && part.contains("type"))
    if (const auto file = part.find("file"); file != part.end() && file->is_string())
      tables.push_back(directory / file->get_ref<const std::string&>());
  if (part.is_structured())
    for (const Json& each : part) find_tables(each, directory, tables);
}

/// The files that a campaign (or the campaign of a results folder) names; none if its reader will refuse it.
std::vector<fs::path> named_files(const fs::path& read) {
  const fs::path file = fs::is_directory(read) ? read / campaign_file : read;
  std::vector<fs::path> named;
  try {
    const Json document = parse_json_file(file);
    find_tables(document, file.parent_path(), named);
    if (!document.is_object()) return named;
    if (const auto scene = document.find("scene"); scene != document.end() && scene->is_string())
      named.push_back(file.parent_path() / scene->get_ref<const std::string&>());
  } catch (const SpecError&) {
  } catch (const MachineError&) {
  }
  return named;
}

} // namespace

void refuse_repeated(const std::vector<fs::path>& folders) {
  std::vector<Problem> problems;
  for (auto folder = folders.begin(); folder != folders.end(); ++folder) {
    const auto first = std::find_if(folders.begin(), folder, [&](const fs::path& other) {
      return is_same_file(*folder, other);
    });
    if (first == folder) continue;
    problems.push_back(
        {folder->string(), "",
         *first == *folder ? "the same folder twice" : "the same folder as " + first->string(),
         "each folder once"});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

void refuse_overwriting(const fs::path& out, const std::vector<fs::path>& read,
                        const char* option) {
  if (out.empty()) return;
  const auto refuse = [&](const char* what) {
    throw SpecError(
        {{"", option, '"' + out.string() + "\", " + what, "another file: this one would be lost"}});
  };
  for (const fs::path& each : read) {
    if (is_same_file(out, each)) refuse("which this command reads");
    if (fs::is_directory(each) && is_own_file(out, each)) refuse("a file of the results folder");
  }
  if (!fs::is_regular_file(out)) return;
  for (const fs::path& each : read)
    for (const fs::path& named : named_files(each))
      if (is_same_file(out, named)) refuse("which this command reads");
  if (out.extension() == ".json") refuse("a JSON file");
}

} // namespace wingspread
