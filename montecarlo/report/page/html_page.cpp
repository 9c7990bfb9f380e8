#include "montecarlo/report/page/html_page.hpp"

#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/report/data/differences.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/data/set_json.hpp"
#include "montecarlo/report/kernel/kernel_json.hpp"
#include "montecarlo/report/page/glossary.hpp"
#include "montecarlo/report/page/modes_json.hpp"
#include "montecarlo/report/page/page_files.hpp"
#include "montecarlo/report/page/static_margins_json.hpp"
#include "montecarlo/report/page/study_set.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

constexpr std::size_t most_sets = 12;

std::string name_of_folder(const std::filesystem::path& folder) {
  const std::filesystem::path name =
      folder.has_filename() ? folder.filename() : folder.parent_path().filename();
  return name.empty() || name == "." || name == ".." ? folder.string() : name.string();
}

/// Notes for the cases of a folder whether one `analyze` of the folder reproduces the statistics of all cases.
void note_analyses(std::span<const std::unique_ptr<PageSource>> cases) {
  const auto as_the_first = [&](const auto& source) {
    return write_analysis(source->stored.campaign) ==
           write_analysis(cases.front()->stored.campaign);
  };
  const bool alike = std::ranges::all_of(cases, as_the_first);
  for (const auto& source : cases) {
    source->analyzed_alone = !alike;
    if (alike) source->analyzed_in = cases.front()->stored.folder;
  }
}

/// Adds the sets of one folder. @param several whether the page has several folders; then labels of cases name the
/// folder
void read_folder(const std::filesystem::path& folder, bool several, int threads,
                 PageSources& sources) {
  const std::string name = name_of_folder(folder);
  if (is_study_folder(folder)) {
    for (Json& set : study_sets_json(folder, name)) sources.studies.push_back(std::move(set));
    return;
  }
  if (!is_cases_folder(folder)) {
    sources.runs.push_back(
        read_page_source(as_analyzed(read_any_campaign(folder)), name, nullptr, threads));
    return;
  }
  const StoredCampaign whole = read_stored_campaign(folder);
  const std::vector<CaseSpec> made = made_cases(whole);
  const std::size_t before = sources.runs.size();
  for (const CaseSpec& spec : made) {
    sources.runs.push_back(read_page_source(as_analyzed(read_stored_campaign(folder / spec.name)),
                                            several ? name + " · " + spec.name : spec.name,
                                            &whole.campaign, threads));
    sources.runs.back()->made_from = folder;
    if (made.size() < whole.campaign.cases.size())
      for (const CaseSpec& each : made) sources.runs.back()->made_cases.push_back(each.name);
  }
  note_analyses(std::span(sources.runs).subspan(before));
  for (const CaseSpec& spec : whole.campaign.cases)
    if (std::ranges::find(made, spec.name, &CaseSpec::name) == made.end())
      sources.unmade.push_back({several ? name + " · " + spec.name : spec.name, whole.runs().size(),
                                !whole.campaign.requirements.empty(), folder / spec.name});
}

PageExtent extent_of(const PageSources& sources) {
  PageExtent extent{std::max<std::size_t>(sources.runs.size(), 1)};
  for (const auto& source : sources.runs) {
    extent.hinges = std::max(extent.hinges, source->stored.campaign.scene.hinges.size());
    extent.outputs = std::max(extent.outputs, source->results.outputs.size());
  }
  return extent;
}

Json comparisons_json(const PageSources& sources, const Pairs& pairs) {
  Json json = Json::array();
  for (const auto& [i, j] : pairs.both)
    json.push_back(comparison_json(*sources.runs[i], *sources.runs[j], {i, j}));
  return json;
}

/// "4,500".
std::string grouped(long number) {
  return number < 1000 ? fmt::format("{}", number)
                       : fmt::format("{},{:03}", grouped(number / 1000), number % 1000);
}

/// "cold, ambient and hot".
std::string listed(const std::vector<std::string>& names) {
  const auto last = names.end() - 1;
  return names.size() == 1 ? *last
                           : fmt::format("{} and {}", fmt::join(names.begin(), last, ", "), *last);
}

/// The path without links and "..", as far as the system tells.
std::filesystem::path resolved_folder(const std::filesystem::path& path) {
  std::error_code unknown;
  const auto whole = std::filesystem::weakly_canonical(path, unknown);
  return unknown ? path : whole.has_filename() ? whole : whole.parent_path();
}

