#include "montecarlo/analyses/margin/margin_study.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/analyses/margin/recommendation.hpp"
#include "montecarlo/analyses/margin/scaled_springs.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/summary/judge_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace wingspread {
namespace {

bool is_of_static_margin(const Requirement& requirement) {
  return requirement.static_margin.has_value();
}

void refuse_unsuitable(const Campaign& campaign) {
  std::vector<Problem> problems;
  if (!campaign.margin)
    problems.push_back({"", "/margin", "nothing",
                        "the parameters to scale: a \"margin\" here, or the options --scale PATH… "
                        "--range A B, e.g. --scale 'hinges.*.spring.scale' --range 0.5 2"});
  if (const std::string where = where_nothing_varies(campaign); !where.empty())
    problems.push_back({"", "/dispersions", where,
                        "a parameter that varies: all runs at a scale are the same run, and show "
                        "no probability"});
  if (campaign.requirements.empty())
    problems.push_back(
        {"", "/requirements", "none", "at least one: the requirements limit the window"});
  else if (campaign.margin && !campaign.margin->nominal &&
           std::ranges::all_of(campaign.requirements, is_of_static_margin))
    problems.push_back(
        {"", "/margin/cases", "only cases with a lost spring",
         "\"nominal\" too, or a requirement on an output: those on static margins are "
         "not judged where a spring is lost"});
  const InterimAnalyses interim = interim_analyses(campaign);
  const std::vector<long> none_failed(interim.before.size(), 0); // then the most may break it
  for (const Requirement& requirement : campaign.requirements) {
    const PassingRule rule =
        passing_rule(interim, campaign.sampling.runs, requirement.probability,
                     confidence_alone(campaign.requirements, requirement), none_failed);
    if (rule.allowed) continue;
    const auto least = runs_to_show(requirement.probability, rule.confidence, 0);
    problems.push_back(
        {"", "/sampling/runs", std::to_string(campaign.sampling.runs),
         rule.joint && rule.joint->allowed_alone
             ? fmt::format("more: the analyses before (\"extended_from\") have left too "
                           "little of the risk to show \"{}\"",
                           to_string(requirement))
             : fmt::format("at least {}: fewer cannot show \"{}\"", least.value_or(most_runs_sized),
                           to_string(requirement))});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

/// The output families of the requirements. A run ends when these are known.
Outputs outputs_for(const std::vector<Requirement>& requirements) {
  Outputs outputs;
  for (const Requirement& requirement : requirements)
    if (const auto family = family_of(requirement.output)) outputs.insert(*family);
  match_peaks_final(outputs);
  return outputs;
}

/// Adds the cases of one campaign: nominal, and one per lost spring.
void add_cases(const Campaign& campaign, std::size_t index, std::vector<MarginCase>& cases) {
  const MarginSpec& spec = *campaign.margin;
  const std::string& name = campaign.of_case;
  if (spec.nominal) cases.push_back({name.empty() ? "nominal" : name, {}, index});
  if (!spec.one_spring_out) return;
  const Scene& scene = campaign.scene;
  for (int hinge = 0; hinge < std::ssize(scene.hinges); ++hinge) {
    if (!sizes_spring(spec.scaled, scene, hinge)) continue;
    const std::string lost = scene.hinges[hinge].name + " spring out";
    cases.push_back({name.empty() ? lost : fmt::format("{}, {}", name, lost),
                     spring_torques(scene, hinge), index});
  }
}

/// One search for all parameters, or one per hinge in the order of first mention.
std::vector<MarginSearch> searches_of(const MarginSpec& spec, const Scene& scene) {
  std::vector<MarginSearch> searches;
  if (spec.mode == MarginMode::joint)
    searches.push_back({.name = "joint", .scaled = spec.scaled});
  else
    for (const SceneParameter& parameter : spec.scaled) {
      const std::string& name = scene.hinges[parameter.index].name;
      auto found = std::ranges::find(searches, name, &MarginSearch::name);
      if (found == searches.end()) found = searches.insert(found, {.name = name, .scaled = {}});
      found->scaled.push_back(parameter);
    }
  for (MarginSearch& search : searches)
    search.of_springs = std::ranges::any_of(search.scaled, [&](const SceneParameter& parameter) {
      return sizes_a_spring(parameter, scene);
    });
  return searches;
}

/// The required quantile over the runs with the output, by the order statistic of a verdict's observed value; NaN if no run
/// has the output.
double quantile_over_runs(const Requirement& requirement, const Results& results) {
  const auto column = std::ranges::find(results.outputs, requirement.output, &Column::name);
  std::vector<double> values;
  if (column != results.outputs.end())
    for (const double value : column->values)
      if (!std::isnan(value)) values.push_back(requirement.absolute ? std::abs(value) : value);
  if (values.empty()) return std::nan("");
  if (requirement.min) // the same order statistic, counted from the largest
    std::ranges::sort(values, std::greater());
  else
    std::ranges::sort(values);
  const long rank = quantile_rank(std::ssize(values), requirement.probability);
  return values[static_cast<std::size_t>(rank - 1)];
}

/// Statuses, verdicts and quantiles of a case's runs at one scale.
CaseResult case_result(const Campaign& campaign, const MarginCase& which, const Results& results) {
  CaseResult one;
  for (const Status status : results.status) ++one.statuses[static_cast<std::size_t>(status)];
  one.open_latches = count_open_latches(results);
  one.verdicts = judge_campaign(campaign, results, interim_analyses(campaign));
  std::erase_if(one.verdicts,
                [&](const Verdict& verdict) { return !applies(verdict.requirement, which); });
  for (const Verdict& verdict : one.verdicts)
    one.quantiles.push_back(quantile_over_runs(verdict.requirement, results));
  return one;
}

/// Makes the runs of a search, scale by scale.
class ScaleRuns {
public:
  ScaleRuns(Evaluator& evaluator, const std::function<void(const StudyProgress&)>& progress,
            MarginResult& result)
      : campaigns_(result.campaigns), evaluator_(evaluator), progress_(progress), result_(result) {
    for (Campaign& campaign : campaigns_) campaign.outputs = outputs_for(campaign.requirements);
  }

  /// Sets an upper bound of the number of scales, for the progress display.
  void limit_scales(long scales) {
    most_ = std::max(scales_ + 1, most_ == 0 ? scales : std::min(most_, scales));
  }

  /// Makes all cases' runs at a scale and judges them.
  [[nodiscard]] ScaleResult judge_scale(const std::vector<SceneParameter>& parameters,
                                        double scale) {
    ScaleResult cases;
    for_each_case(parameters, scale, [&](const Campaign& campaign, const MarginCase& which) {
      cases.push_back(runs_of(campaign, which));
    });
    ++scales_;
    return cases;
  }

  /// Makes a shard's part of the runs at a scale, without judging them.
  void make_shard(const std::vector<SceneParameter>& parameters, double scale, const Shard& shard) {
    for_each_case(parameters, scale, [&](const Campaign& campaign, const MarginCase&) {
      const RunRange part = part_of_analysis({0, campaign.sampling.runs}, shard);
      make(RunPlan(campaign), part, part.size(), [](const Batch&) {});
    });
    ++scales_;
  }

  /// The number of scales so far.
  [[nodiscard]] long scales() const { return scales_; }

  void use_seed(std::uint64_t seed) {
    for (Campaign& campaign : campaigns_) override_sampling(campaign, std::nullopt, seed);
  }

private:
  /// @param take called for each case with its campaign at the scale, and the case
  template <class Take>
  void for_each_case(const std::vector<SceneParameter>& parameters, double scale,
                     const Take& take) {
    std::vector<Campaign> sized;
    for (const Campaign& campaign : campaigns_)
      sized.push_back(scaled(campaign, parameters, scale));
    for (const MarginCase& each : result_.cases) {
      const Campaign& campaign = sized[each.campaign];
      const double springs = static_cast<double>(campaign.motorization.springs_per_hinge);
      if (each.weakened.empty())
        take(campaign, each);
      else
        take(scaled(campaign, each.weakened, (springs - 1) / springs), each);
    }
  }

  [[nodiscard]] CaseResult runs_of(const Campaign& campaign, const MarginCase& which) {
    const RunPlan plan(campaign);
    Results results(plan.names());
    make(plan, {0, campaign.sampling.runs}, campaign.sampling.runs, [&](const Batch& batch) {
      for (const ResultRow& row : batch.rows) results.append(row);
    });
    CaseResult one = case_result(campaign, which, results);
    result_.failed += one.statuses[static_cast<std::size_t>(Status::failed)];
    return one;
  }

  /// @param runs number of runs of each case at a scale, for the progress display
  void make(const RunPlan& plan, RunRange range, long runs,
            const std::function<void(const Batch&)>& take) {
    const long cases = std::ssize(result_.cases);
    long done = result_.runs;
    const auto keep = [&](const Batch& batch) {
      take(batch);
      done += std::ssize(batch.rows);
      progress_({scales_ + 1, most_, done, most_ * cases * runs});
    };
    const long made = evaluator_.make(plan, range, {keep});
    result_.runs += made;
    if (made < range.size()) throw Stopped{};
  }

  std::vector<Campaign> campaigns_; ///< record only the outputs of the requirements
  Evaluator& evaluator_;
  const std::function<void(const StudyProgress&)>& progress_;
  MarginResult& result_;
  long scales_ = 0, most_ = 0;
};

/// Whether the campaign requires static margins. These then bound the window, and weaker_springs.hpp rules no scale
/// out.
bool requires_margins(const Campaign& campaign) {
  return std::ranges::any_of(campaign.requirements, [](const Requirement& requirement) {
    return requirement.static_margin.has_value();
  });
}

SearchRange range_of(const MarginSpec& spec) {
  return {spec.lower,          spec.upper,  static_cast<long>(spec.points),
          spec.edge_tolerance, spec.lowest, spec.highest};
}

/// The cases and searches, before any run. @pre the campaign has a /margin
MarginResult planned(const Campaign& campaign) {
  MarginResult result;
  result.campaigns = campaigns_of(campaign);
  for (std::size_t k = 0; k < result.campaigns.size(); ++k)
    add_cases(result.campaigns[k], k, result.cases);
  result.searches = searches_of(*campaign.margin, campaign.scene);
  result.confirmation_seed = confirmation_seed(campaign.sampling.seed);
  return result;
}

/// The cases and searches, before any run. @throws SpecError as find_margin does
MarginResult prepared(const Campaign& campaign) {
  refuse_unsuitable(campaign);
  return planned(campaign);
}

/// An upper bound of the number of scales of all searches, finished or not, with one confirmation each.
long most_scales_of(const std::vector<MarginSearch>& searches, const MarginSearch& current,
                    const SearchRange& range) {
  long most = std::ssize(searches);
  for (const MarginSearch& search : searches)
    most +=
        &search < &current ? std::ssize(search.seen) : most_scales(failing_by_scale(search), range);
  return most;
}

} // namespace

MarginRuns margin_runs(const Campaign& campaign) {
  const MarginResult plan = planned(campaign);
  const SearchRange range = range_of(*campaign.margin);
  const long at_a_scale =
      std::ssize(plan.searches) * std::ssize(plan.cases) * campaign.sampling.runs;
  return {at_a_scale * std::ssize(first_scales(range)),
          at_a_scale * (most_scales({}, range) + 1)}; // 1: the confirmation
}

std::uint64_t confirmation_seed(std::uint64_t seed) {
  return RandomStream(seed, 0,
                      stream_name("\x7F" // a control character: no dispersion has this name
                                  "margin confirmation"))();
}

void find_margin(const Campaign& campaign, Evaluator& evaluator,
                 const std::function<void(const StudyProgress&)>& progress, MarginResult& result) {
  result = prepared(campaign);
  const MarginSpec& spec = *campaign.margin;
  const SearchRange range = range_of(spec);
  ScaleRuns runs(evaluator, progress, result);
  for (MarginSearch& search : result.searches) {
    const auto run_at = [&](double scale) {
      runs.limit_scales(most_scales_of(result.searches, search, range));
      search.seen[scale] = runs.judge_scale(search.scaled, scale);
    };
    (void)search_window(range, [&](double scale) {
      run_at(scale);
      return failing(search.seen.at(scale));
    });
    const auto shortfall = [&](double scale) {
      return requires_margins(campaign) ? std::nullopt
                                        : shortfall_at(result.campaigns, search.scaled, scale);
    };
    recommend({spec.edge_tolerance, run_at, shortfall}, search);
  }
  runs.use_seed(result.confirmation_seed);
  long left = std::ranges::count_if(
      result.searches, [](const MarginSearch& search) { return search.recommended.has_value(); });
  for (MarginSearch& search : result.searches)
    if (search.recommended) {
      runs.limit_scales(runs.scales() + left--);
      search.confirmation = runs.judge_scale(search.scaled, *search.recommended);
    }
}

long run_first_scales(const Campaign& campaign, const Shard& shard, Evaluator& evaluator,
                      const std::function<void(const StudyProgress&)>& progress) {
  MarginResult result = prepared(campaign);
  const std::vector<double> scales = first_scales(range_of(*campaign.margin));
  ScaleRuns runs(evaluator, progress, result);
  runs.limit_scales(std::ssize(result.searches) * std::ssize(scales));
  for (const MarginSearch& search : result.searches)
    for (const double scale : scales) runs.make_shard(search.scaled, scale, shard);
  return result.runs;
}

} // namespace wingspread
