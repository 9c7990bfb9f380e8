#include "montecarlo/results/results_folder/cases_folder.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/guarantees.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

namespace wingspread {
namespace {

/// `"cold", "ambient" or "hot"`.
std::string names_of(const std::vector<CaseSpec>& cases) {
  std::vector<std::string_view> names;
  for (const CaseSpec& spec : cases) names.push_back(spec.name);
  return quoted_list(names);
}

SpecError unknown_case(const std::vector<CaseSpec>& cases, const std::string& name) {
  std::vector<std::string> names;
  for (const CaseSpec& spec : cases) names.push_back(spec.name);
  const std::string expected = cases.empty() ? "no case: the campaign has none"
                                             : names_of(cases) + did_you_mean(name, names);
  return SpecError({{"", "--case", fmt::format("\"{}\"", name), expected}});
}

/// Whether summary.json is of an `analyze` with other requirements or statistics than the campaign's.
bool has_own_analysis(const std::filesystem::path& folder) {
  try {
    return std::filesystem::exists(folder / summary_file) &&
           parse_json_file(folder / summary_file).contains(analyzed_key);
  } catch (const SpecError&) { // a broken file is written again
    return false;
  }
}

/// The named case; nothing if the campaign has no cases and none is named.
const CaseSpec* find_case(const std::vector<CaseSpec>& cases, const std::string& name) {
  if (cases.empty() && name.empty()) return nullptr;
  if (name.empty())
    throw SpecError({{"", "--case", "nothing", "one of the campaign's cases: " + names_of(cases)}});
  const auto found = std::ranges::find(cases, name, &CaseSpec::name);
  if (found == cases.end()) throw unknown_case(cases, name);
  return &*found;
}

} // namespace

bool is_cases_folder(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / campaign_file;
  return std::filesystem::exists(file) && parse_json_file(file).contains("cases");
}

std::filesystem::path folder_of_case(const std::filesystem::path& folder, const std::string& name) {
  if (name.empty() && !is_cases_folder(folder)) return folder;
  const StoredCampaign whole = read_stored_campaign(folder);
  return folder / find_case(whole.campaign.cases, name)->name;
}

std::vector<CaseSpec> chosen_cases(const Campaign& campaign, std::span<const std::string> names) {
  for (const std::string& name : names) (void)find_case(campaign.cases, name);
  std::vector<CaseSpec> chosen;
  for (const CaseSpec& spec : campaign.cases)
    if (names.empty() || std::ranges::find(names, spec.name) != names.end()) chosen.push_back(spec);
  return chosen;
}

Campaign chosen_case(const Campaign& campaign, const std::string& name) {
  const CaseSpec* spec = find_case(campaign.cases, name);
  return spec ? campaign_of_case(campaign, *spec) : campaign;
}

CasesFolder::CasesFolder(std::filesystem::path folder, const Campaign& campaign,
                         const std::optional<Shard>& shard, bool resume)
    : stored_{std::move(folder), campaign, stamp_of(campaign, shard)} {
  lock_campaign_folder(lock_, stored_.folder, resume);
  const std::filesystem::path file = stored_.folder / campaign_file;
  if (!is_new_folder(stored_.folder)) {
    const StoredCampaign there = read_stored_campaign(stored_.folder);
    if (stored_.campaign.sampling.extended_from.empty() &&
        there.campaign.sampling.seed == stored_.campaign.sampling.seed)
      note_extension(stored_.campaign, there.campaign.sampling.extended_from);
    refuse_other_campaign(there, stored_.campaign, stored_.stamp);
    for (const CaseSpec& spec : made_cases(there)) { // before a run of any case is made
      const StoredCampaign own = read_stored_campaign(there.folder / spec.name);
      Campaign ours = campaign_of_case(campaign, spec);
      note_extension(ours, own.campaign.sampling.extended_from);
      refuse_other_campaign(own, ours, stamp_of(ours, shard));
    }
    stored_.stamp = stamp_of(stored_.campaign, shard);
  }
  const std::string text = campaign_text(stored_.campaign, stored_.stamp);
  if (read_text(file) != text) write_file(file, text);
}

void CasesFolder::note_extensions() {
  std::set<std::int64_t> analyses(stored_.campaign.sampling.extended_from.begin(),
                                  stored_.campaign.sampling.extended_from.end());
  for (const CaseSpec& spec : made_cases(stored_)) {
    const StoredCampaign own = read_stored_campaign(stored_.folder / spec.name);
    analyses.insert(own.campaign.sampling.extended_from.begin(),
                    own.campaign.sampling.extended_from.end());
  }
  if (analyses.size() == stored_.campaign.sampling.extended_from.size()) return;
  note_extension(stored_.campaign, {analyses.begin(), analyses.end()});
  stored_.stamp = stamp_of(stored_.campaign, stored_.stamp.shard);
  write_file(stored_.folder / campaign_file, campaign_text(stored_.campaign, stored_.stamp));
}

std::vector<CaseSpec> made_cases(const StoredCampaign& whole) {
  std::vector<CaseSpec> made;
  for (const CaseSpec& spec : whole.campaign.cases)
    if (std::filesystem::exists(whole.folder / spec.name / campaign_file)) made.push_back(spec);
  return made;
}

CaseSummary case_summary(const StoredCampaign& whole, std::string name, Summary summary) {
  // the case's own campaign.json does not know of runs that were added to other cases only
  const bool partial = summary.runs < whole.runs().size() && !summary.stopped;
  return {std::move(name), std::move(summary), partial};
}

std::vector<CaseSummary> complete_cases(const StoredCampaign& whole, std::vector<CaseSummary> known,
                                        int threads) {
  std::vector<CaseSummary> all;
  for (const CaseSpec& spec : made_cases(whole)) {
    const auto found = std::ranges::find(known, spec.name, &CaseSummary::name);
    if (found != known.end()) {
      all.push_back(std::move(*found));
      continue;
    }
    const StoredCampaign stored = read_stored_campaign(whole.folder / spec.name);
    const FolderLock lock(stored.folder);
    Summary summary = stored_summary(stored, read_stored_results(stored).results, threads);
    if (!has_own_analysis(stored.folder)) write_summary_files(stored, summary);
    all.push_back(case_summary(whole, spec.name, std::move(summary)));
  }
  return all;
}

void write_cases_file(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
                      const std::filesystem::path& to) {
  if (!cases.empty())
    write_file(to / cases_file, json_text(cases_json(cases, stamp_json(whole.stamp))));
}

} // namespace wingspread
