#include "montecarlo/model/campaign/campaign_json.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"
#include "montecarlo/model/campaign/guarantees.hpp"
#include "montecarlo/model/campaign/wanted_correlations.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace wingspread {
namespace {

constexpr const char* expected_scene = "a scene, or the name of the file that holds it";

/// Refuses more dispersions than Sobol' points have coordinates.
void refuse_dimensions(const JsonCursor& at, const Sampling& sampling, const Coordinates& drawn) {
  if (sampling.design == DesignKind::sobol && drawn.names.size() > most_sobol_dimensions)
    at.refuse(fmt::format("{} dispersions", drawn.names.size()),
              fmt::format("up to {} with the design \"sobol\"", most_sobol_dimensions));
}

/// Refuses goals to stop at in an extended campaign: they need interim analyses that are fixed before the first run.
void refuse_extended_rule(const JsonCursor& at, const Campaign& campaign) {
  if (campaign.until.empty() || campaign.sampling.extended_from.empty()) return;
  at.refuse("goals to stop at", "no goals: they need interim analyses that are fixed before the "
                                "first run, and the campaign was extended");
}

/// Reads a scene inside the campaign, or from the file that the campaign names.
Scene read_scene_member(const JsonCursor& at, const std::filesystem::path& directory) {
  if (!at.value().is_string()) return read_scene(at);
  std::string name;
  at.read(name, expected_scene);
  const std::filesystem::path path = directory / name;
  const auto text = read_text(path);
  try {
    if (text) {
      const Json document = parse_json(*text, path.string());
      return read_scene(JsonCursor(document, path.string(), at.problems()));
    }
    at.refuse(fmt::format("no file that can be read at \"{}\"", path.string()), expected_scene);
  } catch (const SpecError& error) {
    at.problems().insert(at.problems().end(), error.problems().begin(), error.problems().end());
  }
  return {};
}

/// The campaign's own key `motorization`: in contrast to the margin's, with `springs_per_hinge`.
Json motorization_by_itself(const StaticMarginSpec& motorization, const Scene& scene) {
  Json json = write_static_margins(motorization, scene);
  json["springs_per_hinge"] = motorization.springs_per_hinge;
  return json;
}

Json write_campaign(const Campaign& campaign, Json dispersions) {
  Json json{{"scene", write_scene(campaign.scene)},
            {"dispersions", std::move(dispersions)},
            {"sampling", write_sampling(campaign.sampling)},
            {"integration", write_integration(campaign.integration)},
            {"outputs", write_outputs(campaign.outputs)},
            {"statistics", write_statistics(campaign.statistics)}};
  // Written only where used: a campaign's hash depends on the JSON.
  if (!campaign.wanted_correlations.empty())
    json["correlations"] =
        write_wanted_correlations(campaign.wanted_correlations, campaign.dispersions);
  if (!campaign.requirements.empty())
    json["requirements"] = write_requirements(campaign.requirements);
  if (campaign.report != ReportHeader{}) json["report"] = write_report_header(campaign.report);
  if (!campaign.until.empty()) json["until"] = write_stopping_rule(campaign.until);
  if (!campaign.cases.empty()) json["cases"] = write_cases(campaign.cases);
  if (!campaign.of_case.empty()) json["case"] = campaign.of_case;
  const StaticMarginSpec& motorization = campaign.motorization;
  if (campaign.margin)
    json["margin"] = write_margin(*campaign.margin, motorization, campaign.scene);
  else if (const Json given = motorization_by_itself(motorization, campaign.scene);
           given != motorization_by_itself(default_static_margins(campaign.scene), campaign.scene))
    json["motorization"] = given;
  return json;
}

/// Reads a campaign part by part. Later parts look names up only in earlier parts without problems.
class CampaignReader {
public:
  CampaignReader(const Json& document, std::filesystem::path directory, const std::string& file,
                 std::vector<Question>* questions = nullptr)
      : directory_(std::move(directory)),
        object_(JsonCursor(document, file, problems_, questions), "a campaign: an object"),
        was_run_(document.is_object() && document.contains(stamp_key)) {}

