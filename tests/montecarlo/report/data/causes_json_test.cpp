#include "montecarlo/analyses/sensitivity/levers.hpp"
#include "montecarlo/analyses/sensitivity/rank_sensitivity.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/report/data/causes_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/data/set_json.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <numeric>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a scatter shows the extreme runs and some of all the others", "[page]") {
  std::mt19937_64 random(2);
  std::vector<double> x(5000), y(5000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = uniform(random), y[i] = uniform(random);
  x[17] = nothing;
  x[4000] = 9;
  y[1234] = -9;
  const auto rows = scatter_rows(column_of("x", x), column_of("y", y), 400);
  CHECK(rows.size() <= 400);
  CHECK(rows.size() > 350);
  CHECK(std::ranges::is_sorted(rows));
  CHECK(std::ranges::count(rows, 17u) == 0);
  CHECK(std::ranges::count(rows, 4000u) == 1);
  CHECK(std::ranges::count(rows, 1234u) == 1);
  const auto inner = std::ranges::count_if(rows, [&](std::size_t row) {
    return x[row] > 0.1 && x[row] < 0.9 && y[row] > 0.1 && y[row] < 0.9;
  });
  CHECK(inner > 100); // 240 evenly chosen ones, of which 64 % lie there
  const std::vector<double> few{3, nothing, 1};
  CHECK(scatter_rows(column_of("x", few), column_of("y", few), 400) ==
        std::vector<std::size_t>{0, 2});
}

TEST_CASE("the strongest pairs come first, at most two of an output", "[page]") {
  const auto source = made(quick_campaign(200));
  const auto pairs = strongest_pairs(*source, 8);
  REQUIRE(pairs.size() == 8);
  std::map<std::size_t, int> of_output;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0) CHECK(std::abs(pairs[i].spearman) <= std::abs(pairs[i - 1].spearman));
    CHECK(++of_output[pairs[i].output] <= 2);
    CHECK(pairs[i].output < source->results.outputs.size()); // `deployed` is no axis
  }
  const Json scatter = scatters_json(*source, {}, 1).front();
  CHECK(scatter["draw"] == source->results.draws[pairs[0].draw].name);
  const auto density = scatter["density"].get<std::vector<long>>();
  REQUIRE(density.size() == 1024);
  CHECK(std::accumulate(density.begin(), density.end(), 0L) == 200);
  CHECK(scatter["points"]["run"].size() == 200);
}

TEST_CASE("pairs of an output that fails a requirement come first; of three runs there are none",
          "[page]") {
  Json campaign = quick_campaign(200);
  campaign["outputs"].push_back("overtravel"); // recorded anyway; required only if asked for
  const std::size_t weakest = strongest_pairs(*made(campaign), 8).back().output;
  const std::string name = made(campaign)->results.outputs[weakest].name;
  campaign["requirements"] =
      Json::array({{{"output", name}, {"max", -1e3}, {"probability", 0.99}, {"confidence", 0.9}}});
  const auto pairs = strongest_pairs(*made(campaign), 8);
  CHECK(pairs[0].output == weakest);
  CHECK(strongest_pairs(*made(quick_campaign(3)), 8).empty());
  CHECK(correlations_json(*made(quick_campaign(3)), {}).is_null());
}

TEST_CASE("a density counts row by row of y", "[page]") {
  const auto source = made(quick_campaign(50));
  const Json scatter = scatters_json(*source, {}, 2).front();
  const auto x = scatter["points"]["x"].get<std::vector<double>>();
  const auto y = scatter["points"]["y"].get<std::vector<double>>();
  const auto x_edges = scatter["x_edges"].get<std::vector<double>>();
  const auto y_edges = scatter["y_edges"].get<std::vector<double>>();
  const auto top = static_cast<std::size_t>(std::ranges::max_element(y) - y.begin());
  const auto column =
      static_cast<std::size_t>(std::ranges::upper_bound(x_edges, x[top]) - x_edges.begin() - 1);
  CHECK(y[top] == Approx(y_edges.back()).epsilon(1e-6));
  CHECK(scatter["density"][31 * 32 + std::min<std::size_t>(column, 31)] >= 1);
}

