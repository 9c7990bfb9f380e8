#include "montecarlo/results/results_folder/results_folder.hpp"

#include "distributions/prepared_distribution.hpp"
#include "montecarlo/engine/accuracy/accuracy.hpp"
#include "montecarlo/engine/runs/row_reader.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/input_file.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/guarantees.hpp"
#include "montecarlo/results/results_folder/row_check.hpp"
#include "montecarlo/results/summary/judge_campaign.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace wingspread {
namespace {

std::filesystem::path refuse_missing(const std::filesystem::path& folder) {
  std::filesystem::path path = folder / campaign_file;
  if (!std::filesystem::is_directory(folder))
    throw SpecError({{folder.string(), "", "no such folder", "a results folder"}});
  if (!std::filesystem::exists(path))
    throw SpecError({{folder.string(), "", fmt::format("no {} in it", campaign_file),
                      "a results folder: one that `wingspread run` or `merge` wrote"}});
  return path;
}

/// The rules for rows. Draws cannot change t_end, nor add a hold.
RowRules rules_of(const Campaign& campaign) {
  return {campaign.integration.t_end,
          std::ranges::any_of(campaign.scene.hinges,
                              [](const Hinge& hinge) { return hinge.release.has_value(); })};
}

/// The stamp for summary.json, which marks missing runs.
Json about(const StoredCampaign& stored, const Summary& summary) {
  Json json = stamp_json(stored.stamp);
  if (stored.foreign) json["foreign"] = true;
  if (summary.runs < stored.runs().size() && !summary.stopped)
    json["partial"] = {{"done", summary.runs}, {"of", stored.runs().size()}};
  return json;
}

/// The goals of the stopping rule, by the campaign's own requirements and confidence, not the summary's.
std::vector<GoalState> goals_of(const StoredCampaign& stored, const Results& results) {
  const auto decides = [](const StoppingGoal& goal) {
    return std::holds_alternative<DecisionGoal>(goal);
  };
  Campaign own = stored.campaign;
  if (stored.own_requirements) own.requirements = *stored.own_requirements;
  std::vector<Verdict> verdicts;
  const InterimAnalyses interim = interim_analyses(own);
  if (std::ranges::any_of(own.until, decides)) verdicts = judge_campaign(own, results, interim);
  const auto& statistics = own.resolved.at("statistics"); // as before `analyze`
  return evaluate_goals(own.until, results, own.requirements, verdicts,
                        interim.confidence_of_bound(statistics.at("confidence").get<double>()));
}

void add_tolerance_limits(const Results& results, const StatisticsSpec& spec, Summary& summary) {
  for (std::size_t i = 0; i < results.outputs.size(); ++i) {
    const RankedOutput ranks(results, results.outputs[i]);
    for (const ToleranceLimitSpec& tolerance : spec.tolerance_limits)
      summary.outputs[i].tolerance_limits.push_back(
          {tolerance, output_limits(ranks, tolerance, summary.interim),
           ranks.beyond(tolerance.side)});
  }
}

/// Drops outputs that this program always records, if a file of another tool lacks them and its campaign does not ask
/// for them.
void match_recorded(const Json& document, const std::filesystem::path& runs, Campaign& campaign) {
  std::vector<std::string> header;
  if (std::filesystem::exists(runs)) {
    InputFile in(runs);
    CsvReader reader(in, runs.string());
    if (reader.next()) header = reader.cells();
  }
  const auto named = document.find("outputs");
  const auto match = [&](OutputFamily family, const auto& is_its) {
    const bool asked =
        named != document.end() && std::ranges::find(*named, about(family).name) != named->end();
    if (!asked && std::ranges::none_of(header, is_its)) campaign.outputs.erase(family);
  };
  match(OutputFamily::overtravel,
        [](const std::string& column) { return family_of(column) == OutputFamily::overtravel; });
  match(OutputFamily::peaks_final,
        [](const std::string& column) { return column == peaks_final_column; });
  campaign.resolved["outputs"] = write_outputs(campaign.outputs);
}

StoredCampaign read_campaign_of(const std::filesystem::path& folder, bool may_be_foreign) {
  const std::filesystem::path path = refuse_missing(folder);
  StoredCampaign stored{folder, read_campaign_file(path), {}};
  const Json document = parse_json_file(path);
  if (may_be_foreign && !document.contains(stamp_key)) {
    match_recorded(document, folder / runs_file, stored.campaign);
    stored.stamp = stamp_of(stored.campaign, {});
    stored.foreign = true;
    return stored;
  }
  std::vector<Problem> problems;
  stored.stamp = read_stamp(JsonCursor(document, path.string(), problems));
  if (!problems.empty()) throw SpecError(std::move(problems));
  const std::string hash = campaign_hash(stored.campaign.resolved);
  if (stored.stamp.hash != hash || stored.stamp.seed != stored.campaign.sampling.seed)
    throw SpecError(
        {{path.string(), fmt::format("/{}/hash", stamp_key),
          fmt::format("\"{}\", with a campaign and seed of hash \"{}\"", stored.stamp.hash, hash),
          "a campaign that nobody changed after it was run"}});
  return stored;
}

/// What a copy of the rows has, in the order of copying.
constexpr std::array copied_files{campaign_file, runs_file, statistics_file, broken_runs_file};

bool have_same_bytes(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (!std::filesystem::exists(a) || !std::filesystem::exists(b)) return false;
  InputFile of_a(a), of_b(b);
  using Bytes = std::istreambuf_iterator<char>;
  return of_a.size() == of_b.size() && std::equal(Bytes(of_a), Bytes(), Bytes(of_b), Bytes());
}

/// Copies a file block by block: std::filesystem::copy_file loses the reason of a failed write.
void copy_whole(const std::filesystem::path& from, const std::filesystem::path& to) {
  InputFile in(from);
  WholeFile out(to);
  std::vector<char> block(std::size_t{1} << 16);
  while (in.read(block.data(), std::ssize(block)), in.gcount() > 0)
    out.write({block.data(), static_cast<std::size_t>(in.gcount())});
  out.finish();
}

/// @throws SpecError that says how the file is made again
Json parse_summary(const std::filesystem::path& path) {
  try {
    return parse_json_file(path);
  } catch (const SpecError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems)
      problem.expected += fmt::format("; wingspread analyze {} writes the file again",
                                      shell_word(path.parent_path().string()));
    throw SpecError(std::move(problems));
  }
}

} // namespace

