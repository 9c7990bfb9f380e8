#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/report/data/differences.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

SameRuns rows_from_0(std::size_t count) {
  SameRuns rows;
  for (std::size_t row = 0; row < count; ++row) {
    rows.first.push_back(row);
    rows.second.push_back(row);
  }
  return rows;
}

/// Two sets of a campaign whose rows were not kept, with the same outputs.
struct RowlessPair {
  std::unique_ptr<PageSource> first = made(quick_campaign(2)), second = made(quick_campaign(2));

  RowlessPair() {
    for (PageSource* each : {first.get(), second.get()})
      each->streaming = std::make_unique<StreamingStatistics>(
          each->stored.campaign, RunPlan(each->stored.campaign).names(), each->results);
  }
  /// The difference of the first output's means.
  [[nodiscard]] Json compared(const Moments& a, const Moments& b) const {
    first->summary.outputs[0].moments = a, second->summary.outputs[0].moments = b;
    return comparison_json(*first, *second, {0, 1})["outputs"][0];
  }
};

} // namespace

TEST_CASE("a paired difference is that of the runs' differences, by hand", "[page]") {
  const Column a = column_of("x", {1, 2, nothing, 3, 4, 7}),
               b = column_of("x", {2, 4, 9, 3, 5, nothing});
  const Difference found = paired_difference(a, b, rows_from_0(6), {}, 0.95);
  CHECK(found.runs == 4);
  CHECK(found.value == 1);                                         // of 1, 2, 0, 1
  const double width = 3.182446305284263 * std::sqrt(2.0 / 3) / 2; // t of 3
  CHECK(*found.bounds.lower == Approx(1 - width).epsilon(1e-12));
  CHECK(*found.bounds.upper == Approx(1 + width).epsilon(1e-12));
  const Difference replicated =
      paired_difference(a, b, rows_from_0(6), {2, {0, 0, 0, 1, 1, 1}}, 0.95);
  // replicates' sums of deviations: 0 + 1 and -1 + 0; s² = 2 · (1 + 1)/16
  CHECK(*replicated.bounds.upper - 1 == Approx(12.706204736174698 * 0.5).epsilon(1e-10)); // t of 1
  // Where the tables share some rows only, the replicates are those of the first table's rows.
  const SameRuns shared{{1, 2, 4, 5}, {0, 1, 2, 3}};
  const Column c = column_of("x", {4, 1, 5, 5}); // less 2, nothing, 4, 7: 2, 1, -2
  const Difference of_some = paired_difference(a, c, shared, {2, {0, 0, 0, 0, 1, 1}}, 0.95);
  const Difference of_all = paired_difference(column_of("x", {2, 4, 7}), column_of("x", {4, 5, 5}),
                                              rows_from_0(3), {2, {0, 1, 1}}, 0.95);
  CHECK((of_some.runs == 3 && of_some.value == Approx(of_all.value)));
  CHECK(*of_some.bounds.upper == Approx(*of_all.bounds.upper).epsilon(1e-12));
  CHECK(!paired_difference(a, b, rows_from_0(1), {}, 0.95).bounds.lower);
  CHECK(std::isnan(paired_difference(a, b, {}, {}, 0.95).value));
}

TEST_CASE("an unpaired difference has Welch's interval, by hand", "[page]") {
  const Moments a = moments(std::vector<double>{1, 2, 3, 4, 5}),
                b = moments(std::vector<double>{2, 6, 10});
  const Difference found = unpaired_difference(a, b, 0.95);
  CHECK(found.value == 3);
  // variances of the means 0.5 and 16/3; degrees (35/6)²/(0.25/4 + 256/18) = 2.38, t of 2
  CHECK(*found.bounds.upper == Approx(3 + 4.302652729749464 * std::sqrt(35.0 / 6)).epsilon(1e-12));
}

