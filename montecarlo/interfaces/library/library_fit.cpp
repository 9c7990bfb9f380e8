#include "montecarlo/analyses/fit/fit_folder.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/platform/arithmetic.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/library/wingspread.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <limits>
#include <sstream>

namespace wingspread::api {
namespace {

FitSpec read_tests(const Input& tests, const Campaign& campaign) {
  if (!tests.file.empty()) return read_fit_file(tests.file, campaign);
  return read_fit(parse_json(tests.text), "", tests.directory, campaign);
}

Fit fit_of(const FitResult& result, std::string json, std::vector<std::string> notices) {
  Fit fit{std::move(json), {}, result.finished, std::move(notices)};
  for (std::size_t k = 0; k < result.posterior.names.size(); ++k) {
    Series& series = fit.posterior.emplace_back(Series{result.posterior.names[k], {}});
    for (const std::vector<double>& row : result.posterior.rows) series.values.push_back(row[k]);
  }
  return fit;
}

/// Reads posterior.csv. @param text empty: the fit found no posterior, and wrote no such file
std::vector<Series> read_posterior(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  CsvReader reader(in, file);
  std::vector<Series> posterior;
  if (!reader.next()) return posterior;
  for (const std::string& name : reader.cells()) posterior.push_back({name, {}});
  while (reader.next()) {
    const std::vector<std::string>& cells = reader.cells();
    if (cells.size() != posterior.size())
      throw reader.error("", std::to_string(cells.size()) + " cells",
                         "as many as the header has, " + std::to_string(posterior.size()));
    for (std::size_t k = 0; k < cells.size(); ++k)
      posterior[k].values.push_back(
          parse_csv_number(cells[k]).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return posterior;
}

/// The fit that an earlier session finished.
Fit read_fit_folder(const std::filesystem::path& folder, std::vector<std::string> notices) {
  const std::filesystem::path file = folder / posterior_file;
  return {read_text(folder / fit_json_file).value_or(""),
          read_posterior(read_text(file).value_or(""), file.string()), true, std::move(notices)};
}

} // namespace

Fit fit(const Input& input, const Input& tests, const FitRequest& request) {
  const DefaultArithmetic arithmetic;
  check_threads(request.threads);
  if (request.runs < 0)
    throw SpecError({{"", "--runs", std::to_string(request.runs), "an integer, at least 1, or 0"}});
  Campaign campaign = read_campaign_input(input);
  override_sampling(campaign, std::nullopt, request.seed);
  std::vector<std::string> notices;
  for (const InputWarning& warning : check_campaign(campaign, input.file))
    notices.push_back(to_string(warning));
  const FitSpec spec = read_tests(tests, campaign);
  const Json about = about_fit(campaign, spec);
  const std::atomic<bool> never = false;
  const std::atomic<bool>& stop = request.stop ? *request.stop : never;
  FitOptions options{.pool = {.threads = request.threads}};
  options.most_runs = request.runs;
  refuse_unpredictable(campaign, spec, options, tests.file.string(), stop);
  std::optional<FitFolder> folder;
  if (!request.out.empty()) folder.emplace(request.out, about, request.resume);
  if (folder && folder->is_finished()) return read_fit_folder(request.out, std::move(notices));
  FitResult result = fit_campaign(campaign, spec, options, stop, folder ? &folder->log() : nullptr,
                                  [](const EnsembleState&) {});
  if (folder) folder->write(result, campaign, spec, options.pool, stop);
  return fit_of(result, json_text(fit_json(result, spec, about)), std::move(notices));
}

} // namespace wingspread::api