std::string campaign_text(const Campaign& campaign, const Stamp& stamp) {
  Json json{{stamp_key, stamp_json(stamp)}};
  for (const auto& [key, value] : campaign.resolved.items())
    if (key != stamp_key) json[key] = value;
  return json_text(json);
}

void judge_by(std::vector<Requirement> requirements, StoredCampaign& stored) {
  if (!stored.own_requirements) stored.own_requirements = std::move(stored.campaign.requirements);
  stored.campaign.requirements = std::move(requirements);
}

StoredCampaign as_analyzed(StoredCampaign stored) {
  const std::filesystem::path path = stored.folder / summary_file;
  if (!std::filesystem::exists(path)) return stored;
  const Json summary = parse_summary(path);
  const auto asked = summary.find(analyzed_key);
  if (asked == summary.end()) return stored;
  std::vector<Problem> problems;
  std::vector<Requirement> own = stored.campaign.requirements;
  read_analysis(JsonCursor(summary, path.string(), problems).member(analyzed_key), stored.campaign);
  if (!problems.empty()) throw SpecError(std::move(problems));
  if (asked->contains("requirements")) stored.own_requirements = std::move(own);
  return stored;
}

void copy_rows(const std::filesystem::path& from, const std::filesystem::path& to) {
  make_folder(to);
  for (const char* name : copied_files)
    if (std::filesystem::exists(from / name)) copy_whole(from / name, to / name);
}

bool is_copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  const auto is_alike = [&](const char* name) {
    return !std::filesystem::exists(to / name) || have_same_bytes(from / name, to / name);
  };
  return std::filesystem::exists(to / campaign_file) && std::ranges::all_of(copied_files, is_alike);
}