/// Whether the folder has cases; false if it cannot be read, because the command did not name it.
bool has_cases(const std::filesystem::path& folder) {
  try {
    return is_cases_folder(folder);
  } catch (const SpecError&) {
    return false;
  }
}

/// The folder of a set's whole campaign: of a case that around its own.
std::filesystem::path campaign_folder(const StoredCampaign& stored) {
  const std::filesystem::path own = resolved_folder(stored.folder);
  const std::string& of_case = stored.campaign.of_case;
  return !of_case.empty() && own.filename() == of_case && has_cases(own.parent_path())
             ? own.parent_path()
             : own;
}

/// Refuses a set that two folders of the command have: a folder, and a case of it.
void refuse_repeated_sets(const PageSources& sources,
                          std::span<const std::filesystem::path> arguments) {
  std::map<std::filesystem::path, std::size_t> argument_of;
  std::vector<Problem> problems;
  for (const auto& source : sources.runs) {
    const auto [first, is_new] =
        argument_of.emplace(resolved_folder(source->stored.folder), source->argument);
    if (is_new) continue;
    const std::string& of_case = source->stored.campaign.of_case;
    problems.push_back(
        {arguments[source->argument].string(), "",
         fmt::format("{} a second time, as in {}",
                     of_case.empty() ? source->stored.folder.string() : "case " + of_case,
                     arguments[first->second].string()),
         "each set of runs once: leave one of the two out"});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

/// The scene's name; of studies that an older version wrote without it, the first one's label.
std::string title_of(const PageSources& sources) {
  if (!sources.runs.empty()) return sources.runs.front()->stored.campaign.scene.name;
  for (const Json& study : sources.studies)
    if (study.at("campaign") != "") return study["campaign"];
  return sources.studies.front().at("label");
}

} // namespace

void label_by_path(PageSources& sources) {
  std::map<std::string, std::size_t> times;
  for (const auto& source : sources.runs) ++times[source->label];
  for (const UnmadeCase& each : sources.unmade) ++times[each.label];
  for (const Json& set : sources.studies) ++times[set.at("label").get<std::string>()];
  std::set<std::size_t> arguments;
  for (const auto& source : sources.runs)
    if (times[source->label] > 1) arguments.insert(source->argument);
  for (const UnmadeCase& each : sources.unmade)
    if (times[each.label] > 1) arguments.insert(each.argument);
  for (const auto& source : sources.runs)
    if (arguments.contains(source->argument)) {
      const std::filesystem::path& folder = source->stored.folder;
      source->label = (folder.has_filename() ? folder : folder.parent_path()).string();
    }
  for (UnmadeCase& each : sources.unmade)
    if (arguments.contains(each.argument)) each.label = each.folder.string();
  for (Json& set : sources.studies) { // "margin · joint": its folder, then its search
    const std::string label = set["label"], folder = set["folder"];
    if (times[label] > 1) set["label"] = folder + label.substr(name_of_folder(folder).size());
  }
}

PageSources read_page_sources(std::span<const std::filesystem::path> folders, int threads) {
  PageSources sources;
  for (std::size_t argument = 0; argument < folders.size(); ++argument) {
    const std::size_t before = sources.runs.size(), unmade = sources.unmade.size();
    read_folder(folders[argument], folders.size() > 1, threads, sources);
    for (std::size_t k = before; k < sources.runs.size(); ++k) sources.runs[k]->argument = argument;
    for (std::size_t k = unmade; k < sources.unmade.size(); ++k)
      sources.unmade[k].argument = argument;
  }
  const std::size_t sets = sources.runs.size() + sources.studies.size();
  if (sets == 0 || sets > most_sets)
    throw SpecError({{folders.front().string(), "", fmt::format("{} sets of runs", sets),
                      fmt::format("from 1 to {}: each folder or case is a set", most_sets)}});
  refuse_repeated_sets(sources, folders);
  label_by_path(sources);
  return sources;
}

std::string incomplete_text(const PageSources& sources) {
  std::vector<std::string> parts, none;
  const bool several = sources.runs.size() + sources.unmade.size() > 1;
  const auto kind_of = [](const PageSource& source) {
    return source.stored.campaign.of_case.empty() ? "" : "case ";
  };
  const char* kind = "case "; // of the first without runs
  for (const auto& source : sources.runs) {
    const long planned = source->stored.runs().size(), made = source->summary.runs;
    if (source->summary.stopped || made >= planned) continue;
    const bool first = parts.empty();
    if (made == 0 && several) {
      if (none.empty()) kind = kind_of(*source);
      none.push_back(source->label);
    } else {
      parts.push_back(fmt::format(
          "{} of {}{}{}", made == 0 ? "none" : grouped(made), grouped(planned),
          first ? " runs" : "",
          several ? fmt::format(" of {}{}", first ? kind_of(*source) : "", source->label) : ""));
    }
  }
  for (const UnmadeCase& each : sources.unmade) none.push_back(each.label);
  if (!none.empty())
    parts.push_back(fmt::format("{} of {}{}", parts.empty() ? "no run" : "none",
                                parts.empty() ? kind : "", listed(none)));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string unjudged_text(const PageSources& sources) {
  std::vector<std::string> unjudged;
  bool any_judged = false;
  for (const auto& source : sources.runs) {
    const std::vector<Verdict>& verdicts = source->summary.requirements;
    if (verdicts.empty()) continue;
    const bool of_part = std::ranges::any_of(verdicts, &Verdict::of_part);
    if (of_part) unjudged.push_back(source->label);
    any_judged |= !of_part;
  }
  for (const UnmadeCase& each : sources.unmade)
    if (each.has_requirements) unjudged.push_back(each.label);
  if (unjudged.empty()) return "";
  if (!any_judged) return "requirements are not judged";
  return fmt::format("requirements of {} are not judged", listed(unjudged));
}

namespace {

/// The words on the first page: those given, then those of the first campaign that has them, then those of studies.
Json header_json(const PageSources& sources, const ReportHeader& given) {
  Json json = Json::object();
  for (auto study = sources.studies.rbegin(); study != sources.studies.rend(); ++study)
    json.update(study->at("document"));
  for (auto source = sources.runs.rbegin(); source != sources.runs.rend(); ++source)
    json.update(write_report_header((*source)->stored.campaign.report));
  json.update(write_report_header(given));
  return json;
}

} // namespace

Json page_json(const PageSources& sources, const ReportHeader& header, const std::string& command,
               int threads) {
  const PageDetail detail = page_detail(extent_of(sources));
  const Pairs pairs = pairs_of(sources.runs);
  const std::string incomplete = incomplete_text(sources);
  Json json{{"format", 1},
            {"version", version()},
            {"command", command},
            {"title", title_of(sources)},
            {"document", header_json(sources, header)},
            {"glossary", glossary_json()},
            {"sets", Json::array()},
            {"comparisons", comparisons_json(sources, pairs)},
            {"incomplete", incomplete.empty() ? Json(nullptr) : Json(incomplete)},
            {"unmade", Json::array()},
            {"unpaired", pairs.missing}};
  std::map<std::filesystem::path, std::size_t> number_of; // of the campaigns' folders
  const auto number = [&](const std::filesystem::path& folder) {
    return number_of.emplace(folder, number_of.size()).first->second;
  };
  std::vector<Json> margins(sources.runs.size());
  for_each_task(threads, margins.size(), [&](std::size_t i) {
    margins[i] = static_margins_json(sources.runs[i]->stored.campaign);
  });
  for (std::size_t i = 0; i < sources.runs.size(); ++i) {
    const auto& source = sources.runs[i];
    json["sets"].push_back(set_json(*source, detail, threads));
    json["sets"].back()["campaign_folder"] = number(campaign_folder(source->stored));
    json["sets"].back()["static_margins"] = std::move(margins[i]);
    json["sets"].back()["modes"] = modes_json(nominal_scene(source->stored.campaign));
    json["sets"].back()["kernel"] =
        source->replayable() ? kernel_json(source->stored.campaign) : Json(nullptr);
  }
  for (const UnmadeCase& each : sources.unmade)
    json["unmade"].push_back(
        {{"label", each.label},
         {"case", each.folder.filename().string()},
         {"planned", each.planned},
         {"campaign_folder", number(resolved_folder(each.folder.parent_path()))}});
  for (const Json& set : sources.studies) json["sets"].push_back(set);
  return json;
}

std::string html_page(const Json& data) {
  std::string page(page_before_data);
  page += "<script type=\"application/json\" id=\"data\">";
  page += page_text(data);
  page += "</script>";
  return page += page_after_data;
}

} // namespace wingspread
