#include "montecarlo/analyses/margin/margin_findings.hpp"
#include "montecarlo/engine/runs/finality.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr long runs_of_case = 100;

/// A verdict of which so many runs break the requirement, and 5 may.
Verdict verdict(const char* output, long broken) {
  Verdict made;
  made.requirement.output = output;
  made.runs = runs_of_case;
  made.allowed = 5;
  made.decision = broken <= 5 ? Decision::pass : Decision::fail;
  for (long run = 0; run < broken; ++run) made.broken.push_back(run);
  return made;
}

/// A case in which so many runs did not deploy.
CaseResult case_of(long stalled, std::vector<Verdict> verdicts) {
  CaseResult one;
  one.statuses[static_cast<std::size_t>(Status::deployed)] = runs_of_case - stalled;
  one.statuses[static_cast<std::size_t>(Status::stalled)] = stalled;
  one.verdicts = std::move(verdicts);
  return one;
}

/// Of the two requirements of one_panel_margin: stalled runs break both.
ScaleResult scale_with(long stalled, long too_fast) {
  return {case_of(stalled,
                  {verdict("deployed", stalled), verdict("root.latch_rate", stalled + too_fast)})};
}

} // namespace

TEST_CASE("what fails by runs alone that did not deploy is said once", "[margin]") {
  CHECK(to_report(scale_with(8, 0)) == Failing{0});
  CHECK(to_report(scale_with(8, 1)) == Failing{0, 1});
  CHECK(to_report(scale_with(0, 8)) == Failing{1});
  CHECK(to_report(scale_with(3, 2)).empty());
  // Where "deployed" is not required, the first that fails for want of it stands for the others; and
  // in each case by itself.
  const CaseResult unasked =
      case_of(8, {verdict("root.latch_rate", 8), verdict("tip.latch_rate", 8)});
  CHECK(to_report({unasked, unasked}) == Failing{0, 2});
  // Where it is, it stands for them wherever it is named.
  CHECK(to_report({case_of(8, {verdict("root.latch_rate", 8), verdict("deployed", 8)})}) ==
        Failing{1});
}

TEST_CASE("an edge says what sets it, and what fails there by the same runs", "[margin]") {
  MarginSearch search;
  search.seen = {{0.5, scale_with(9, 0)},
                 {0.8, scale_with(0, 0)},
                 {1.2, scale_with(1, 3)},
                 {1.5, scale_with(0, 7)}};
  const auto windows = windows_of(failing_by_scale(search));
  REQUIRE(windows.size() == 1);
  const MarginEdge lower = lower_edge(search, windows.front());
  CHECK((lower.passing == 0.8 && lower.failing == 0.5));
  CHECK(lower.set_by == std::vector<std::size_t>{0});
  CHECK(lower.as_well == std::vector<std::size_t>{1});
  const MarginEdge upper = upper_edge(search, windows.front());
  CHECK((upper.passing == 1.2 && upper.failing == 1.5));
  CHECK(upper.set_by == std::vector<std::size_t>{1});
  CHECK(upper.as_well.empty());
  search.seen.erase(1.5);
  const auto open = windows_of(failing_by_scale(search));
  const MarginEdge end = upper_edge(search, open.front());
  CHECK((end.passing == 1.2 && !end.failing && end.set_by.empty()));
}

TEST_CASE("the widest gap of a window is between two of its own scales", "[margin]") {
  MarginSearch search;
  search.seen = {{0.2, scale_with(9, 0)}, {0.8, scale_with(0, 0)}, {0.9, scale_with(0, 0)},
                 {1.2, scale_with(1, 3)}, {1.5, scale_with(1, 3)}, {4, scale_with(0, 7)}};
  const auto windows = windows_of(failing_by_scale(search));
  REQUIRE(windows.size() == 1);
  const auto [lower, upper] = widest_gap(search, windows.front()); // 1.2/0.9 > 1.5/1.2
  CHECK((lower == 0.9 && upper == 1.2));
  const auto none = widest_gap(search, {0.9, 0.9, 0.8, 1.2});
  CHECK((none.lower == 0.9 && none.upper == 0.9));
}

