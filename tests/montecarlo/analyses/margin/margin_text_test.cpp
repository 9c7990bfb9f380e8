// Every number that `margin` prints, against the result that it is given.
#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <fmt/format.h>

#include <numbers>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr long runs_of_window = 1000;

/// A verdict that these runs break; 12 may.
Verdict verdict_of_runs(const Requirement& requirement, std::vector<long> broken) {
  Verdict made;
  made.requirement = requirement;
  made.runs = runs_of_window;
  made.allowed = 12;
  made.decision = broken.size() <= 12 ? Decision::pass : Decision::fail;
  for (const long run : broken) made.broken.push_back(run);
  return made;
}

std::vector<long> runs_from(long first, long count) {
  std::vector<long> runs;
  for (long run = first; run < first + count; ++run) runs.push_back(run);
  return runs;
}

/// A window from 1 to 1.5. Below 1 the wing does not deploy, above 1.5 it latches too fast. Out of order are three
/// draws below 1, and nine from 1 upwards.
MarginResult made_up_window(const Campaign& campaign) {
  MarginResult result;
  result.campaigns = {campaign};
  result.cases = {{"nominal", {}}};
  result.runs = 6 * runs_of_window;
  result.confirmation_seed = 99;
  MarginSearch& search = result.searches.emplace_back();
  search.name = "joint", search.scaled = campaign.margin->scaled;
  search.recommended = 1, search.as_good = {1, 1};
  const auto add = [&](double scale, std::vector<long> stalled, std::vector<long> fast) {
    CaseResult one;
    one.statuses[static_cast<std::size_t>(Status::stalled)] = std::ssize(stalled);
    one.statuses[static_cast<std::size_t>(Status::deployed)] = runs_of_window - std::ssize(stalled);
    fast.insert(fast.end(), stalled.begin(), stalled.end());
    one.verdicts = {verdict_of_runs(campaign.requirements[0], stalled),
                    verdict_of_runs(campaign.requirements[1], fast)};
    one.quantiles = {std::nan(""), -0.5 * scale};
    search.seen[scale] = {one};
  };
  add(0.5, runs_from(0, 200), {});
  add(0.75, runs_from(0, 50), {});
  std::vector<long> mended = runs_from(0, 2); // and three draws that kept to it with weaker springs
  for (const long run : runs_from(900, 3)) mended.push_back(run);
  add(1, mended, {});
  add(1.5, {}, runs_from(500, 7)); // of which four keep to it with stronger springs
  add(1.75, {}, runs_from(504, 40));
  add(2, {}, runs_from(504, 400));
  return result;
}

/// The words of the lines that begin with this text, without it.
std::vector<std::string> words_after(const std::string& text, const std::string& label) {
  std::istringstream lines(text);
  std::vector<std::string> words;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(label)) continue;
    std::istringstream rest(line.substr(label.size()));
    for (std::string word; rest >> word;) words.push_back(word);
  }
  return words;
}

/// Whether the text has the words, wherever it breaks its lines.
bool prints(const std::string& text, const std::string& words) {
  std::string flat;
  std::istringstream in(text);
  for (std::string word; in >> word;) flat += word + ' ';
  return flat.find(words) != std::string::npos;
}

} // namespace

TEST_CASE("the text of a margin has the numbers of its window", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(runs_of_window));
  const MarginResult result = made_up_window(campaign);
  const MarginReport report{campaign, result, {}};
  const std::string text = margin_text(report);
  CAPTURE(text);
  CHECK(prints(text, "1000 runs per scale and case, 6000 in all"));
  CHECK(prints(text, "seed 3 "));
  CHECK(prints(text, "2 parameters together, searched from 0.5 to 2 "));
  // the edges, with the counts on both sides
  const auto found = condition_findings(campaign, result, result.searches[0]);
  REQUIRE(found.size() == 2);
  CHECK(words_after(text, "  weakest springs").front() == "1");
  CHECK(words_after(text, "  strongest springs").front() == "1.5");
  CHECK(prints(text, "at 1: pass: 5 of 1000 runs break it, 12 allowed"));
  CHECK(prints(text, "at 0.75: fail: 50 of 1000 runs break it, 12 allowed"));
  CHECK(prints(text, "at 1.5: pass: 7 of 1000 runs break it, 12 allowed"));
  CHECK(prints(text, "at 1.75: fail: 40 of 1000 runs break it, 12 allowed"));
  // each requirement: draws out of order at its own edge, and where it holds
  const auto rows = [&](std::size_t k) { return words_after(text, "  " + found[k].requirement); };
  CHECK(rows(0)[0] == "3");
  CHECK(rows(1)[0] == std::to_string(found[1].out_of_order->lower + found[1].out_of_order->upper));
  CHECK(found[1].kind == "both");
  CHECK(found[1].out_of_order->lower == 3);
  CHECK(found[1].out_of_order->upper == 4 + 5); // and those of scale 1, which keep to it at 1.75
  const Json json = margin_json(report, Json::object())["searches"][0]["requirements"];
  REQUIRE(json.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(json[k]["out_of_order"]["below"] == found[k].out_of_order->lower);
    CHECK(json[k]["out_of_order"]["above"] == found[k].out_of_order->upper);
  }
  // the scales, with the share that deployed and what is not met
  for (const auto& [scale, share] : {std::pair("0.5", "80"), {"0.75", "95"}, {"1.5", "100"}}) {
    const auto words = words_after(text, std::string("  ") + scale + " ");
    REQUIRE(words.size() > 1);
    CHECK(words[0].starts_with(share));
  }
  CHECK(prints(text, "joint confidence of 2 requirements: at least 60 %")); // 1 − 2 edges · 2 · 0.1
}