  /// @throws SpecError with all problems
  [[nodiscard]] Campaign read() {
    read_scene_and_dispersions();
    read_settings();
    read_dependence();
    read_guarantees();
    read_margins();
    (void)object_.find(stamp_key);
    object_.pass_over_schema();
    if (!was_run_) add_recorded();
    object_.refuse_others();
    if (!problems_.empty()) throw SpecError(std::move(problems_));
    campaign_.resolved = write_campaign(campaign_, std::move(resolved_dispersions_));
    return std::move(campaign_);
  }

private:
  template <class Part>
  void read_part(const char* key, void (*reader)(const JsonCursor&, Part&), Part& part) {
    if (const auto at = object_.find(key)) reader(*at, part);
  }

  /// Adds outputs that are always recorded. Not for stored campaigns, which keep their columns.
  void add_recorded() {
    campaign_.outputs.insert(OutputFamily::overtravel);
    match_peaks_final(campaign_.outputs);
  }

  void read_scene_and_dispersions() {
    if (const auto at = object_.require("scene", expected_scene))
      campaign_.scene = read_scene_member(*at, directory_);
    if (problems_.empty()) scene_ = &campaign_.scene;
    Dispersions varied;
    varied.resolved = Json::array();
    if (const auto at = object_.find("dispersions"))
      varied = read_dispersions(*at, scene_, directory_);
    named_ = problems_.empty();
    read_its_cases(varied);
    campaign_.dispersions = std::move(varied.list);
    resolved_dispersions_ = std::move(varied.resolved);
  }

  void read_its_cases(const Dispersions& varied) {
    if (const auto at = object_.find("cases"))
      campaign_.cases = read_cases(*at, scene_, named_ ? &varied : nullptr, directory_);
    if (const auto at = object_.find("case"); at && !campaign_.cases.empty())
      at->refuse("no case of another campaign beside \"cases\"");
    object_.optional("case", campaign_.of_case, "a string, the name of a case", is_case_name);
  }

  void read_settings() {
    read_part("sampling", read_sampling, campaign_.sampling);
    std::size_t before = problems_.size();
    if (const auto at = object_.find("integration")) read_integration(*at, campaign_.integration);
    if (!was_run_ && scene_ && campaign_.integration.smoothing)
      if (const std::string found = beyond_smoothed_latches(*scene_); !found.empty())
        object_.at().member("integration").member("latch").refuse(found, expected_event_latches);
    if (!was_run_ && problems_.size() == before) t_end_ = campaign_.integration.t_end;
    before = problems_.size();
    if (scene_) campaign_.outputs = default_outputs(*scene_);
    read_part("outputs", read_outputs, campaign_.outputs);
    if (scene_ && scene_->base.motion != BaseMotion::free &&
        campaign_.outputs.contains(OutputFamily::base_motion))
      object_.at().member("outputs").refuse("\"base_motion\" with a base that is not free",
                                            "a base whose motion is \"free\"");
    outputs_known_ = scene_ && problems_.size() == before;
    read_part("statistics", read_statistics, campaign_.statistics);
    read_part("report", read_report_header, campaign_.report);
  }

  void read_dependence() {
    if (const auto at = object_.find("correlations"))
      campaign_.wanted_correlations =
          read_wanted_correlations(*at, named_ ? &campaign_.dispersions : nullptr);
    if (const auto at = object_.find("dispersions"))
      refuse_dimensions(*at, campaign_.sampling, coordinates_of(campaign_.dispersions));
  }

  void read_guarantees() {
    const DesignKind design = campaign_.sampling.design;
    const GuaranteeReader guarantees(outputs_known_ ? scene_ : nullptr, campaign_.outputs, design,
                                     t_end_);
    const std::size_t before = problems_.size();
    if (const auto at = object_.find("requirements")) guarantees.read(*at, campaign_.requirements);
    const bool sound = problems_.size() == before;
    if (const auto at = object_.find("until")) {
      guarantees.read(*at, sound ? &campaign_.requirements : nullptr, campaign_.until);
      refuse_extended_rule(*at, campaign_);
    }
    if (!campaign_.statistics.tolerance_limits.empty())
      refuse_dependent_draws(object_.at().member("statistics").member("tolerance"),
                             "tolerance limits", design);
  }