TEST_CASE("each condition's edges have a word", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(100));
  MarginResult result;
  result.cases = {{"nominal", {}}};
  const auto kinds = [&](const std::map<double, ScaleResult>& seen) {
    MarginSearch search;
    search.seen = seen;
    std::vector<std::string_view> found_kinds;
    for (const ConditionFinding& found : condition_findings(campaign, result, search)) {
      found_kinds.push_back(found.kind);
      CHECK((found.which_case == "nominal" && !found.out_of_order));
    }
    return found_kinds;
  };
  using Words = std::vector<std::string_view>;
  const ScaleResult good = scale_with(0, 0), stalls = scale_with(9, 0), fast = scale_with(0, 9);
  CHECK(kinds({{1, good}, {2, good}}) == Words{"always", "always"});
  CHECK(kinds({{1, stalls}, {2, good}}) == Words{"lower", "lower"});
  CHECK(kinds({{1, good}, {2, fast}}) == Words{"always", "upper"});
  CHECK(kinds({{1, stalls}, {2, good}, {3, fast}}) == Words{"lower", "both"});
  CHECK(kinds({{1, fast}, {2, fast}}) == Words{"always", "never"});
  CHECK(kinds({{1, good}, {2, fast}, {3, good}}) == Words{"always", "several"});
}

// At 1 three runs are too fast and none at 0.8; there two stall, and none at 1.
TEST_CASE("what a recommended scale gives up is what is worse there than at present", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(100));
  MarginResult result;
  result.cases = {{"nominal", {}}};
  MarginSearch search;
  search.seen = {{0.8, scale_with(2, 0)}, {1, scale_with(0, 3)}};
  CHECK(concessions(campaign, result, search).empty());
  search.recommended = 0.8;
  const auto given_up = concessions(campaign, result, search);
  REQUIRE(given_up.size() == 1);
  CHECK(given_up[0].condition == 0); // the stalled; of the rates 2 are broken in place of 3
  CHECK((given_up[0].present->broken.empty() && given_up[0].recommended->broken.size() == 2));
  search.seen[1] = scale_with(2, 0); // as many, but nearer to the limit, which is one from below
  search.seen[1][0].quantiles = {std::numeric_limits<double>::quiet_NaN(), -0.5};
  search.seen[0.8][0].quantiles = {std::numeric_limits<double>::quiet_NaN(), -0.6};
  search.seen[0.8][0].verdicts[1].requirement.min = -0.8;
  const auto nearer = concessions(campaign, result, search);
  REQUIRE(nearer.size() == 1);
  CHECK(nearer[0].condition == 1);
  search.recommended = 1;
  CHECK(concessions(campaign, result, search).empty());
}

TEST_CASE("a warning of open latches, or of a cut peak, names the scale with most of them",
          "[margin]") {
  MarginResult result;
  result.cases = {{"nominal", {}}};
  MarginSearch& search = result.searches.emplace_back();
  search.seen = {{0.5, scale_with(0, 0)},
                 {0.8, scale_with(0, 0)},
                 {1.5, scale_with(0, 0)},
                 {4, scale_with(0, 0)}};
  result.campaigns.resize(1);
  CHECK(margin_warnings(result).empty());
  result.campaigns[0].scene.base.motion = BaseMotion::prescribed;
  CHECK_THAT(margin_warnings(result).at(0), Catch::Contains("the loads of the moving base"));
  CHECK(margin_warnings(result).size() == 1);
  result.campaigns[0].scene.base.motion = BaseMotion::fixed;
  for (const auto& [scale, open] : {std::pair{0.5, 2L}, {1.5, 7L}, {4.0, 3L}})
    search.seen[scale][0].open_latches = open;
  CHECK(margin_warnings(result) ==
        std::vector{"at scale 1.5 " + warn_of_open_latches(7, runs_of_case, "")});
  search.seen[1.5][0].open_latches = 1;
  CHECK(margin_warnings(result) ==
        std::vector{"at scale 4 " + warn_of_open_latches(3, runs_of_case, "")});

  // 9 runs break the second requirement and 5 may: cut peaks alone stand against it where 4 of them or more may rise
  const auto cut = [&](double scale, long runs) {
    Verdict& own = search.seen[scale][0].verdicts[1];
    own = verdict("root.latch_rate", 9);
    own.cut = own.open = runs;
  };
  const auto found = [&] {
    const std::vector<CutPeaks> all = cut_peaks(result, search);
    return all.empty() ? CutPeaks{0, "", "", 0, 0} : all.front();
  };
  CHECK(found().cut == 0);
  cut(0.5, 3); // 6 broken for sure
  CHECK(found().cut == 0);
  cut(0.5, 4);
  CHECK((found().scale == 0.5 && found().cut == 4 && found().runs == runs_of_case));
  cut(4, 4); // as many, but further from the present springs
  CHECK(found().scale == 0.5);
  cut(1.5, 4); // nearer
  CHECK(found().scale == 1.5);
  cut(0.8, 4);
  CHECK(found().scale == 0.8);
  cut(4, 5);
  CHECK((found().scale == 4 && found().cut == 5));
  for (const double scale : {0.5, 0.8, 1.5, 4.0}) cut(scale, 3);
  CHECK(found().cut == 0);
  search.recommended =
      1.5; // there and at the present springs a cut peak is told whatever it decides
  CHECK((found().scale == 1.5 && found().cut == 3));
  search.seen[1] = scale_with(0, 0);
  cut(1, 2);
  CHECK(found().scale == 1.5);
  search.recommended.reset();
  CHECK((found().scale == 1 && found().cut == 2));
  CHECK_THAT(margin_warnings(result).at(0), Catch::EndsWith("Lengthen t_end"));
  Base& base = result.campaigns[0].scene.base; // whose peaks no t_end proves final
  base.motion = BaseMotion::prescribed, base.angular_acceleration = 1e-4;
  CHECK_THAT(margin_warnings(result).at(1),
             Catch::EndsWith("No t_end will do with a base that turns faster and faster"));
}

