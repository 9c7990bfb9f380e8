#include "montecarlo/analyses/fit/fit_report.hpp"
#include "tests/cli/program.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// One latch time of the panel, to which its spring is fitted.
class Fit {
public:
  explicit Fit(int samples = 200) {
    Json tests = parse_json(R"({ "tests": [ { "name": "timer", "values": [
        { "output": "root.latch_time", "value": 2.3, "std": "10 ms" } ] } ],
      "fit": { "parameters": ["spring"], "starts": 2 } })");
    tests["fit"]["samples"] = samples;
    folder_.write("tests.json", tests.dump());
    for (const int seed : {5, 9}) {
      Json campaign = panel_campaign(0.01);
      campaign["sampling"]["seed"] = seed;
      folder_.write(("c" + std::to_string(seed) + ".json").c_str(), campaign.dump());
    }
  }
  /// @param campaign by its seed
  Finished operator()(int campaign, const std::string& out,
                      std::vector<std::string> options = {}) const {
    const std::string file = folder_.path() / ("c" + std::to_string(campaign) + ".json");
    std::vector<std::string> words{"fit", file, folder_.path() / "tests.json", "--out", at(out)};
    words.insert(words.end(), options.begin(), options.end());
    return run_program(folder_, words);
  }
  [[nodiscard]] std::string at(const std::string& out) const { return folder_.path() / out; }
  [[nodiscard]] std::string rows(const std::string& out) const {
    return read_text(at(out) + "/posterior.csv").value();
  }

private:
  Folder folder_;
};

} // namespace

TEST_CASE("fit: a parameter at a limit of its prior is marked, and told with --json too") {
  const Folder folder;
  Json campaign = panel_campaign(0.01);
  campaign["dispersions"][0]["distribution"] =
      parse_json(R"({ "type": "uniform", "lower": 0.98, "upper": 1.02 })");
  const std::string file = folder.write("c.json", campaign.dump());
  const std::string tests =
      folder.write("tests.json", R"({ "tests": [ { "name": "timer", "values": [
      { "output": "root.latch_time", "value": 2.1, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"], "starts": 2, "samples": 200 } })");
  const std::string out = folder.path() / "out";
  const auto fit = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"fit", file, tests, "--out", out});
    return run_program(folder, options);
  };
  const auto first = fit({"--json"});
  CHECK(first.code == 0); // a fit has no requirement
  CHECK(first.error.find("warning: spring lies at the limit 1.02 of its prior") !=
        std::string::npos);
  CHECK(parse_json(first.out)["at_limits"] == Json{"spring"});
  CHECK_THAT(fit({"--resume"}).error, Catch::Contains("warning: spring lies at the limit 1.02"));
}

TEST_CASE("fit: intervals are those of 95 %, whatever confidence the campaign's statistics have") {
  const Folder folder;
  const std::string tests =
      folder.write("tests.json", R"({ "tests": [ { "name": "timer", "values": [
      { "output": "root.latch_time", "value": 2.3, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"], "starts": 2, "samples": 200 } })");
  const auto parameter = [&](double confidence) {
    Json campaign = panel_campaign(0.01);
    campaign["statistics"]["confidence"] = confidence;
    const std::string file = folder.write("c.json", campaign.dump());
    const std::string out = folder.path() / std::to_string(confidence);
    const Finished done = run_program(folder, {"fit", file, tests, "--out", out, "--json"});
    REQUIRE(done.code == 0);
    return parse_json(done.out)["parameters"]["spring"];
  };
  const Json usual = parameter(0.95), half = parameter(0.5);
  CHECK(half == usual);
  const double width = usual["upper"].get<double>() - usual["lower"].get<double>();
  CHECK(width / usual["std"].get<double>() == Approx(3.92).epsilon(0.1)); // of a normal posterior
}

TEST_CASE("fit: every option does what its help says") {
  const Fit fit;
  const auto nine = fit(9, "nine", {"--json"});
  CHECK(nine.code == 0);
  CHECK(nine.out == *read_text(fit.at("nine") + "/fit.json"));
  CHECK(lines_of(fit.rows("nine")).size() == 1 + 200);
  // the option's seed takes the place of the campaign's, on any number of threads
  const auto seeded = fit(5, "seeded", {"--seed", "9", "--threads", "2"});
  CHECK(seeded.code == 0);
  CHECK(seeded.out.find("PARAMETER") != std::string::npos);
  CHECK(fit.rows("seeded") == fit.rows("nine"));
  CHECK(fit(9, "nine").code == 2); // there is one already
  CHECK(fit(9, "nine", {"--resume", "--json"}).out == nine.out);
}

TEST_CASE("fit: too few runs are no result, and --resume goes on with them") {
  const Fit fit(1500);
  const auto fewer = fit(5, "few", {"--runs", "50"}); // than the sampler makes before it can judge
  CHECK(fewer.code == 2);
  CHECK_THAT(fewer.error, HasFacts({"--runs: found 50, expected a whole number at least 2080"}));
  const auto few = fit(5, "few", {"--runs", "2080"});
  CHECK(few.code == 1);
  CHECK(few.out.starts_with("not finished: effective sample size"));
  const auto more = fit(5, "few", {"--resume", "--json"});
  CHECK(more.code == 0);
  CHECK(parse_json(more.out)["finished"] == true);
}
