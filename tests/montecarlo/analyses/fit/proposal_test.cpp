#include "montecarlo/analyses/fit/proposal.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

// Of d parameters: two runs each for the slopes; 1 + d + d² for the quadratic; 32 to judge it.
TEST_CASE("a proposal about a nearly normal mode takes as many runs as its quadratic needs") {
  for (const std::size_t d : {1u, 2u}) {
    CAPTURE(d);
    const Campaign campaign = campaign_of(panel_campaign(0.02, 0.05));
    Json json = parse_json(R"({ "tests": [ { "name": "timer",
        "values": [ { "output": "root.latch_time", "value": 2.3, "std": 0.02 },
                    { "parameter": "hinges.root.friction.scale", "value": 1, "std": 0.1 } ] } ],
      "fit": { "parameters": ["spring", "friction"] } })");
    json["tests"][0]["values"][0]["value"] = panel_latch_time(1.01, 1);
    if (d == 1) json["fit"]["parameters"].erase(1);
    const FitSpec spec = read_fit(json, "", ".", campaign);
    const ParameterSpace space(campaign, spec);
    ThreadEvaluator evaluator({.threads = 1}, never);
    TestRuns runs(spec.tests, spec.parameters, space, evaluator);
    const FitData data = data_of(spec.tests);
    const std::vector<FitPoint> starts{FitPoint::Zero(static_cast<Eigen::Index>(d))};
    const std::vector<FitMode> modes = find_modes(data, runs, starts);
    const long before = runs.runs();
    (void)proposal_about(modes, data, runs, 1);
    CHECK(runs.runs() - before == static_cast<long>(2 * d + (1 + d + d * d) + 32));
  }
}