TEST_CASE("correlations of the page are the summary's", "[page]") {
  const auto source = made(quick_campaign(60));
  const Json json = correlations_json(*source, {});
  CHECK(json["draws"].size() == source->results.draws.size());
  CHECK(json["outputs"].size() == source->results.outputs.size());
  for (const auto& [draw, output, value] : source->summary.correlations) {
    if (output == "deployed") continue;
    const auto d =
        std::find(json["draws"].begin(), json["draws"].end(), Json(draw)) - json["draws"].begin();
    const auto o = std::find(json["outputs"].begin(), json["outputs"].end(), Json(output)) -
                   json["outputs"].begin();
    CHECK(json["spearman"][d][o] == page_number(value.spearman, 3));
    CHECK(json["pearson"][d][o] == page_number(value.pearson, 3));
  }
  CHECK(correlations_json(*made(quick_campaign(1)), {}).is_null());
}

TEST_CASE("effects come strongest first, and there are none of a single run", "[page]") {
  const auto source = made(quick_campaign(100));
  const Json json = effects_json(*source, {});
  CHECK(json["kind"] == "rank");
  CHECK(json["runs"] == 100);
  std::string output;
  double last = 0;
  for (const Json& effect : json["effects"]) {
    const auto size = [&](const char* key) {
      return effect[key].is_null() ? 0 : std::abs(effect[key].get<double>());
    };
    const double strength = std::max(size("spearman"), size("prcc"));
    if (effect["output"] == output) CHECK(strength <= last + 1e-4); // of four digits
    output = effect["output"];
    last = strength;
  }
  CHECK(effects_json(*made(quick_campaign(1)), {}).is_null());
}

TEST_CASE("an effect has the coefficients and bounds of the rank analysis, of its own draw",
          "[page]") {
  const auto source = made(quick_campaign(100));
  const Json json = effects_json(*source, {});
  const RankSensitivity all =
      rank_sensitivity(source->results, source->confidence, {source->replication, {}});
  CHECK(json["confidence"] == source->confidence);
  CHECK(json["idle"] == Json(all.idle));
  REQUIRE(json["effects"].size() >= 8);
  for (const Json& effect : json["effects"]) {
    const auto output =
        std::ranges::find(all.outputs, effect["output"].get<std::string>(), &OutputRanks::output);
    const auto draw = std::ranges::find(all.dispersions, effect["draw"].get<std::string>());
    REQUIRE((output != all.outputs.end() && draw != all.dispersions.end()));
    const RankEffect& wanted =
        output->effects[static_cast<std::size_t>(draw - all.dispersions.begin())];
    for (const auto& [name, of] :
         {std::pair(std::string("spearman"), wanted.spearman), {"prcc", wanted.partial}}) {
      CAPTURE(name, effect.dump());
      CHECK(effect.at(name) == page_number(of.value, 4));
      CHECK(effect.at(name + "_lower") == page_number(of.bounds.lower));
      CHECK(effect.at(name + "_upper") == page_number(of.bounds.upper));
    }
  }
}

namespace {

/// Numbers that have so many significant digits, no more, and not all of them fewer.
void check_digits_of_all(const std::vector<double>& numbers, int digits) {
  CAPTURE(digits, numbers.size());
  for (const double number : numbers) CHECK(number == rounded(number, digits));
  CHECK(std::ranges::any_of(numbers,
                            [&](double number) { return number != rounded(number, digits - 1); }));
}

/// The numbers under one of these keys, at any depth.
std::vector<double> numbers_under(const Json& json, const std::vector<std::string>& keys) {
  std::vector<double> numbers;
  const auto take = [&](const auto& self, const Json& part, bool wanted) -> void {
    if (part.is_number() && wanted) numbers.push_back(part.get<double>());
    if (part.is_array())
      for (const Json& each : part) self(self, each, wanted);
    if (part.is_object())
      for (const auto& [key, value] : part.items())
        self(self, value, std::ranges::find(keys, key) != keys.end());
  };
  take(take, json, false);
  return numbers;
}

} // namespace

