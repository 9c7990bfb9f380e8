#include "montecarlo/analyses/margin/margin_findings.hpp"
#include "montecarlo/analyses/margin/margin_study.hpp"
#include "montecarlo/analyses/margin/scaled_springs.hpp"
#include "montecarlo/engine/runs/static_margin_draws.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/summary/judge_campaign.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace wingspread;
using namespace wingspread::test;

namespace {

long broken(const MarginSearch& search, double scale, std::size_t requirement,
            std::size_t which = 0) {
  return std::ssize(search.seen.at(scale)[which].verdicts[requirement].broken);
}

} // namespace

TEST_CASE("the window is where the closed form has it, count by count", "[margin][parallel]") {
  const Campaign campaign = campaign_of(one_panel_margin(600));
  const MarginResult result = margin_of(campaign);
  REQUIRE(result.searches.size() == 1);
  const MarginSearch& search = result.searches.front();
  for (const auto& [scale, cases] : search.seen) {
    const ClosedForm exact = closed_form(campaign, scale);
    CAPTURE(scale);
    CHECK(broken(search, scale, 0) == exact.not_deployed);
    CHECK(broken(search, scale, 1) == exact.too_fast);
  }
  const long allowed = *allowed_failures(600, 0.97, 0.9); // of either requirement
  const auto meets = [&](double scale) {
    const ClosedForm exact = closed_form(campaign, scale);
    return exact.not_deployed <= allowed && exact.too_fast <= allowed;
  };
  const FailingByScale by_scale = failing_by_scale(search);
  const Window window = only_window(windows_of(by_scale));
  CHECK((meets(window.lower) && !meets(*window.below)));
  CHECK((meets(window.upper) && !meets(*window.above)));
  CHECK(window.lower / *window.below <= 1.01);
  CHECK(*window.above / window.upper <= 1.01);
  CHECK(by_scale.at(*window.below).contains(0)); // the one does not deploy
  CHECK(by_scale.at(*window.above) == Failing{1});
  CHECK(window.upper / window.lower > 1.1);
  CHECK(meets(*search.recommended));
  CHECK(is_confirmed(search));
  CHECK(result.runs == 600 * (std::ssize(search.seen) + 1));
  CHECK(result.failed == 0);
  // every draw has one scale from which on it deploys, and one from which on it is too fast
  for (const MarginCondition& condition : conditions_of(campaign, result)) {
    CHECK(out_of_order(search, condition, *search.recommended).lower == 0);
    CHECK(out_of_order(search, condition, *search.recommended).upper == 0);
  }
}

// A narrow window: at its middle about 2 % of the draws do not deploy, and as many are too fast.
TEST_CASE("the confirmation is by other draws, of a seed that nobody takes next", "[margin]") {
  Json json = one_panel_margin(300);
  for (Json& torque : json["scene"]["hinges"][0]["spring"]) torque = 0.75 * torque.get<double>();
  for (Json& requirement : json["requirements"]) requirement["probability"] = 0.9;
  json["requirements"][1]["min"] = -0.5;
  const MarginResult result = margin_of(campaign_of(json));
  const MarginSearch& search = result.searches.front();
  REQUIRE(search.recommended);
  const auto broken = [&](std::uint64_t seed, std::size_t k) {
    json["sampling"]["seed"] = seed;
    const Campaign sized = scaled(campaign_of(json), search.scaled, *search.recommended);
    return judge(sized.requirements[k], rows_of(RunPlan(sized), {0, 300})).broken;
  };
  for (std::size_t k = 0; k < 2; ++k) {
    const Spilled<long>& confirmed = search.confirmation->front().verdicts[k].broken;
    CHECK(confirmed.size() >= 2);
    CHECK(confirmed == broken(result.confirmation_seed, k));
    for (const std::uint64_t next : {3, 4, 5}) CHECK_FALSE(confirmed == broken(next, k));
  }
}

TEST_CASE("seeds of confirmation are their campaign's own, and far from its neighbours",
          "[margin]") {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    seeds.insert(confirmation_seed(seed));
    CHECK(confirmation_seed(seed) > 1'000'000); // by chance below it once in 10¹³
  }
  CHECK(seeds.size() == 1000);
  CHECK(confirmation_seed(3) == confirmation_seed(3));
}