  /// Reads `margin` and `motorization`; the latter may stand in either place.
  void read_margins() {
    campaign_.motorization = default_static_margins(campaign_.scene);
    const auto own = object_.find("motorization");
    if (own) read_static_margins(*own, scene_, campaign_.motorization);
    const auto margin = object_.find("margin");
    if (!margin) return;
    if (own && margin->value().is_object() && margin->value().contains("motorization"))
      margin->member("motorization")
          .refuse_repeated("\"motorization\"", "the key once: here or in the campaign");
    campaign_.margin = read_margin(*margin, scene_, campaign_.motorization);
  }

  std::filesystem::path directory_;
  std::vector<Problem> problems_;
  JsonObject object_;
  bool was_run_; ///< the document has a stamp: it is the campaign of a results folder
  Campaign campaign_;
  Json resolved_dispersions_ = Json::array();
  const Scene* scene_ = nullptr; ///< null if the scene has problems
  bool named_ = false;           ///< scene and dispersions have no problems
  bool outputs_known_ = false;
  std::optional<double> t_end_; ///< upper limit of required times
};

Campaign read_document(const Json& document, const std::filesystem::path& directory,
                       const std::string& file) {
  return CampaignReader(document, directory, file).read();
}

} // namespace

Campaign read_campaign(const std::string& text, const std::filesystem::path& directory,
                       const std::string& file) {
  return read_document(parse_json(text, file), directory, file);
}

Campaign read_campaign(const Json& document, std::vector<Question>& questions) {
  return CampaignReader(document, {}, "", &questions).read();
}

Campaign read_campaign_file(const std::filesystem::path& path) {
  return read_document(parse_json_file(path), path.parent_path(), path.string());
}

Scene read_scene_file(const std::filesystem::path& path) {
  return read_scene(parse_json_file(path), path.string());
}

namespace {

std::variant<Scene, Campaign>
read_either(const Json& document, const std::filesystem::path& directory, const std::string& file) {
  constexpr std::array campaign_keys{"scene", "dispersions", "sampling"};
  const auto has = [&](const char* key) { return document.contains(key); };
  if (std::ranges::any_of(campaign_keys, has)) return read_document(document, directory, file);
  return read_scene(document, file);
}

} // namespace

std::variant<Scene, Campaign> read_file(const std::filesystem::path& path) {
  return read_either(parse_json_file(path), path.parent_path(), path.string());
}

std::variant<Scene, Campaign> read_scene_or_campaign(const std::string& text,
                                                     const std::filesystem::path& directory) {
  return read_either(parse_json(text), directory, "");
}

void override_sampling(Campaign& campaign, std::optional<std::int64_t> runs,
                       std::optional<std::uint64_t> seed) {
  if (runs && has_replicates(campaign.sampling) && *runs < campaign.sampling.replicates)
    throw SpecError({{"", "--runs", std::to_string(*runs),
                      fmt::format("at least {}, one for each of the campaign's replicates",
                                  campaign.sampling.replicates)}});
  Sampling& sampling = campaign.sampling;
  if (seed && *seed != sampling.seed)
    sampling.extended_from.clear(); // new draws, not analysed before
  sampling.runs = runs.value_or(sampling.runs);
  sampling.seed = seed.value_or(sampling.seed);
  std::erase_if(sampling.extended_from, [&](std::int64_t seen) { return seen >= sampling.runs; });
  campaign.resolved["sampling"] = write_sampling(campaign.sampling);
}

namespace {

/// Re-validates a campaign after its resolved JSON was changed. @param by what changed it, for messages
Campaign revalidate(const Campaign& campaign, const Json& changed, const std::string& by) {
  Campaign read = read_document(changed, {}, by);
  read.outputs =
      campaign.outputs; // the reader adds overtravel, which stored campaigns may not have
  read.resolved["outputs"] = write_outputs(read.outputs);
  return read;
}

} // namespace

Campaign with_scene(const Campaign& campaign, const Scene& scene) {
  Json json = campaign.resolved;
  json["scene"] = write_scene(scene);
  return revalidate(campaign, json, "with these changes");
}