bool is_complete(const StoredCampaign& stored, const Results& results) {
  const long done = std::ssize(results.runs), runs = stored.runs().size();
  if (done >= runs) return true;
  return is_interim_analysis(done, runs) && are_met(goals_of(stored, results));
}

void add_nominal(const Campaign& campaign, Summary& summary) {
  const Goal goal = goal_of(campaign.outputs);
  const Outcome outcome =
      Deployment().run(nominal_scene(campaign), campaign.integration, goal, Observer{});
  const bool has_peaks = goal.peak_moment || goal.peak_force;
  summary.nominal = {outcome.status, latch_order(campaign.scene, outcome), outcome.reason,
                     has_peaks ? peaks_final_of(outcome) : PeaksFinal::unknown};
  summary.latch_jumps = latch_jumps(nominal_scene(campaign), outcome);
  summary.jump_forces = forces_of_jumps(nominal_scene(campaign), outcome);
  const std::vector<OutputColumn> columns = output_columns(campaign.scene, campaign.outputs);
  for (std::size_t i = 0; i < columns.size(); ++i)
    summary.outputs[i].nominal = output_of(columns[i], outcome);
}

bool is_streaming_folder(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / statistics_file);
}

std::string rows_file(const std::filesystem::path& folder) {
  return is_streaming_folder(folder) ? broken_runs_file : runs_file;
}

void refuse_rowless(const std::filesystem::path& folder) {
  if (is_streaming_folder(folder))
    throw SpecError(
        {{folder.string(), "", "a campaign that was run with --no-rows",
          fmt::format("one with {}: what is asked for takes every run's row", runs_file)}});
}

StoredCampaign read_stored_campaign(const std::filesystem::path& folder) {
  return read_campaign_of(folder, false);
}

StoredCampaign read_any_campaign(const std::filesystem::path& folder) {
  return read_campaign_of(folder, true);
}

RowsRead for_each_stored_row(const StoredCampaign& stored,
                             const std::function<void(const ResultRow&)>& take) {
  const std::filesystem::path path = stored.folder / runs_file;
  refuse_rowless(stored.folder);
  if (!std::filesystem::exists(path)) return {};
  InputFile in(path);
  const ResultNames names = RunPlan(stored.campaign).names();
  RowReader reader(in, path.string(), names,
                   stored.foreign ? UnterminatedRow::read : UnterminatedRow::drop);
  const RowCheck check(names, rules_of(stored.campaign));
  const auto [first, last] = stored.runs();
  while (reader.next()) {
    if (const auto fault = check.fault_in(reader.row()))
      throw reader.error(fault->column, fault->found, fault->expected);
    if (const long run = reader.row().run; run < first || run >= last)
      throw SpecError({{path.string(), "", fmt::format("run {}", run),
                        fmt::format("runs from {} up to {}, those of {}", first, last - 1,
                                    describe(stored.stamp.shard))}});
    take(reader.row());
  }
  return {reader.complete_bytes(), reader.unterminated()};
}

void refuse_without_rows(const std::filesystem::path& folder) {
  refuse_rowless(folder);
  if (!std::filesystem::exists(folder / runs_file))
    throw SpecError({{folder.string(), "", fmt::format("no {} in it", runs_file),
                      "a results folder with the rows of its runs"}});
}

ResultsFile read_stored_results(const StoredCampaign& stored) {
  refuse_without_rows(stored.folder);
  ResultsFile read{Results(RunPlan(stored.campaign).names()), 0, false};
  const RowsRead rows =
      for_each_stored_row(stored, [&](const ResultRow& row) { read.results.append(row); });
  read.complete_bytes = rows.complete_bytes;
  read.unterminated = rows.unterminated;
  const auto [first, last] = stored.runs();
  const std::filesystem::path path = stored.folder / runs_file;
  if (stored.foreign && !is_complete(stored, read.results))
    throw SpecError({{path.string(), "", fmt::format("{} runs", read.results.size()),
                      fmt::format("all {} of the campaign, deployed or not", last - first)}});
  return read;
}