TEST_CASE("a campaign at the edges, run for itself, agrees on either side", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(400));
  const MarginSearch search = margin_of(campaign).searches.front();
  const Window window = only_window(windows_of(failing_by_scale(search)));
  for (const auto& [scale, passes] :
       {std::pair{window.lower, true}, std::pair{*window.below, false},
        std::pair{window.upper, true}, std::pair{*window.above, false}}) {
    const Folder folder;
    // read back from its own file, with all of the outputs that the margin had no need of
    const Campaign sized =
        read_campaign(scaled(campaign, search.scaled, scale).resolved.dump(), "");
    CHECK(run_into(folder.path() / "r", sized) == 400);
    const Json summary = parse_json_file(folder.path() / "r" / summary_file);
    bool all = true;
    for (std::size_t k = 0; k < 2; ++k) {
      const Json& verdict = summary["requirements"][k];
      all = all && verdict["verdict"] == "pass";
      CHECK(verdict["broken"] == Json(search.seen.at(scale)[0].verdicts[k].broken));
    }
    CHECK(all == passes);
  }
}

TEST_CASE("hinge by hinge, each has a window of its own", "[margin]") {
  Json json = quick_campaign(60);
  json["requirements"] = parse_json(R"([
    { "output": "root.latch_time", "max": 5.2, "probability": 0.9, "confidence": 0.9 } ])");
  json["margin"] = parse_json(R"({
    "scale": ["hinges.tip.spring.torque_stowed", "hinges.*.spring.torque_latched",
              "hinges.root.spring.torque_stowed"],
    "range": [0.5, 1.5], "points": 5, "mode": "each" })");
  const Campaign campaign = campaign_of(json);
  const MarginResult result = margin_of(campaign);
  REQUIRE(result.searches.size() == 3);
  CHECK(result.searches[0].name == "tip"); // in the order of their first mention
  CHECK(result.searches[1].name == "root");
  CHECK(result.searches[2].name == "mid");
  CHECK(result.searches[0].scaled.size() == 2);
  CHECK(result.searches[2].scaled.size() == 1);
  for (const MarginSearch& search : result.searches) CHECK(search.of_springs);
  // the same at 1, where nothing is scaled, and not elsewhere
  const auto guaranteed = [&](std::size_t k, double scale) {
    return result.searches[k].seen.at(scale)[0].verdicts[0].guaranteed;
  };
  CHECK(guaranteed(0, 1) == guaranteed(1, 1));
  CHECK(guaranteed(0, 1.5) != guaranteed(1, 1.5));
  CHECK(guaranteed(1, 1.5) < guaranteed(1, 1)); // a stronger root is sooner there
}

TEST_CASE("a search knows whether it scales springs", "[margin]") {
  Json json = quick_campaign(10);
  json["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.5, "confidence": 0.5 }])");
  const auto of_springs = [&](const Json& paths) {
    json["margin"] = {{"scale", paths}, {"range", {0.9, 1.1}}, {"points", 3}};
    return margin_of(campaign_of(json)).searches.front().of_springs;
  };
  CHECK(of_springs({"hinges.*.spring.scale"}));
  CHECK(of_springs({"hinges.root.friction.scale", "hinges.tip.spring.torque_latched"}));
  CHECK_FALSE(of_springs({"hinges.*.friction.scale"}));
  CHECK_FALSE(of_springs({"bodies.*.mass"}));
}

TEST_CASE("a campaign without a margin, requirements or runs enough is refused, all at once",
          "[margin]") {
  Json json = one_panel_margin(70);
  json.erase("margin");
  json["requirements"][1]["probability"] = 0.999;
  const auto refusal = [](const Json& campaign) {
    return message_of([&] { return margin_of(campaign_of(campaign)).runs; });
  };
  CHECK_THAT(refusal(json),
             Catch::Contains("/margin: found nothing") &&
                 Catch::Contains("/sampling/runs: found 70, expected at least 76") &&
                 Catch::Contains("/sampling/runs: found 70, expected at least 2302") &&
                 Catch::Contains("root.latch_rate ≥ -0.8 rad/s, 99.9 % at 90 %"));
  json = one_panel_margin(100);
  json.erase("requirements");
  CHECK_THAT(refusal(json), Catch::Contains("/requirements: found none, expected at least one"));
}

TEST_CASE("its progress never runs backwards nor beyond the end, and ends there", "[margin]") {
  Json json = one_panel_margin(100);
  json["cases"] = parse_json(R"([
    { "name": "ambient", "scale": { "hinges.root.latch.stiffness": 1 } },
    { "name": "cold", "scale": { "hinges.root.friction.coulomb": 1.02,
                                 "hinges.root.friction.static": 1.02 } } ])");
  const Campaign campaign = campaign_of(json);
  MarginResult result;
  ThreadEvaluator evaluator({.threads = 1}, never);
  StudyProgress last;
  double share = 0;
  bool falls = true;
  find_margin(
      campaign, evaluator,
      [&](const StudyProgress& now) {
        falls = falls && (last.analysis == 0 || now.most_analyses <= last.most_analyses);
        CHECK(now.runs <= now.most_runs);
        CHECK(now.analysis <= now.most_analyses);
        CHECK(now.most_runs == now.most_analyses * 2 * 100);
        const double its = static_cast<double>(now.runs) / static_cast<double>(now.most_runs);
        CHECK(its >= share);
        share = its;
        last = now;
      },
      result);
  CHECK(falls);
  CHECK(share == 1);
  CHECK(last.runs == result.runs);
  CHECK(last.analysis == std::ssize(result.searches[0].seen) + 1); // and the confirmation
}