TEST_CASE("the text of a margin shows the deployed share of the worst case", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(runs_of_window));
  MarginResult result = made_up_window(campaign);
  result.cases.push_back({"root spring out", {}});
  for (auto& [scale, cases] : result.searches[0].seen) {
    cases.push_back(cases[0]);
    const std::size_t worst = scale < 1 ? 1 : 0; // not always the same one
    cases[worst].statuses[static_cast<std::size_t>(Status::deployed)] -= 300;
    cases[worst].statuses[static_cast<std::size_t>(Status::timed_out)] += 300;
  }
  const std::string text = margin_text({campaign, result, {}});
  CAPTURE(text);
  CHECK(prints(text, "worst case"));
  CHECK(words_after(text, "  0.75 ").at(0).starts_with("65"));
  CHECK(words_after(text, "  1.5 ").at(0).starts_with("70"));
}

TEST_CASE("the text of a margin names a single parameter, and the case of every cut peak",
          "[margin]") {
  Json json = one_panel_margin(runs_of_window);
  json["margin"]["scale"] = {"hinges.root.spring.scale"};
  const Campaign campaign = campaign_of(json);
  MarginResult result = made_up_window(campaign);
  CHECK(prints(margin_text({campaign, result, {}}),
               "WINDOW of the spring scale: hinges.root.spring.scale, searched from 0.5 to 2 "));
  MarginSearch& search = result.searches[0];
  result.cases.push_back({"root spring out", {}});
  search.recommended.reset(), search.withheld = Withheld::no_window;
  for (auto& [scale, cases] : search.seen) { // every scale fails in both cases, at 1 by cut peaks
    Verdict& verdict = cases[0].verdicts[0];
    verdict.decision = Decision::undecided;
    verdict.not_listed = verdict.cut = verdict.open = scale == 1 ? 300 : 0;
    if (scale != 1) verdict.decision = Decision::fail;
    cases.push_back(cases[0]);
  }
  const std::string text = margin_text({campaign, result, {}});
  CAPTURE(text);
  for (const char* which : {"(nominal)", "(root spring out)"})
    CHECK(prints(text, std::string("t_end cut the peak in 300 of 1000 runs at scale 1: deployed, "
                                   "97 % at 90 % ") +
                           which));
}

TEST_CASE("the text of a margin says what is recommended, and what it costs", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(runs_of_window));
  MarginResult result = made_up_window(campaign);
  MarginSearch& search = result.searches[0];
  const auto text_of = [&] { return margin_text({campaign, result, {}}); };
  search.recommended.reset(), search.withheld = Withheld::no_lower_edge;
  CHECK(prints(text_of(), "none:"));
  CHECK(prints(text_of(), "nothing fails down to 0.5"));
  search.withheld = Withheld::nothing;
  search.recommended = 1.5, search.as_good = {1.5, 1.5};
  search.confirmation = search.seen.at(1.5);
  const std::string text = text_of();
  CAPTURE(text);
  CHECK(prints(text, "1000 runs of seed 99: all requirements are met"));
  CHECK(prints(text, "7 of 1000 runs break it"));
  // the springs, 2 and 0.2 N·m, at 1.5 of them
  CHECK(words_after(text, "  hinges.root.spring.torque_stowed") ==
        std::vector<std::string>{"2", "3", "N·m"});
  CHECK(words_after(text, "  hinges.root.spring.torque_latched") ==
        std::vector<std::string>{"0.2", "0.3", "N·m"});
  // against the present springs more draws latch too fast, and the quantile is nearer to its limit
  CHECK(prints(text, "5 of 1000 runs break it now, 7 recommended"));
  CHECK(prints(text, "3 % quantile among runs with a value: -0.5 now, -0.75 recommended"));
  for (auto& [scale, cases] : search.seen) // a limit of -60 deg/s has its values beside it in deg/s
    cases[0].verdicts[1].requirement.min = -std::numbers::pi / 3;
  CHECK(prints(text_of(), "with a value: -28.648 now, -42.972 recommended"));
  search.confirmation = search.seen.at(1.75);
  // the requirement that breaks, with its runs
  CHECK(prints(text_of(), "1000 runs of seed 99: NOT confirmed: " +
                              condition_findings(campaign, result, search)[1].requirement +
                              " (40 runs break it, 12 allowed)"));
}