TEST_CASE("coefficients have three or four digits on the page, points six and bounds seven",
          "[page]") {
  const auto source = made(quick_campaign(100));
  const Json effects = effects_json(*source, {}), scatters = scatters_json(*source, {}, 1);
  check_digits_of_all(numbers_under(effects, {"spearman", "prcc"}), 4);
  check_digits_of_all(
      numbers_under(effects, {"spearman_lower", "spearman_upper", "prcc_lower", "prcc_upper"}), 7);
  check_digits_of_all(numbers_under(scatters, {"spearman"}), 4);
  check_digits_of_all(numbers_under(scatters, {"x"}), 6);
  check_digits_of_all(numbers_under(scatters, {"y"}), 6);
  check_digits_of_all(numbers_under(scatters, {"x_edges", "y_edges"}), 7);
  check_digits_of_all(numbers_under(correlations_json(*source, {}), {"spearman", "pearson"}), 3);
}

namespace {

/// A set of invented runs whose deployment time is 9 + slope × (the root spring's factor − 1), limited.
std::unique_ptr<PageSource> slow_set(double limit, int runs = 1000, const char* design = "random",
                                     double spread = 0.05, double slope = -4) {
  Json json = quick_campaign(runs);
  json["sampling"]["design"] = design;
  if (runs > 10'000) json["statistics"]["accuracy_runs"] = 0;
  json["requirements"] =
      parse_json(R"([ { "output": "deployment_time", "probability": 0.99, "confidence": 0.9 } ])");
  json["requirements"][0]["max"] = limit;
  if (design != std::string("random")) json.erase("requirements"); // of independent draws alone
  const Campaign campaign = campaign_of(json);
  const ResultNames names = RunPlan(campaign).names();
  const auto column = std::ranges::find(names.outputs, "deployment_time") - names.outputs.begin();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Results results(names);
  for (long run = 0; run < runs; ++run) {
    std::vector<double> draws{1 + spread * normal(random)};
    for (int panel = 0; panel < 3; ++panel) draws.push_back(9 + 2 * uniform(random));
    std::vector<double> outputs(names.outputs.size(), 1.0);
    outputs[static_cast<std::size_t>(column)] = 9 + slope * (draws[0] - 1);
    results.append({run, Status::deployed, draws, outputs, "root>mid>tip", ""});
  }
  return source_of(campaign, std::move(results));
}

} // namespace

TEST_CASE(
    "the page's change of a failed requirement is the known one, with the command that confirms it",
    "[page][needed]") {
  const auto source = slow_set(9.37);
  const Verdict& verdict = source->summary.requirements.front();
  const Json blocks = changes_json(*source, verdict);
  REQUIRE(blocks.size() == 1);
  CHECK(blocks[0]["for"] == "limit");
  CHECK(blocks[0]["explained"] == 1.0);
  REQUIRE(blocks[0]["levers"].size() == 1); // the masses have no effect
  const Json& lever = blocks[0]["levers"][0];
  CHECK(lever["words"] == "root spring");
  // 13 − 4 f x ≤ limit from f = (13 − limit)/4/x on: in all runs but one when a new campaign is to pass surely
  std::vector<double> factors;
  for (const double x : source->results.draws[0].values)
    factors.push_back((13 - verdict.requirement.max.value()) / 4 / x);
  std::ranges::sort(factors, std::ranges::greater{});
  // P(≤ m | k) = I_½(k + 1, m + 1), at m = 5: 0.984 for k = 0 and 0.9375 for k = 1
  REQUIRE(verdict.allowed == 5);
  CHECK(lever["known"] == true);
  CHECK(lever["change"].get<double>() == Approx(factors[0]).epsilon(1e-6));
  CHECK(lever["upper"] == lever["change"]);
  CHECK(lever["beyond_runs"].get<long>() >= 10);
  CHECK(lever["beyond_undeployed"] == 0);
  CHECK(blocks[0]["needs"] ==
        Json::array({{{"draws", lever["draws"]}, {"change", lever["change"]}}}));
  const double t = factors[0] - 1;
  CHECK(lever["command"] ==
        "wingspread margin results/set/campaign.json --scale hinges.root.spring.torque_stowed "
        "hinges.root.spring.torque_latched --range " +
            fmt::format("{:.3g} {:.3g}", 1 - t / 2, 1 + 2 * t) + " --out results/margin");
  const auto fine =
      slow_set(9.0074, 1000, "random", 0.001); // the range of a small change is no single value
  const Json small = changes_json(*fine, fine->summary.requirements.front())[0]["levers"][0];
  CHECK(small["change"].get<double>() == Approx(1.001).margin(0.001));
  CHECK(small["command"].get<std::string>().find("--range 0.998 1.01 ") != std::string::npos);
  Verdict passed = verdict;
  passed.decision = Decision::pass;
  CHECK(changes_json(*source, passed).empty());

  // at 9.2 s as many runs would have to start beyond the slowest draws: not known, and no other case may rely on it
  const auto far = slow_set(9.2);
  const Json unknown = changes_json(*far, far->summary.requirements.front())[0];
  REQUIRE(unknown["levers"].size() == 1);
  CHECK(unknown["levers"][0]["known"] == false);
  CHECK(unknown["levers"][0]["upper"].is_null());
  CHECK(unknown["levers"][0]["lower"].get<double>() > 1);
  CHECK(unknown["needs"][0]["change"].is_null());
}

TEST_CASE("a value that has to fall is looked for below the present one", "[page][needed]") {
  const auto source = slow_set(9.37, 1000, "random", 0.05, 4);
  const Json lever = changes_json(*source, source->summary.requirements.front())[0]["levers"][0];
  // 5 + 4 f x ≤ 9.37 in all runs, of which the largest draw asks for the least f
  const auto& draws = source->results.draws[0].values;
  double largest = 0;
  for (const double x : draws) largest = std::max(largest, x);
  CHECK(lever["change"].get<double>() == Approx(4.37 / 4 / largest).epsilon(1e-6));
  const double t = lever["change"].get<double>() - 1;
  CHECK_THAT(lever["command"].get<std::string>(),
             Catch::Contains(fmt::format(" --range {:.3g} {:.3g} ", 1 + 2 * t, 1 - t / 2)));
}

TEST_CASE("effects of independent draws are those of the first 10000 runs, of a design of all",
          "[page]") {
  const auto source = slow_set(9, 10'003);
  const RunsMade made{source->replication, {}};
  Results first(RunPlan(source->stored.campaign).names());
  for (std::size_t row = 0; row < most_effect_runs; ++row) first.append(source->results.row(row));
  const RankSensitivity wanted = rank_sensitivity(first, source->confidence, made);
  const Json json = effects_json(*source, {});
  CHECK(json["runs"] == most_effect_runs);
  const Json& effect = json["effects"].at(0);
  CHECK(effect["draw"] == "root_spring");
  const auto output =
      std::ranges::find(wanted.outputs, effect["output"].get<std::string>(), &OutputRanks::output);
  REQUIRE(output != wanted.outputs.end());
  CHECK(effect["prcc_lower"] == page_number(output->effects[0].partial.bounds.lower));
  const auto net = slow_set(0, 10'003, "sobol"); // in one replicate
  CHECK(effects_json(*net, {})["runs"] == 10'003);
}

TEST_CASE("a block of changes has the numbers of the analysis, each under its key",
          "[page][needed]") {
  const auto source = slow_set(9.37);
  const Verdict& verdict = source->summary.requirements.front();
  const auto found = lever_changes(NeededFor::limit, source->stored.campaign, verdict,
                                   source->results, source->replication, source->confidence, 24);
  REQUIRE((found && !found->levers.empty()));
  const auto& [lever, change] = found->levers.front();
  const Json block = changes_json(*source, verdict).at(0);
  CHECK(block["runs"] == found->runs);
  const Json& json = block["levers"].at(0);
  CHECK((json["draws"] == Json(lever.draws) && json["unit"] == lever.unit));
  CHECK(json["scaled"] == lever.moved.scaled);
  for (const auto& [key, wanted] : {std::pair("now", change.now),
                                    {"change", change.change},
                                    {"least", change.least},
                                    {"most", change.most},
                                    {"of_broken", change.of_broken},
                                    {"of_others", change.of_others}}) {
    CAPTURE(key);
    CHECK(json.at(key) == page_number(wanted));
  }
  CHECK((json["beyond_runs"] == change.beyond_runs && json["known"] == change.known));
  CHECK(json["beyond_undeployed"] == change.beyond_undeployed);
  CHECK(json.at("lower") == page_number(change.bounds.lower));
  CHECK(json.at("upper") == page_number(change.bounds.upper));
}

TEST_CASE("a requirement that a single run fails has a block too, and one that none fails has none",
          "[page][needed]") {
  const auto times = [](const PageSource& source) {
    const auto at = std::ranges::find(source.results.outputs, "deployment_time", &Column::name);
    std::vector<double> sorted(at->values.begin(), at->values.end());
    std::ranges::sort(sorted, std::ranges::greater{});
    return sorted;
  };
  const std::vector<double> sorted = times(*slow_set(9));
  for (const long late : {0, 1, 2}) {
    const auto k = static_cast<std::size_t>(late);
    const auto source = slow_set(k == 0 ? sorted[0] + 0.01 : (sorted[k - 1] + sorted[k]) / 2);
    Verdict verdict = source->summary.requirements.front();
    verdict.allowed = 0, verdict.decision = Decision::fail; // as if none might
    CHECK(verdict.failures() == late);
    const Json blocks = changes_json(*source, verdict);
    REQUIRE(blocks.size() == (late > 0 ? 1 : 0));
    if (late > 0) CHECK(blocks[0]["for"] == "limit");
  }
}

TEST_CASE("the page has the latches whose damping makes most of the nominal peak", "[page]") {
  const auto source = made(quick_campaign(20));
  source->summary.latch_jumps = {{"root", 200, 350}};
  CHECK(set_json(*source, {}, 1)["latch_jumps"] ==
        Json::array({{{"hinge", "root"}, {"moment", 200.0}, {"peak", 350.0}}}));
}

TEST_CASE("a load without a requirement that is larger than all judged ones is told", "[page]") {
  Json json = full_campaign(60);
  json["integration"]["t_end"] = 20;
  const auto source = made(json);
  const auto largest = [&](const std::string& name) {
    const auto at = std::ranges::find(source->summary.outputs, name, &OutputSummary::name);
    return std::max(std::abs(at->moments.min), std::abs(at->moments.max));
  };
  std::vector<std::string> moments{"root.peak_moment", "mid.peak_moment", "tip.peak_moment"};
  std::ranges::sort(moments, {}, largest);
  CHECK(unjudged_json(*source).empty()); // nothing is judged
  for (const auto& [judged, told] : {std::pair(1, true), std::pair(2, false)}) {
    json["requirements"] = Json::array(
        {{{"output", moments[judged]}, {"max", 1e9}, {"probability", 0.9}, {"confidence", 0.9}}});
    const auto required = made(json);
    const Json unjudged = unjudged_json(*required);
    REQUIRE(unjudged.size() == (told ? 1 : 0));
    if (!told) continue;
    CHECK(unjudged[0]["output"] == moments[2]);
    CHECK(unjudged[0]["judged"] == moments[1]);
    CHECK(unjudged[0]["largest"] == page_number(largest(moments[2])));
    CHECK(unjudged[0]["judged_largest"] == page_number(largest(moments[1])));
  }
}
