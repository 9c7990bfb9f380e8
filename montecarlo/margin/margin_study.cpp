#include "montecarlo/margin/margin_study.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/formats/output_name.hpp"
#include "montecarlo/machine/interrupt.hpp"
#include "montecarlo/margin/scaled_springs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace wingspread {
namespace {

void refuse_unsuitable(const Campaign& campaign) {
  std::vector<Problem> problems;
  if (!campaign.margin) problems.push_back({"", "/margin", "nothing", "what to size"});
  if (campaign.requirements.empty())
    problems.push_back(
        {"", "/requirements", "none", "at least one: it is they that make a window"});
  for (const Requirement& requirement : campaign.requirements) {
    const auto least = runs_to_show(requirement.probability,
                                    confidence_alone(campaign.requirements, requirement), 0);
    if (!least || campaign.sampling.runs < *least)
      problems.push_back({"", "/sampling/runs", std::to_string(campaign.sampling.runs),
                          fmt::format("at least {}: fewer cannot show \"{}\"",
                                      least.value_or(most_runs_sized), to_string(requirement))});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

/// The families that the requirements are about: a run goes no further than they need.
Outputs outputs_for(const std::vector<Requirement>& requirements) {
  Outputs outputs;
  for (const Requirement& requirement : requirements) {
    const std::string quantity = parse_output_name(requirement.output).quantity;
    const auto family = std::ranges::find(output_family_names, quantity);
    if (family != output_family_names.end())
      outputs.insert(static_cast<OutputFamily>(family - output_family_names.begin()));
  }
  match_peaks_final(outputs);
  return outputs;
}

std::vector<MarginCase> cases_of(const MarginSpec& spec, const Scene& scene) {
  std::vector<MarginCase> cases;
  if (spec.nominal) cases.push_back({"nominal", {}});
  if (!spec.one_spring_out) return cases;
  for (int hinge = 0; hinge < std::ssize(scene.hinges); ++hinge) {
    if (sizes_spring(spec.scaled, scene, hinge))
      cases.push_back({scene.hinges[hinge].name + " spring out", spring_torques(scene, hinge)});
  }
  return cases;
}

/// What is scaled together: all of it, or hinge by hinge in the order of the first mention.
std::vector<MarginSearch> searches_of(const MarginSpec& spec, const Scene& scene) {
  if (spec.mode == MarginMode::joint) return {{"joint", spec.scaled, {}, {}, {}}};
  std::vector<MarginSearch> searches;
  for (const SceneParameter& parameter : spec.scaled) {
    const std::string& name = scene.hinges[parameter.index].name;
    auto found = std::ranges::find(searches, name, &MarginSearch::name);
    if (found == searches.end()) found = searches.insert(found, MarginSearch{name, {}, {}, {}, {}});
    found->scaled.push_back(parameter);
  }
  return searches;
}

/// Makes the runs that a search asks for.
class Looking {
public:
  Looking(const Campaign& campaign, Evaluator& evaluator, const std::function<void(long)>& progress,
          MarginResult& result)
      : campaign_(campaign), evaluator_(evaluator), progress_(progress), result_(result) {
    campaign_.outputs = outputs_for(campaign.requirements);
  }

  [[nodiscard]] ScaleLook at(const std::vector<SceneParameter>& parameters, double scale) {
    const Campaign sized = scaled(campaign_, parameters, scale);
    const double springs = static_cast<double>(campaign_.motorization.springs_per_hinge);
    ScaleLook look;
    for (const MarginCase& each : result_.cases)
      look.push_back(each.weakened.empty()
                         ? runs_of(sized)
                         : runs_of(scaled(sized, each.weakened, (springs - 1) / springs)));
    return look;
  }

  void use_seed(std::uint64_t seed) { override_sampling(campaign_, std::nullopt, seed); }

private:
  [[nodiscard]] CaseLook runs_of(const Campaign& campaign) {
    const RunPlan plan(campaign);
    Results results(plan.names());
    const RunRange range{0, campaign.sampling.runs};
    const long before = result_.runs;
    const auto keep = [&](const Batch& batch) {
      for (const ResultRow& row : batch.rows) results.append(row);
      progress_(before + std::ssize(results.runs));
    };
    const long made = evaluator_.make(plan, range, {keep});
    result_.runs += made;
    if (made < range.size()) throw Stopped{};
    CaseLook look;
    for (const Status status : results.status) ++look.statuses[static_cast<std::size_t>(status)];
    result_.failed += look.statuses[static_cast<std::size_t>(Status::failed)];
    look.verdicts = judge_all(campaign.requirements, results);
    return look;
  }

  Campaign campaign_;
  Evaluator& evaluator_;
  const std::function<void(long)>& progress_;
  MarginResult& result_;
};

} // namespace

std::uint64_t confirmation_seed(std::uint64_t seed) {
  return RandomStream(seed, 0,
                      stream_name("\x7F" // no dispersion's name: those hold no such character
                                  "margin confirmation"))();
}

void find_margin(const Campaign& campaign, Evaluator& evaluator,
                 const std::function<void(long)>& progress, MarginResult& result) {
  refuse_unsuitable(campaign);
  const MarginSpec& spec = *campaign.margin;
  result = {cases_of(spec, campaign.scene), searches_of(spec, campaign.scene),
            confirmation_seed(campaign.sampling.seed), 0, 0};
  Looking looking(campaign, evaluator, progress, result);
  for (MarginSearch& search : result.searches) {
    const auto judge = [&](double scale) {
      return failing(search.seen[scale] = looking.at(search.scaled, scale));
    };
    const SearchRange range{spec.lower, spec.upper, static_cast<long>(spec.points),
                            spec.edge_tolerance};
    search.recommended = recommended(search_window(range, judge), spec.edge_tolerance);
  }
  looking.use_seed(result.confirmation_seed);
  for (MarginSearch& search : result.searches)
    if (search.recommended) search.confirmation = looking.at(search.scaled, *search.recommended);
}

} // namespace wingspread