TEST_CASE("bounds of differences of shares hold as often as they say", "[page]") {
  const Difference by_hand = paired_share_difference(1, 3, 100, 0.9);
  CHECK(by_hand.value == 0.02);
  CHECK(*by_hand.bounds.lower ==
        clopper_pearson(3, 100, 0.95).lower - clopper_pearson(1, 100, 0.95).upper);
  const Difference equal = paired_share_difference(0, 0, 1000, 0.95);
  CHECK(equal.value == 0);
  CHECK(*equal.bounds.upper == Approx(0.004372).epsilon(1e-3)); // 1 − 0.0125^(1/1000): not nothing
  std::mt19937_64 random(3);
  constexpr int trials = 2000;
  int held = 0, wrong_way = 0;
  for (int trial = 0; trial < trials; ++trial) {
    long first = 0, second = 0;
    for (int k = 0; k < 50; ++k) first += uniform(random) < 0.2, second += uniform(random) < 0.5;
    const Difference found = unpaired_share_difference(first, 50, second, 50, 0.9);
    held += *found.bounds.lower <= 0.3 && 0.3 <= *found.bounds.upper;
    wrong_way += *found.bounds.lower <= -0.3;
  }
  CHECK(held >= (0.9 - band(0.9, trials)) * trials);
  CHECK(wrong_way < trials / 2); // second less first, and no idle bounds
  CHECK(unpaired_share_difference(10, 50, 50, 50, 0.9).value == 0.8);
}

TEST_CASE("rows of one run stand beside each other", "[page]") {
  Results a(ResultNames{{}, {}, false}), b = a;
  for (const long run : {0, 1, 3, 4, 8}) a.append({run, Status::deployed, {}, {}, "", ""});
  for (const long run : {1, 2, 3, 8, 9}) b.append({run, Status::deployed, {}, {}, "", ""});
  const SameRuns rows = same_runs(a, b);
  CHECK(rows.first == std::vector<std::size_t>{1, 2, 4});
  CHECK(rows.second == std::vector<std::size_t>{0, 2, 3});
}

TEST_CASE("folders are compared before the cases of a folder", "[page]") {
  std::vector<std::unique_ptr<PageSource>> sets;
  for (const auto& [argument, name] :
       {std::pair(0, "cold"), std::pair(0, "hot"), std::pair(1, "cold"), std::pair(1, "hot")}) {
    sets.push_back(std::make_unique<PageSource>());
    sets.back()->argument = static_cast<std::size_t>(argument);
    sets.back()->stored.campaign.of_case = name;
  }
  CHECK(pairs_of(sets).both ==
        std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 3}, {0, 1}, {2, 3}});
}

TEST_CASE("outputs with negative values are compared by their magnitudes", "[page]") {
  const auto first = made(quick_campaign(20));
  Json json = quick_campaign(20);
  for (const char* torque : {"torque_stowed", "torque_latched"}) {
    Json& value = json["scene"]["hinges"][0]["spring"][torque];
    value = value.get<double>() * 1.2;
  }
  const auto stronger = made(json);
  const Json compared = comparison_json(*first, *stronger, {0, 1});
  const auto entry = std::ranges::find(compared["outputs"], "root.latch_rate",
                                       [](const Json& each) { return each["output"]; });
  const auto mean = [](const PageSource& source) {
    const auto column = std::ranges::find(source.results.outputs, "root.latch_rate", &Column::name);
    double sum = 0;
    for (const double value : column->values) sum += std::abs(value);
    return sum / 20;
  };
  REQUIRE(first->results.outputs[1].values[0] < 0); // the seed wing's root turns clockwise
  CHECK((*entry)["magnitude"] == true);
  CHECK((*entry)["difference"].get<double>() ==
        Approx(mean(*stronger) - mean(*first)).epsilon(1e-5));
  CHECK((*entry)["relative"].get<double>() ==
        Approx(mean(*stronger) / mean(*first) - 1).epsilon(1e-5));
}

TEST_CASE("sets are paired where their draws are the same", "[page]") {
  const auto first = made(quick_campaign(30));
  Json json = quick_campaign(20);
  json["scene"]["hinges"][0]["spring"]["torque_stowed"] =
      json["scene"]["hinges"][0]["spring"]["torque_stowed"].get<double>() * 1.001;
  const auto stronger = made(json);
  const Json paired = comparison_json(*first, *stronger, {0, 1});
  CHECK(paired["paired"] == true);
  CHECK(paired["why_unpaired"].is_null());
  CHECK(paired["sets"] == Json{0, 1});
  CHECK(paired["text"] ==
        "set − set, run by run over the 20 runs with the same random numbers (of 20 and 30)");
  const Json& time = paired["outputs"].back();
  CHECK(time["output"] == "deployment_time");
  CHECK(time["runs"] == 20);
  double sum = 0;
  for (std::size_t run = 0; run < 20; ++run)
    sum += stronger->results.outputs.back().values[run] - first->results.outputs.back().values[run];
  CHECK(time["difference"].get<double>() == Approx(sum / 20).epsilon(1e-6));
  json["sampling"]["seed"] = 8;
  const Json apart = comparison_json(*first, *made(json), {0, 1});
  CHECK(apart["paired"] == false);
  CHECK(
      apart["text"] ==
      "set − set, not paired, because their seeds, designs or dispersions differ: 20 and 30 runs");
  CHECK_THAT(apart["why_unpaired"].get<std::string>(), Catch::Contains("seeds"));
  const auto later = made(quick_campaign(20)); // a shard's runs
  for (long& run : later->results.runs) run += 30;
  CHECK_THAT(comparison_json(*first, *later, {0, 1})["why_unpaired"].get<std::string>(),
             Catch::Contains("no run in common"));
  const auto width = [](const Json& entry) {
    return entry["upper"].get<double>() - entry["lower"].get<double>();
  };
  CHECK(width(time) < 0.5 * width(apart["outputs"].back())); // what pairing is for
}

