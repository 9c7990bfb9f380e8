#include "montecarlo/analyses/fit/parameter_space.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"
#include "montecarlo/model/schema/schema.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

#include <numeric>

using namespace wingspread;
using namespace wingspread::test;

// Of three tests, the second has no clock of its own and the first and third have an own friction.
TEST_CASE("offsets and own parameters are each test's own, whichever test has them", "[fit]") {
  const Campaign campaign = campaign_of(panel_campaign());
  FitSpec spec;
  spec.parameters = {0, 1};
  spec.tests.resize(3);
  for (std::size_t t = 0; t < 3; ++t) {
    FitTest& test = spec.tests[t];
    test.name = "test " + std::to_string(t);
    test.columns.resize(2);
    for (std::size_t c = 0; c < 2; ++c) {
      test.columns[c].name = "column " + std::to_string(c);
      test.columns[c].offset_std = 0.1 * static_cast<double>(10 * t + c + 1);
    }
    if (t == 1) continue;
    test.time_offset_std = 0.01 * static_cast<double>(t + 1);
    test.own = {1};
  }
  spec.tests[2].columns[0].std = 1; // known noise: its offset is integrated out
  const ParameterSpace space(campaign, spec);
  // spring and friction in common; friction of tests 0 and 2; two clocks; offsets of all columns but one
  REQUIRE(space.size() == 2 + 2 + 2 + 5);
  CHECK(space.common() == 2);
  FitPoint at(static_cast<Eigen::Index>(space.size()));
  for (Eigen::Index k = 0; k < at.size(); ++k) at[k] = 1 + 0.1 * static_cast<double>(k);
  const auto named = [&](const std::string& name) {
    for (std::size_t k = 0; k < space.size(); ++k)
      if (space.list()[k].name == name) return at[static_cast<Eigen::Index>(k)];
    FAIL("no parameter " + name);
    return 0.0;
  };
  for (std::size_t t = 0; t < 3; ++t) {
    const FitTest& test = spec.tests[t];
    CAPTURE(t);
    CHECK(space.time_offset(t, at) ==
          (t == 1 ? 0 : test.time_offset_std * named("time offset of " + test.name)));
    for (std::size_t c = 0; c < 2; ++c)
      CHECK(space.column_offset(t, c, at) ==
            (test.columns[c].std
                 ? 0
                 : test.columns[c].offset_std *
                       named("offset of " + test.columns[c].name + " of " + test.name)));
    std::vector<Tails> u(2);
    space.place(t, at, u);
    const auto lies_at = [](const Tails& tails, double z) {
      const Tails expected = unit_point(z);
      return tails.below == expected.below && tails.above == expected.above;
    };
    CHECK(lies_at(u[0], named("spring")));
    CHECK(lies_at(u[1], named(t == 1 ? "friction" : "friction of " + test.name)));
  }
}

TEST_CASE(
    "a prior has its law's moments and quantiles, whatever the law, and the unit of what it sets",
    "[fit]") {
  Json json = panel_campaign();
  json["dispersions"] = parse_json(R"([
    { "name": "factor", "distribution": { "type": "uniform", "lower": 0.9, "upper": 1.1 },
      "apply": "scale", "to": ["hinges.root.spring.torque_stowed"] },
    { "name": "torque", "distribution": { "type": "lognormal", "mu_log": 0, "sigma_log": 2 },
      "apply": "set", "to": ["hinges.root.friction.coulomb"] } ])");
  const Campaign campaign = campaign_of(json);
  const auto of = [&](std::size_t dispersion) {
    FitParameter parameter;
    parameter.dispersion = dispersion;
    return prior_of(parameter, campaign, 0.95);
  };
  CHECK(of(0).mean == Approx(1));
  CHECK(of(0).std == Approx(0.2 / std::sqrt(12)));
  CHECK(of(0).lower == Approx(0.905));
  CHECK(of(0).upper == Approx(1.095));
  CHECK(of(0).unit.empty());
  CHECK(of(1).lower == Approx(std::exp(-2 * 1.959964)));
  CHECK(of(1).upper == Approx(std::exp(2 * 1.959964)));
  CHECK(of(1).unit == "N·m");
  FitParameter offset;
  offset.kind = FitParameter::Kind::time_offset, offset.std = 0.5, offset.unit = "s";
  const ParameterPrior prior = prior_of(offset, campaign, 0.95);
  CHECK(prior.upper == Approx(0.979982));
  CHECK(prior.lower == -prior.upper);
  CHECK(prior.unit == "s");
}

// The ranks of an MPI program rebuild a campaign from its JSON.
TEST_CASE("campaigns with other laws say so in their JSON, whatever entry a draw comes from",
          "[fit]") {
  int entries = 0;
  for (const Json& specimen : campaign_specimens()) {
    if (specimen.dump().find("no_such_file") != std::string::npos) continue;
    const Campaign campaign = read_campaign(specimen.dump(), "");
    std::vector<std::size_t> odd, all(campaign.dispersions.size());
    std::iota(all.begin(), all.end(), 0);
    for (const std::size_t i : all)
      if (i % 2) odd.push_back(i);
    for (const Campaign& changed :
         {with_normal_laws(campaign, all), with_normal_laws(campaign, odd), fixed_but(campaign, {}),
          fixed_but(campaign, odd)}) {
      Json json = changed.resolved;
      json["wingspread"] = Json::object();
      const Campaign read = read_campaign(json.dump(), "");
      REQUIRE(read.dispersions.size() == changed.dispersions.size());
      for (const std::size_t i : all) {
        const Dispersion &found = read.dispersions[i], &expected = changed.dispersions[i];
        CAPTURE(expected.name);
        CHECK(found.name == expected.name);
        CHECK(write_distribution(found.distribution) == write_distribution(expected.distribution));
        CHECK(found.targets == expected.targets);
        if (expected.through.empty()) CHECK(found.apply == expected.apply);
        REQUIRE(found.through.size() == expected.through.size());
        for (std::size_t k = 0; k < found.through.size(); ++k)
          CHECK(found.through[k].targets == expected.through[k].targets);
        ++entries;
      }
      REQUIRE(read.wanted_correlations.size() == changed.wanted_correlations.size());
      for (std::size_t k = 0; k < read.wanted_correlations.size(); ++k) {
        const RankCorrelation &found = read.wanted_correlations[k],
                              &expected = changed.wanted_correlations[k];
        CHECK((found.first == expected.first && found.second == expected.second));
        CHECK(found.spearman == Approx(expected.spearman).epsilon(1e-12));
      }
    }
  }
  CHECK(entries > 50);
}
