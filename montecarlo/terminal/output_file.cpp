#include "montecarlo/terminal/output_file.hpp"

#include "montecarlo/folder/results_folder.hpp"
#include "montecarlo/formats/spec_error.hpp"
#include "montecarlo/log/study_folder.hpp"
#include "montecarlo/margin/margin_report.hpp"
#include "montecarlo/rowless/rowless_folder.hpp"
#include "montecarlo/sensitivity/design_folder.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace wingspread {
namespace {

namespace fs = std::filesystem;

/// Those of results folders that are not JSON.
constexpr std::array<std::string_view, 10> own_files{runs_file,
                                                     histograms_csv_file,
                                                     statistics_file,
                                                     broken_runs_file,
                                                     looks_file,
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

} // namespace

void refuse_overwriting(const fs::path& out, const std::vector<fs::path>& read) {
  if (out.empty()) return;
  const auto refuse = [&](const char* what) {
    throw SpecError(
        {{"", "--out", '"' + out.string() + "\", " + what, "another file: it would be lost"}});
  };
  for (const fs::path& each : read) {
    if (is_same_file(out, each)) refuse("which is read");
    if (fs::is_directory(each) && is_own_file(out, each)) refuse("one of the results folder's own");
  }
  if (out.extension() == ".json" && fs::is_regular_file(out)) refuse("a JSON file");
}

} // namespace wingspread