std::optional<std::string> gaps_text(const StoredCampaign& stored, const Results& results,
                                     bool stopped) {
  const RunRange planned = stored.runs();
  const std::string& name = stored.campaign.of_case;
  const long made = std::ssize(results.runs);
  if (stopped || stored.stamp.preview || made == 0 ||
      results.runs[results.size() - 1] < planned.first + made)
    return std::nullopt;
  return fmt::format("{} of {} runs{}, with gaps that no interruption leaves: if runs were "
                     "selected, no verdict and no bound holds",
                     made, planned.size(), name.empty() ? "" : " of case " + name);
}

std::vector<StrangeDraws> strange_draws(const Campaign& campaign, const Results& results) {
  constexpr double tail = 1e-15;
  std::vector<StrangeDraws> found;
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i) {
    const PreparedDistribution law(campaign.dispersions[i].distribution);
    StrangeDraws draws{.name = campaign.dispersions[i].name,
                       .lower = law.quantile(tail),
                       .upper = law.quantile_complement(tail)};
    const double digits = 1e-9 * std::max(std::abs(draws.lower), std::abs(draws.upper));
    const Spilled<double>& values = results.draws[i].values;
    for (std::size_t row = 0; row < values.size(); ++row) {
      const double value = values[row];
      if (!(value < draws.lower - digits || value > draws.upper + digits)) continue;
      if (draws.runs++ == 0) draws.run = results.runs[row], draws.value = value;
    }
    values.release();
    if (draws.runs > 0) found.push_back(std::move(draws));
  }
  return found;
}

Summary stored_summary(const StoredCampaign& stored, const Results& results, int threads) {
  const Campaign& campaign = stored.campaign;
  const StatisticsSpec& spec = campaign.statistics;
  const InterimAnalyses interim = interim_analyses(campaign);
  StatisticsSpec at_an_analysis = spec;
  at_an_analysis.confidence = interim.confidence_of_bound(spec.confidence);
  Summary summary = summarize(results, at_an_analysis, replication_of(campaign.sampling, results),
                              threads, campaign.requirements);
  summary.confidence = spec.confidence;
  summary.interim = interim;
  summary.requirements = judge_campaign(campaign, results, interim);
  if (!spec.tolerance_limits.empty()) add_tolerance_limits(results, spec, summary);
  if (!campaign.until.empty()) summary.until = goals_of(stored, results);
  if (stored.foreign)
    summary.strange_draws = strange_draws(campaign, results);
  else
    add_nominal(campaign, summary);
  summary.overtravels = overtravels(campaign.scene, results);
  if (results.has_peaks_final) summary.peaks = count_peaks_final(results);
  withdraw_if_one_run(campaign, summary);
  explain_cuts(campaign, summary);
  const bool whole = std::ssize(results.runs) == stored.runs().size();
  summary.stopped = !whole && is_complete(stored, results);
  const bool unfinished = !stored.foreign && !whole && !summary.stopped;
  if (stored.stamp.is_part() || unfinished) withdraw_of_part(summary);
  if (!stored.foreign && !stored.stamp.shard && (whole || summary.stopped))
    summary.accuracy = measure_accuracy(campaign, results, {.threads = threads});
  return summary;
}

void write_summary_files(const StoredCampaign& stored, const Summary& summary) {
  Json json = summary_json(summary, about(stored, summary));
  if (Json asked = write_analysis(stored.campaign); !asked.empty())
    json[analyzed_key] = std::move(asked);
  write_file(stored.folder / summary_file, json_text(json));
  write_file(stored.folder / histograms_json_file, json_text(histograms_json(summary)));
  write_file(stored.folder / histograms_csv_file, histograms_csv(summary));
}

Summary write_statistics(const StoredCampaign& stored, const Results& results, int threads) {
  Summary summary = stored_summary(stored, results, threads);
  write_summary_files(stored, summary);
  return summary;
}

} // namespace wingspread