TEST_CASE("the first scales in shards are those that the study runs first, run for run",
          "[margin]") {
  struct Spy final : Evaluator {
    std::map<std::string, std::vector<ResultRow>> of_scale; // by the scale and the case
    ThreadEvaluator threads{{.threads = 1}, never};
    long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override {
      const auto keep = [&](const Batch& batch) {
        auto& rows = of_scale[plan.campaign().resolved.dump()];
        rows.insert(rows.end(), batch.rows.begin(), batch.rows.end());
        sink.take(batch);
      };
      return threads.make(plan, range, {keep});
    }
    [[nodiscard]] const Occupancy& occupancy() const override { return threads.occupancy(); }
  } whole, parts;
  const Campaign campaign = campaign_of(one_panel_margin(100));
  MarginResult result;
  find_margin(
      campaign, whole, [](const StudyProgress&) {}, result);
  long runs = 0;
  for (long i = 1; i <= 3; ++i)
    runs += run_first_scales(campaign, {i, 3}, parts, [&](const StudyProgress& now) {
      CHECK(now.most_analyses == 13);
      CHECK(now.analysis <= 13);
    });
  CHECK(runs == 13 * 100); // the scales of the grid, among them 1
  CHECK(parts.of_scale.size() == 13);
  for (const auto& [scale, rows] : parts.of_scale) {
    REQUIRE(whole.of_scale.contains(scale));
    const auto& theirs = whole.of_scale[scale];
    REQUIRE(rows.size() == theirs.size());
    const auto text = [](const std::vector<ResultRow>& all) {
      std::string lines;
      for (const ResultRow& row : all) append_row(lines, row);
      return lines;
    };
    CHECK(text(rows) == text(theirs));
  }
}

TEST_CASE("an interruption ends it, and keeps the scales that were finished", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(200));
  std::atomic<bool> stop = false;
  MarginResult result;
  ThreadEvaluator evaluator({.threads = 1}, stop);
  const auto watch = [&](const StudyProgress& so_far) { stop = so_far.runs >= 500; };
  CHECK_THROWS_AS(find_margin(campaign, evaluator, watch, result), Stopped);
  const MarginSearch& search = result.searches.front();
  CHECK(search.seen.size() == 2);
  CHECK(search.seen.contains(0.5));
  CHECK_FALSE(search.recommended);
}

namespace {

/// A wing that deploys by its momentum where it has hardly any torque left at rest: the spring's last torque, 0.09 N·m,
/// against a friction of 0.1. It deploys down to some 0.1 of its springs, and strikes too hard a little above 1: the range
/// down to 0.5 has no lower edge.
Json driven_by_momentum() {
  Json json = one_panel_margin(400);
  Json& root = json["scene"]["hinges"][0];
  root["spring"] = {{"torque_stowed", 2.0}, {"torque_latched", 0.09}};
  root["friction"] = {{"model", "exact"}, {"coulomb", 0.1}, {"static", 0.1}};
  json["dispersions"][1]["distribution"]["std"] = 0.005;
  json["requirements"][1]["min"] = -1.15;
  return json;
}

} // namespace

// The campaign of a range without a lower edge: once the mean of 0.5 and the upper edge was recommended, weaker springs.
TEST_CASE("where the lower edge lies outside of the range no weaker springs are advised",
          "[margin]") {
  const MarginResult result = margin_of(campaign_of(driven_by_momentum()));
  const MarginSearch& search = result.searches.front();
  const Window window = only_window(windows_of(failing_by_scale(search)));
  CHECK(failing(search.seen.at(0.5)).empty());
  CHECK((window.lower < 0.5 && window.below && window.above)); // found beyond it
  CHECK((window.upper > 1 && window.upper < 1.5));
  REQUIRE(search.recommended);
  CHECK(*search.recommended >= 1);
  const StaticMarginStudy present = study_static_margins(result.campaigns[0]);
  CHECK(present.drives[0].worst[0] < 0); // why: it is short of torque at rest as it is
  CHECK(present.drives[0].worst[1] < 0);
}

