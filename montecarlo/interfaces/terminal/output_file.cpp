#include "montecarlo/interfaces/terminal/output_file.hpp"

#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/rare/rare_report.hpp"
#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

namespace wingspread {
namespace {

namespace fs = std::filesystem;

/// Files of results folders without the JSON files, which are refused anyway.
constexpr std::array<std::string_view, 12> own_files{runs_file,
                                                     histograms_csv_file,
                                                     statistics_file,
                                                     broken_runs_file,
                                                     checkpoint_file,
                                                     extremes_file,
                                                     margin_csv_file,
                                                     design_runs_file,
                                                     sensitivity_csv_file,
                                                     motorization_csv_file,
                                                     posterior_file,
                                                     traces_csv_file};

/// One of these files makes a folder a results folder; so does a campaign beside rows.
constexpr std::array<std::string_view, 10> marks{
    summary_file,   cases_file,  statistics_file, checkpoint_file, margin_json_file,
    rare_json_file, design_file, shard_file,      fit_json_file,   sensitivity_json_file};

/// Whether the path exists; false if the system denies access: then the file cannot be written either.
bool is_there(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown);
}

bool is_folder(const fs::path& path) {
  std::error_code unknown;
  return fs::is_directory(path, unknown);
}

fs::path without_links(const fs::path& path) {
  std::error_code unknown;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, unknown), unknown);
  return unknown ? path : whole;
}

bool has_own_name(const fs::path& out) {
  return std::ranges::find(own_files, out.filename().string()) != own_files.end();
}

bool is_within(const fs::path& out, const fs::path& folder) {
  const fs::path whole = without_links(folder), within = without_links(out);
  return std::ranges::mismatch(whole, within).in1 == whole.end();
}

bool is_any_results_folder(const fs::path& folder) {
  return std::ranges::any_of(marks,
                             [&](std::string_view file) { return is_there(folder / file); }) ||
         (is_there(folder / campaign_file) && is_there(folder / runs_file));
}

/// Whether the file, or the one to which it is a link, belongs to a results folder.
bool belongs_to_results(const fs::path& out) {
  const fs::path target = without_links(out), folder = target.parent_path();
  const fs::path beside = without_links(out.parent_path().empty() ? "." : out.parent_path());
  return (has_own_name(out) && is_any_results_folder(beside)) ||
         (has_own_name(target) && is_any_results_folder(folder));
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code none_there;
  return fs::equivalent(a, b, none_there) && !none_there;
}

/// Whether a text of the document names the file, under any key: a table, rows, a scene, a trace.
bool names_file(const Json& part, const fs::path& directory, const fs::path& file) {
  constexpr std::size_t longest_path = 4096; // of Linux
  if (part.is_string()) {
    const auto& text = part.get_ref<const std::string&>();
    return !text.empty() && text.size() < longest_path && is_same_file(directory / text, file);
  }
  return part.is_structured() && std::ranges::any_of(part, [&](const Json& each) {
           return names_file(each, directory, file);
         });
}

/// The document of a scene, a campaign or a results folder; null if its reader will refuse it.
Json document_of(const fs::path& file) {
  try {
    return parse_json_file(file);
  } catch (const SpecError&) {
  } catch (const MachineError&) {
  }
  return nullptr;
}

/// Whether a scene, a campaign (its own scene included) or the campaign of a results folder names the file.
bool is_named_in(const fs::path& read, const fs::path& out) {
  const fs::path file = is_folder(read) ? read / campaign_file : read;
  const Json document = document_of(file);
  if (names_file(document, file.parent_path(), out)) return true;
  const auto scene = document.is_object() ? document.find("scene") : document.end();
  if (!document.is_object() || scene == document.end() || !scene->is_string()) return false;
  const fs::path other = file.parent_path() / scene->get_ref<const std::string&>();
  return names_file(document_of(other), other.parent_path(), out);
}

} // namespace

void refuse_repeated(const std::vector<fs::path>& folders, const fs::path& out) {
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
  for (const fs::path& folder : folders)
    if (!out.empty() && is_same_file(folder, out))
      problems.push_back({"", "--out", '"' + out.string() + "\", which is read",
                          "another folder, new or empty: this one stays as it is"});
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
    if (is_folder(each) && has_own_name(out) && is_within(out, each))
      refuse("a file of the results folder");
  }
  if (belongs_to_results(out)) refuse("a file of a results folder");
  std::error_code unknown; // a file without permission to read cannot be written either
  if (!fs::is_regular_file(out, unknown)) return;
  for (const fs::path& each : read)
    if (is_named_in(each, out)) refuse("which this command reads");
  if (out.extension() == ".json") refuse("a JSON file");
}

} // namespace wingspread