TEST_CASE(
    "sets without rows are compared by their moments: by magnitude where no value is positive",
    "[page]") {
  const RowlessPair sets;
  const auto of = [](const std::vector<double>& values) { return moments(values); };
  const Moments above = of({1, 2, 6}), below = of({-1, -2, -9}), far_below = of({-10, -12}),
                both = of({-5, -1, 3}), zero = of({0, 0});
  const auto check = [&](const Moments& a, const Moments& b, bool magnitude) {
    for (const auto& [one, two] : {std::pair(a, b), std::pair(b, a)}) {
      const Json entry = sets.compared(one, two);
      const double from = magnitude ? -one.mean : one.mean, to = magnitude ? -two.mean : two.mean;
      CHECK(entry["magnitude"] == magnitude);
      CHECK(entry["difference"].get<double>() == Approx(to - from));
      if (from != 0) CHECK(entry["relative"].get<double>() == Approx((to - from) / std::abs(from)));
    }
  };
  check(below, far_below, true);
  check(below, zero, true);
  check(zero, zero, false);
  check(above, below, false);
  check(both, below, false);
  check(both, above, false);
  check(above, zero, false);
}

TEST_CASE("where one of two sets has no rows, they are compared as if neither had", "[page]") {
  const RowlessPair rowless;
  const auto first = made(quick_campaign(2)), second = made(quick_campaign(2));
  const Json wanted = comparison_json(*rowless.first, *rowless.second, {0, 1});
  CHECK_THAT(wanted["text"].get<std::string>(),
             Catch::Contains("rows were not kept: 2 and 2 runs"));
  for (const Json& compared : {comparison_json(*rowless.first, *second, {0, 1}),
                               comparison_json(*first, *rowless.second, {0, 1})}) {
    CHECK(compared["outputs"] == wanted["outputs"]);
    CHECK(compared["text"] == wanted["text"]);
  }
  CHECK(comparison_json(*first, *second, {0, 1})["outputs"] != wanted["outputs"]);
}

TEST_CASE("sets are paired run by run only if each has the other's draws", "[page]") {
  const auto set = made(quick_campaign(4));
  const auto changed = [](auto change) {
    auto other = made(quick_campaign(4));
    change(*other);
    return other;
  };
  const auto same = [&](const PageSource& other) {
    CHECK(have_same_draws(*set, other) == have_same_draws(other, *set));
    return have_same_draws(*set, other);
  };
  CHECK(same(*changed([](PageSource&) {})));
  const auto sampling = [](PageSource& each) -> Sampling& { return each.stored.campaign.sampling; };
  CHECK(same(*changed([&](PageSource& other) { sampling(other).runs = 9; })));
  CHECK_FALSE(same(*changed([](PageSource& other) { other.stored.foreign = true; })));
  CHECK_FALSE(same(*changed([&](PageSource& other) { ++sampling(other).seed; })));
  CHECK_FALSE(same(*changed([&](PageSource& other) { ++sampling(other).replicates; })));
  CHECK_FALSE(same(
      *changed([&](PageSource& other) { sampling(other).design = DesignKind::latin_hypercube; })));
  CHECK_FALSE(same(*changed([](PageSource& other) { other.results.draws[0].name = "x"; })));
  CHECK_FALSE(same(*changed([](PageSource& other) { other.results.draws.pop_back(); })));
  sampling(*set).design = DesignKind::latin_hypercube; // strata depend on the number of runs
  const auto strata = [&](long runs) {
    return changed([&, runs](PageSource& other) {
      sampling(other).design = DesignKind::latin_hypercube, sampling(other).runs = runs;
    });
  };
  CHECK(same(*strata(4)));
  CHECK_FALSE(same(*strata(9)));
}