TEST_CASE("where no edge is found as far as the search may go, nothing is recommended",
          "[margin]") {
  Json json = driven_by_momentum();
  json["margin"]["widest"] = {0.5, 16};
  const MarginSearch search = margin_of(campaign_of(json)).searches.front();
  CHECK_FALSE(search.recommended);
  CHECK_FALSE(search.confirmation);
  CHECK(search.withheld == Withheld::no_lower_edge);
  CHECK(search.seen.begin()->first == 0.5);
}

// With the requirements' peaks alone, and with all that a run records: forces of a latch without damping are never proven.
TEST_CASE("margin and run judge the same draws alike, whatever else a run records", "[margin]") {
  for (const double t_end : {2.3, 15.0}) {
    const Campaign campaign = campaign_of(ringing_panel(100, t_end, 0));
    const RunPlan plan(campaign);
    const Results rows = rows_of(plan, {0, 100});
    const bool is_cut = t_end < 3;
    CAPTURE(t_end);
    CHECK(count_cut(rows, "root.peak_force") == 100);
    CHECK(count_cut(rows, "root.peak_moment") == (is_cut ? 100 : 0));
    const Verdict by_run = judge_campaign(campaign, rows).front();
    const MarginResult result = margin_of(campaign);
    const Verdict& by_margin = result.searches.front().seen.at(1)[0].verdicts[0];
    CHECK(by_run.decision == (is_cut ? Decision::undecided : Decision::pass));
    CHECK(by_margin.decision == by_run.decision);
    CHECK((by_margin.cut == by_run.cut && by_margin.open == by_run.open));
    CHECK(by_margin.failures() == by_run.failures());
    CHECK((!by_margin.disproved && !by_run.disproved));
    const std::vector<CutPeaks> cut = cut_peaks(result, result.searches.front());
    CHECK(cut.empty() == !is_cut);
    if (is_cut) CHECK((cut[0].cut == 100 && cut[0].scale == 1));
    const std::string warning = "at scale 1 t_end cut the peak in 100 of 100 runs";
    const auto lines = margin_warnings(result);
    CHECK(std::ranges::any_of(lines, [&](const std::string& line) {
            return line.find(warning) != std::string::npos;
          }) == is_cut);
  }
}

TEST_CASE("the quantile of a requirement on |x| is that of the absolute values", "[margin]") {
  Json json = one_panel_margin(200);
  json["requirements"][1] = {{"output", "root.latch_rate"},
                             {"abs", true},
                             {"max", 0.8},
                             {"probability", 0.95},
                             {"confidence", 0.5}};
  json["requirements"].push_back({{"output", "root.latch_rate"}, // of a lower limit that from below
                                  {"abs", true},
                                  {"min", 0.01},
                                  {"probability", 0.95},
                                  {"confidence", 0.5}});
  const Campaign campaign = campaign_of(json);
  const MarginResult result = margin_of(campaign);
  const Results rows = rows_of(RunPlan(campaign), {0, 200});
  std::vector<double> sizes;
  for (const double value :
       std::ranges::find(rows.outputs, "root.latch_rate", &Column::name)->values)
    if (!std::isnan(value)) sizes.push_back(std::abs(value));
  std::ranges::sort(sizes);
  const auto rank = std::ceil(0.95 * static_cast<double>(sizes.size()) - 1e-9);
  const CaseResult& present = result.searches.front().seen.at(1).front();
  CHECK(present.quantiles[1] == Approx(sizes[static_cast<std::size_t>(rank) - 1]).epsilon(1e-6));
  // counted from the largest, as the verdict's observed value is
  CHECK(present.quantiles.back() ==
        Approx(sizes[sizes.size() - static_cast<std::size_t>(rank)]).epsilon(1e-6));
}

TEST_CASE("members of a group take the runs that their share of the risk takes", "[margin]") {
  for (int members = 1; members <= 4; ++members)
    for (const double probability : {0.9, 0.97}) {
      const double risk = 0.1 / members;
      const int least = static_cast<int>(std::ceil(std::log(risk) / std::log(probability)));
      Json json = one_panel_margin(least - 1);
      json["requirements"] = Json::array();
      for (int k = 0; k < members; ++k)
        json["requirements"].push_back({{"output", "root.latch_rate"},
                                        {"min", -0.8 - 0.1 * k},
                                        {"name", "R-" + std::to_string(k)},
                                        {"group", "rates"},
                                        {"probability", probability},
                                        {"confidence", 0.9}});
      CAPTURE(members, probability);
      CHECK_THAT(message_of([&] { return margin_of(campaign_of(json)).runs; }),
                 Catch::Contains("/sampling/runs") &&
                     Catch::Contains("at least " + std::to_string(least) + ":"));
    }
}