TEST_CASE("the text of a margin speaks of springs only where springs are scaled", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(runs_of_window));
  MarginResult result = made_up_window(campaign);
  MarginSearch& search = result.searches[0];
  const auto spoken = [&] {
    std::string all;
    const auto add = [&] {
      all +=
          margin_text({campaign, result, {}}) + why_withheld(search) + std::string(rule_of(search));
    };
    search.confirmation = search.seen.at(1);
    for (const double scale : {1.0, 1.5})
      search.recommended = scale, search.as_good = {1, 1.5}, add();
    search.recommended.reset();
    for (const Withheld why : {Withheld::no_window, Withheld::no_lower_edge,
                               Withheld::no_upper_edge, Withheld::short_of_torque})
      search.withheld = why, search.recommended = 1, add();
    // the parameters' paths are not words of ours
    for (const char* path :
         {"hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"})
      for (std::size_t at = all.find(path); at != std::string::npos; at = all.find(path))
        all.erase(at, std::string_view(path).size());
    return all;
  };
  CHECK(spoken().find("springs") != std::string::npos);
  search.of_springs = false;
  const std::string text = spoken();
  CHECK(text.find("spring") == std::string::npos);
  CHECK(text.find("SPRING") == std::string::npos);
  for (const char* words : {"lowest values", "highest values", "present values", "NEW VALUES"})
    CHECK(text.find(words) != std::string::npos);
}

TEST_CASE(
    "the text of a margin: shares with bounds, what is not met, gaps, cut peaks, a longer range",
    "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(runs_of_window));
  MarginResult result = made_up_window(campaign);
  MarginSearch& search = result.searches[0];
  search.seen[0.4] = search.seen.at(0.5);
  search.seen.at(1.75)[0].verdicts[1].cut = 3;
  const std::string text = margin_text({campaign, result, {}});
  CAPTURE(text);
  CHECK(prints(text, "searched from 0.5 to 2, extended to 0.4 … 2 to find the edges"));
  CHECK(prints(text, "40 of 1000 runs break it, 12 allowed t_end cut the peak in 3 of them"));
  CHECK(prints(text, "up to 50 % apart (1 and 1.5)"));
  MarginResult wide = made_up_window(campaign);
  auto& seen = wide.searches[0].seen;
  seen[3.5] = seen.at(1.5);
  for (const double scale : {1.5, 1.75, 2.0}) seen.erase(scale);
  CHECK(prints(margin_text({campaign, wide, {}}), "up to 250 % apart (1 and 3.5)"));
  search.seen.at(1.75)[0].verdicts[1].cut = 1;
  CHECK(prints(margin_text({campaign, result, {}}), "t_end cut the peak in 1 of them"));
  search.seen.at(1.75)[0].verdicts[1].cut = 0;
  CHECK_FALSE(prints(margin_text({campaign, result, {}}), "t_end cut the peak"));
  const std::string rows = text.substr(text.find("\nSCALE"));
  CHECK(words_after(rows, "SCALE")[1] == "95");
  for (const auto& [scale, cases] : search.seen) {
    CAPTURE(scale);
    const DeployedShare deployed = deployed_share(cases[0], 0.95);
    std::string wanted =
        percent(deployed.share) + ' ' + percent_range(deployed.bounds.lower, deployed.bounds.upper);
    if (scale < 1) wanted += " deployed"; // what stalls breaks the other too, and is told once
    if (scale > 1.5) wanted += " root.latch_rate";
    const auto words = words_after(rows, fmt::format("  {} ", scale));
    CHECK(fmt::format("{}", fmt::join(words, " ")) == wanted);
  }
}

TEST_CASE(
    "static margins are those of the present springs, and of the recommended if they are others",
    "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(runs_of_window));
  MarginResult result = made_up_window(campaign);
  MarginSearch& search = result.searches[0];
  const auto scales_told = [&](double recommended) {
    search.recommended = recommended, search.confirmation = search.seen.at(1.5);
    std::vector<double> scales;
    for (const CaseMargins& each : margin_report(campaign, result).static_margins.cases)
      scales.push_back(each.scale);
    return scales;
  };
  CHECK(scales_told(1) == std::vector<double>{1});
  CHECK(scales_told(1.5) == std::vector<double>{1, 1.5});
  CHECK(scales_told(2) == std::vector<double>{1, 2});
}

TEST_CASE("a confirmation that failed states no confidence", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(runs_of_window));
  MarginResult result = made_up_window(campaign);
  MarginSearch& search = result.searches[0];
  for (const double of : {1.5, 1.75}) {
    search.confirmation = search.seen.at(of);
    const Json json = margin_json({campaign, result, {}}, Json::object());
    const Json& said = json["searches"][0]["recommended"]["confirmation"];
    CAPTURE(of, said.dump());
    CHECK(said.at("passes") == (of == 1.5));
    CHECK(said.at("joint_confidence").is_number() == (of == 1.5));
  }
}