TEST_CASE("sets are paired in whatever order their campaigns list the dispersions, of any design",
          "[page]") {
  Json json = quick_campaign(6);
  json["sampling"]["design"] = GENERATE("random", "latin_hypercube", "sobol");
  if (json["sampling"]["design"] != "random") json["sampling"]["replicates"] = 2;
  if (GENERATE(false, true))
    json["correlations"] =
        parse_json(R"([ { "between": ["root_spring", "other"], "spearman": 0.5 } ])");
  Json other = json["dispersions"][0];
  other["name"] = "other", other["to"] = {"hinges.mid.spring.scale"};
  json["dispersions"].push_back(other);
  const auto set = made(json);
  std::ranges::reverse(json["dispersions"]);
  const auto reversed = made(json);
  REQUIRE(reversed->results.draws.front().name == "other");
  for (const Column& draws : set->results.draws) {
    CAPTURE(draws.name);
    const auto same = std::ranges::find(reversed->results.draws, draws.name, &Column::name);
    REQUIRE(same != reversed->results.draws.end());
    CHECK(std::ranges::equal(draws.values, same->values));
  }
  CHECK(have_same_draws(*set, *reversed));
  CHECK(comparison_json(*set, *reversed, {0, 1})["paired"] == true);
}

TEST_CASE("a status of paired sets is compared by the runs that have it in one of them alone",
          "[page]") {
  const auto first = made(quick_campaign(5)), second = made(quick_campaign(5));
  first->results.status = Spilled<Status>(std::vector{
      Status::deployed, Status::stalled, Status::stalled, Status::stalled, Status::deployed});
  second->results.status = Spilled<Status>(std::vector{
      Status::deployed, Status::deployed, Status::deployed, Status::stalled, Status::timed_out});
  const Json compared = comparison_json(*first, *second, {0, 1})["statuses"];
  const auto check = [&](Status status, long first_alone, long second_alone) {
    const Difference wanted = paired_share_difference(first_alone, second_alone, 5, 0.95);
    const Json& entry = compared[static_cast<std::size_t>(status)];
    CHECK(entry["status"] == to_string(status));
    CHECK(entry["difference"].get<double>() == Approx(wanted.value).margin(1e-12));
    CHECK(entry["lower"].get<double>() == Approx(*wanted.bounds.lower).epsilon(1e-4));
    CHECK(entry["upper"].get<double>() == Approx(*wanted.bounds.upper).epsilon(1e-4));
    CHECK(entry["runs"] == 5);
  };
  check(Status::deployed, 1, 2);
  check(Status::stalled, 2, 0);
  check(Status::timed_out, 0, 1);
  check(Status::failed, 0, 0);
}

TEST_CASE("differences have the higher confidence of both sets, which interim analyses raise",
          "[page]") {
  const auto first = made(quick_campaign(30)), extended = made(quick_campaign(30));
  for (double& value : extended->results.outputs[0].values) value *= value;
  extended->confidence = 0.9875;
  for (const auto& [one, other] :
       {std::pair{&*first, &*extended}, std::pair{&*extended, &*first}}) {
    const Json compared = comparison_json(*one, *other, {0, 1});
    CHECK(compared["confidence"] == 0.9875);
    const Difference wanted = paired_difference(one->results.outputs[0], other->results.outputs[0],
                                                rows_from_0(30), one->replication, 0.9875);
    CHECK(compared["outputs"][0]["upper"].get<double>() ==
          Approx(*wanted.bounds.upper).epsilon(1e-4));
    CHECK(compared["statuses"][0]["upper"].get<double>() ==
          Approx(*paired_share_difference(0, 0, 30, 0.9875).bounds.upper).epsilon(1e-4));
  }
}

TEST_CASE("each further folder is compared with the first and with the one before it", "[page]") {
  std::vector<std::unique_ptr<PageSource>> sets;
  for (std::size_t folder = 0; folder < 4; ++folder) {
    sets.push_back(std::make_unique<PageSource>());
    sets.back()->argument = folder;
  }
  CHECK(pairs_of(sets).both ==
        std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {0, 2}, {1, 2}, {0, 3}, {2, 3}});
  for (const auto& set : sets) set->argument = 0; // cases of one folder
  CHECK(pairs_of(sets).both ==
        std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {0, 2}, {1, 2}, {0, 3}, {2, 3}});
}