namespace {

/// Keeps the coefficient of each pair of which a case changes a law: its covariance is that of the campaign's laws. With
/// the same coefficients all cases have the same draws.
void keep_coefficients(const Campaign& campaign, const CaseSpec& spec, Json& correlations) {
  const auto has_law_of_case = [&](std::size_t i) {
    return std::ranges::any_of(spec.distributions, [&](const CaseDistribution& law) {
      return is_drawn_by(campaign, law.dispersion, campaign.dispersions[i]);
    });
  };
  for (std::size_t k = 0; k < campaign.wanted_correlations.size(); ++k) {
    const RankCorrelation& pair = campaign.wanted_correlations[k];
    if (!pair.covariance || !(has_law_of_case(pair.first) || has_law_of_case(pair.second)))
      continue;
    correlations[k].erase("covariance");
    correlations[k]["spearman"] = pair.spearman;
  }
}

} // namespace

Campaign campaign_of_case(const Campaign& campaign, const CaseSpec& spec) {
  Json json = campaign.resolved;
  json.erase("cases");
  json["case"] = spec.name;
  json["scene"] = write_scene(scene_of_case(campaign.scene, spec));
  for (const auto& [name, distribution] : spec.distributions)
    for (Json& dispersion : json["dispersions"])
      if (dispersion["name"] == name) dispersion["distribution"] = write_distribution(distribution);
  if (json.contains("correlations")) keep_coefficients(campaign, spec, json["correlations"]);
  return revalidate(campaign, json, fmt::format("case \"{}\"", spec.name));
}

std::vector<Campaign> campaigns_of(const Campaign& campaign) {
  if (campaign.cases.empty()) return {campaign};
  std::vector<Campaign> campaigns;
  for (const CaseSpec& spec : campaign.cases) campaigns.push_back(campaign_of_case(campaign, spec));
  return campaigns;
}

std::string where_nothing_varies(const Campaign& campaign, std::span<const CaseSpec> cases) {
  const std::string what = campaign.dispersions.empty() ? "none" : "laws with a single value only";
  if (campaign.cases.empty()) return vary(campaign.dispersions) ? "" : what;
  std::vector<std::string> names;
  for (const CaseSpec& spec : cases.empty() ? std::span(campaign.cases) : cases)
    if (!vary(campaign_of_case(campaign, spec).dispersions)) names.push_back(spec.name);
  if (names.empty()) return "";
  return fmt::format("{} in case{} {}", what, names.size() == 1 ? "" : "s", fmt::join(names, ", "));
}

void note_extension(Campaign& campaign, std::vector<std::int64_t> extended_from) {
  campaign.sampling.extended_from = std::move(extended_from);
  campaign.resolved["sampling"] = write_sampling(campaign.sampling);
}

void override_stopping(Campaign& campaign, const JsonCursor& at) {
  guarantee_reader(campaign).read(at, &campaign.requirements, campaign.until);
  refuse_extended_rule(at, campaign);
  campaign.resolved = write_campaign(campaign, Json(campaign.resolved.at("dispersions")));
}

Json write_analysis(const Campaign& campaign) {
  Json json = Json::object();
  const auto add = [&](const char* key, Json asked) {
    if (asked != campaign.resolved.value(key, Json::array())) json[key] = std::move(asked);
  };
  add("requirements", write_requirements(campaign.requirements));
  add("statistics", write_statistics(campaign.statistics));
  return json;
}

void read_analysis(const JsonCursor& at, Campaign& campaign) {
  JsonObject object(at, "requirements and statistics: an object");
  if (const auto asked = object.find("requirements"))
    guarantee_reader(campaign).read(*asked, campaign.requirements);
  if (const auto asked = object.find("statistics")) {
    campaign.statistics = {};
    read_statistics(*asked, campaign.statistics);
  }
  object.refuse_others();
}

void override_requirements(Campaign& campaign, const std::filesystem::path& path) {
  campaign.requirements = read_requirements_file(path, campaign);
  std::erase_if(campaign.until, [&](const StoppingGoal& goal) {
    const auto* decided = std::get_if<DecisionGoal>(&goal);
    return decided && std::ranges::none_of(campaign.requirements, [&](const Requirement& each) {
             return name_of(each) == decided->requirement;
           });
  });
  campaign.resolved = write_campaign(campaign, Json(campaign.resolved.at("dispersions")));
}

} // namespace wingspread
