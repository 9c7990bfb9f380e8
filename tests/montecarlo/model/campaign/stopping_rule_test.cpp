#include "montecarlo/model/campaign/stopping_rule.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::vector<std::string> outputs{"root.latch_time", "deployment_time"};
const std::vector<std::string> requirements{"T-1", "deployed"};

std::string problems_of_rule(const Json& document) {
  StoppingRule rule;
  return problems_of(document, [&](const JsonCursor& at) {
    read_stopping_rule(at, &outputs, &requirements, rule);
  });
}

} // namespace

TEST_CASE("Widths to stop at are read from words, and written as a campaign has them",
          "[stopping]") {
  struct Case {
    const char *text, *json;
  };
  for (const auto& [text, json] :
       {Case{"root.latch_time@0.99 0.5 s",
             R"([{"output":"root.latch_time","quantile":0.99,"width":0.5}])"},
        Case{"root.latch_time@0.5 2%",
             R"([{"output":"root.latch_time","quantile":0.5,"relative_width":0.02}])"},
        Case{"timed_out 0.01", R"([{"output":"timed_out","width":0.01}])"},
        Case{"requirement T-1", R"([{"requirement":"T-1"}])"},
        Case{"requirement root latches in time", R"([{"requirement":"root latches in time"}])"}}) {
    CHECK(write_stopping_rule(rule_of(text)).dump() == json);
    CHECK(to_string(rule_of(text)[0]) == text);
  }
  CHECK(to_string(rule_of("root.latch_time@0.5 2 %")[0]) == "root.latch_time@0.5 2%");
  // of a share of runs one per cent is 0.01
  for (const char* text : {"deployed 1 %", "deployed 1%", "deployed 0.01"})
    CHECK(to_string(rule_of(text)[0]) == "deployed 0.01");
  // the number nearest to the decimal one: 0.7 / 100 and 2.3 / 100 are others
  for (const auto& [text, share] : {std::pair("0.7", 0.007),
                                    {"2.3", 0.023},
                                    {"5.7e-8", 5.7e-10},
                                    {"1e-9", 1e-11},
                                    {"29", 0.29}})
    CHECK(parse_stopping_goal("deployed " + std::string(text) + "%").value()["width"] == share);
  CHECK(parse_stopping_goal("root.held 1%") ==
        parse_json(R"({ "output": "root.held", "width": 0.01 })"));
  for (const char* text : {"root.latch_time@0.5 20 ms", "root.latch_time@0.5 20ms"})
    CHECK(to_string(rule_of(text)[0]) == "root.latch_time@0.5 0.02 s");
  CHECK(parse_stopping_goal("my hinge.latch_rate@0.5 3 deg/s") ==
        parse_json(R"({ "output": "my hinge.latch_rate", "quantile": 0.5, "width": "3 deg/s" })"));
  for (const char* text : {"", " ", "deployed", "deployed x", "x@half 1", "deployed 1e999", "%",
                           "x@0.5 1 s %", "requirement", "requirement "})
    CHECK_FALSE(parse_stopping_goal(text));
}

