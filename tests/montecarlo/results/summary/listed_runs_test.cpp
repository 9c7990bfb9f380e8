// The runs and reasons that a summary lists: how many, in which order, and what of a part of the runs.
#include "montecarlo/results/summary/judge_campaign.hpp"
#include "montecarlo/results/summary/reason_pattern.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/table.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <map>
#include <random>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Forty deployed runs, of which the last so many are beyond a limit of 0.
Results beyond(long count) {
  Results results(ResultNames{{}, {"root.peak_moment"}});
  for (long run = 0; run < 40; ++run)
    results.append({run, Status::deployed, {}, {run < 40 - count ? -1. : 1.}, "root", ""});
  return results;
}

} // namespace

TEST_CASE("the table names up to six runs that break a requirement, and says if there are more") {
  for (long count = 1; count < 12; ++count) {
    CAPTURE(count);
    const Results results = beyond(count);
    Summary summary = summarize(results, {});
    summary.requirements = {judge({"", "root.peak_moment", 0, {}, .5, .5}, results)};
    std::istringstream lines(summary_table(summary, "t", "out"));
    std::string text;
    while (std::getline(lines, text) && text.find("--run") == std::string::npos) {
    }
    for (const char* word : {" and ", ", "}) // the runs alone remain
      for (std::size_t at; (at = text.find(word)) != std::string::npos;)
        text.replace(at, std::string_view(word).size(), " ");
    std::istringstream words(text.substr(text.find("--run") + 5));
    long listed = 0;
    std::string word;
    for (long run = 40 - count; words >> word && word != "…"; ++run, ++listed)
      CHECK(word == std::to_string(run));
    CHECK(listed == std::min(count, 6L));
    CHECK((word == "…") == (count > 6));
  }
}

TEST_CASE("reasons stand by status, in each the most frequent first, however they were counted") {
  std::mt19937_64 random(3);
  constexpr std::array statuses_with{Status::stalled, Status::invalid, Status::failed};
  constexpr std::array texts{"friction holds root", "no energy is left", "a mass is negative"};
  for (int trial = 0; trial < 50; ++trial) {
    ReasonCounts counts, other;
    std::map<std::pair<Status, std::string>, long> expected;
    for (int k = 0; k < 60; ++k) {
      const Status status = statuses_with[random() % 3];
      const std::string text = texts[random() % (1 + random() % 3)];
      (random() % 2 == 0 ? counts : other).add(status, text);
      ++expected[{status, text}];
    }
    counts.add(other);
    const std::vector<ReasonCount> found = counts.sorted();
    CHECK(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      CHECK(found[k].count == expected[{found[k].status, found[k].reason}]);
      if (k == 0) continue;
      CHECK(found[k - 1].status <= found[k].status);
      if (found[k - 1].status == found[k].status) CHECK(found[k - 1].count >= found[k].count);
    }
  }
}

TEST_CASE("of a part of the runs no verdict says pass, disproved or what is guaranteed") {
  for (const long count : {0L, 3L, 30L}) {
    const Results results = beyond(count);
    Summary summary = summarize(results, {});
    summary.requirements = {judge({"", "root.peak_moment", 0, {}, .5, .9}, results),
                            judge({"", "deployed", {}, {}, .9, .9}, results)};
    const std::vector<Verdict> whole = summary.requirements;
    CHECK(whole[0].disproved == (count == 30));
    withdraw_of_part(summary);
    for (std::size_t k = 0; k < whole.size(); ++k) {
      const Verdict& of_part = summary.requirements[k];
      CHECK((of_part.of_part && of_part.decision == Decision::undecided && !of_part.disproved));
      CHECK((std::isnan(of_part.guaranteed_share) && !of_part.guaranteed && !of_part.margin));
      CHECK((of_part.failures() == whole[k].failures() && of_part.observed == whole[k].observed));
    }
  }
}

TEST_CASE(
    "summary.json counts the runs that break a requirement and are not shown, listed or not") {
  for (const std::size_t listed : {0, 1, 5, 1000})
    for (const long not_listed : {0L, 1L, 70L}) {
      Summary summary = summarize(beyond(0), {});
      Verdict& verdict = summary.requirements.emplace_back();
      verdict.requirement = {"", "root.peak_moment", 0, {}, .5, .5};
      for (std::size_t run = 0; run < listed; ++run)
        verdict.broken.push_back(static_cast<long>(run));
      verdict.not_listed = not_listed;
      const Json json = summary_json(summary, {})["requirements"][0];
      CHECK(std::ssize(json["broken"]) + json["broken_omitted"].get<long>() ==
            static_cast<long>(listed) + not_listed);
      CHECK(json["failures"]["seen"] == static_cast<long>(listed) + not_listed);
    }
}