TEST_CASE("why nothing is recommended is said, case by case", "[margin]") {
  const ScaleResult stalls{case_of(9, {verdict("deployed", 9), verdict("root.latch_rate", 2)})};
  MarginSearch search;
  search.seen = {{0.0625, scale_with(0, 0)}, {16, scale_with(0, 0)}};
  CHECK(why_withheld(search).empty());
  search.withheld = Withheld::no_window;
  CHECK(why_withheld(search) == "no scale that was run meets all requirements");
  CaseResult& cut = search.seen[16].front(); // as if t_end had cut all peaks
  Verdict& verdict = cut.verdicts.front();
  verdict.decision = Decision::undecided, verdict.not_listed = verdict.cut = verdict.open = 100;
  CHECK(why_withheld(search) == "no scale that was run meets all requirements; at some only "
                                "because t_end cut peaks");
  search.seen = {{1, stalls}, {1.36, stalls}, {1.45, scale_with(0, 9)}};
  CHECK_THAT(why_withheld(search), Catch::Contains("between 1.36 and 1.45"));
  search.seen = {{0.0625, scale_with(0, 0)}, {16, scale_with(0, 0)}};
  search.withheld = Withheld::no_lower_edge;
  CHECK(why_withheld(search) == "nothing fails down to 0.0625: no edge was found, and how far down "
                                "the springs may go is not known");
  search.withheld = Withheld::no_upper_edge;
  CHECK(why_withheld(search) == "nothing fails up to 16: no edge was found, for nothing that is "
                                "required limits the springs from above");
  search.withheld = Withheld::short_of_torque;
  search.passed_over = Shortfall{0.7, "root", MarginKind::nasa, -0.1, 0.25};
  CHECK(
      why_withheld(search) ==
      "only weaker springs meet all requirements, and their static margins fall short: NASA margin "
      "of root -0.10, now +0.25");
}

TEST_CASE("springs are recommended where they were sized together, and have a window", "[margin]") {
  Json json = one_panel_margin(100);
  MarginResult result;
  result.searches.emplace_back();
  CHECK(recommending(campaign_of(json), result) == nullptr);
  CHECK_FALSE(is_met(result));
  result.searches.front().recommended = 1.2;
  CHECK(recommending(campaign_of(json), result) == &result.searches.front());
  CHECK_FALSE(is_met(result)); // not confirmed
  result.searches.front().confirmation = scale_with(0, 0);
  CHECK(is_met(result));
  json["margin"]["mode"] = "each";
  CHECK(recommending(campaign_of(json), result) == nullptr);
}

// Two requirements at 98 % in two cases: four conditions, of which each has its risk at every edge.
TEST_CASE("all requirements, cases and edges together have the confidence that their risks leave",
          "[margin]") {
  Json json = one_panel_margin(100);
  for (Json& requirement : json["requirements"]) requirement["confidence"] = 0.98;
  const Campaign campaign = campaign_of(json);
  MarginResult result;
  result.cases = {{"nominal", {}}, {"root spring out", {}}};
  CHECK(confirmation_confidence(campaign, result) == Approx(0.92).epsilon(1e-12));
  CHECK(window_confidence(campaign, result, {0.8, 1.2, 0.7, 1.3}) == Approx(0.84).epsilon(1e-12));
  CHECK(window_confidence(campaign, result, {0.8, 1.2, 0.7, {}}) == Approx(0.92).epsilon(1e-12));
  CHECK(window_confidence(campaign, result, {0.8, 1.2, {}, {}}) == 1);
}