TEST_CASE("Each fault of a width to stop at is told", "[stopping]") {
  const Json good = parse_json(R"([{ "output": "root.latch_time", "quantile": 0.9, "width": 0.5 },
                     { "output": "stalled", "width": 0.01 }])");
  CHECK(problems_of_rule(good).empty());
  CHECK(problems_of_rule(spoil(good, {"/0/width", "\"5 ms\"", ""})).empty());
  const Spoiled change = GENERATE(values<Spoiled>(
      {{"", "3",
        "found 3, expected an array of widths to be reached and requirements to be decided"},
       {"/0", "3",
        "/0: found 3, expected a width to be reached, or a requirement to be decided: an object"},
       {"/0/output", "", "/0/output: found nothing, expected a string, an output or a status"},
       {"/1/output", "\"stall\"",
        "/1/output: found string \"stall\", expected an output of the campaign, or a status (did "
        "you mean \"stalled\"?)\n/1/quantile: found nothing, expected a number, > 0 and < 1: the "
        "quantile that is meant"},
       {"/0/quantile", "",
        "/0/quantile: found nothing, expected a number, > 0 and < 1: the quantile that is meant"},
       {"/0/quantile", "1",
        "/0/quantile: found 1, expected a number, > 0 and < 1: the quantile that is meant"},
       {"/1/quantile", "0.5", "/1/quantile: found 0.5, expected no quantile of a share of runs"},
       {"/0/width", "0", "/0/width: found 0, expected a number, in the output's unit, > 0"},
       {"/0/width", "\"0 ms\"", "/0/width: found string \"0 ms\", expected a number, s, > 0"},
       {"/0/width", "\"1 deg\"",
        "/0/width: found string \"1 deg\", expected a number, s, > 0, or a string of a number and "
        "its unit: \"s\", \"ms\", \"min\" or \"h\""},
       {"/1/width", "1",
        "/1/width: found 1, expected a width > 0 and < 1 for a share of runs: 0.01 is one in a "
        "hundred of all runs"},
       {"/0/width", "", "/0: found neither width nor relative_width, expected one of them"},
       {"/0/relative_width", "1", "/0: found both width and relative_width, expected one of them"},
       {"/1/widht", "1",
        "/1/widht: found the unknown key \"widht\", expected \"output\", \"width\", "
        "\"relative_width\" or \"quantile\" (did you mean \"width\"?)"}}));
  CAPTURE(change.pointer, change.value);
  CHECK(facts_of(problems_of_rule(spoil(good, change))) == facts_of(change.message));
  CHECK(problems_of_rule(parse_json(R"([{ "output": "stalled", "relative_width": 0.5 }])")) ==
        "/0: found a relative_width, expected a width > 0 and < 1 for a share of runs: 0.01 is one "
        "in a "
        "hundred of all runs");
}

TEST_CASE("Each fault of a requirement to be decided is told", "[stopping]") {
  CHECK(problems_of_rule(parse_json(R"([{ "requirement": "T-1" }, { "requirement": "deployed" }])"))
            .empty());
  CHECK(problems_of_rule(parse_json(R"([{ "requirement": "T-2" }])")) ==
        "/0/requirement: found string \"T-2\", expected a requirement of the campaign, by its name "
        "or "
        "its output (did you mean \"T-1\"?)");
  CHECK(problems_of_rule(parse_json(R"([{ "requirement": 3 }])")) ==
        "/0/requirement: found 3, expected a string, the name of a requirement");
  CHECK(problems_of_rule(parse_json(R"([{ "requirement": "T-1", "width": 1 }])")) ==
        "/0/width: found the unknown key \"width\", expected \"requirement\"");
}

TEST_CASE("Checkpoints are the powers of two times 1000, and the end", "[stopping]") {
  const StoppingRule rule = rule_of("deployed 0.1");
  const auto all = [](long runs) {
    std::vector<long> checkpoints;
    for (long done = 0; done < runs; done = checkpoints.back())
      checkpoints.push_back(next_interim_analysis(done, runs));
    return checkpoints;
  };
  CHECK(all(10000) == std::vector<long>{1000, 2000, 4000, 8000, 10000});
  CHECK(all(8000) == std::vector<long>{1000, 2000, 4000, 8000});
  CHECK(all(1500) == std::vector<long>{1000, 1500});
  CHECK(all(300) == std::vector<long>{300});
  CHECK(next_interim_analysis(1500, 10000) == 2000);
  CHECK((is_interim_analysis(2000, 10000) && is_interim_analysis(10000, 10000) &&
         !is_interim_analysis(0, 10000) && !is_interim_analysis(1500, 10000)));
  CHECK((count_interim_analyses(rule, 10000) == 5 && count_interim_analyses(rule, 300) == 1 &&
         count_interim_analyses({}, 9999) == 1));
  CHECK(count_interim_analyses(rule, std::numeric_limits<long>::max()) ==
        55); // 1000 · 2^53 and the end
}
