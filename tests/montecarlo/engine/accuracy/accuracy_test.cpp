#include "montecarlo/engine/accuracy/accuracy.hpp"
#include "montecarlo/engine/accuracy/drawn_runs.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/sample_support.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

ResultRow row_of(long run, std::vector<double> outputs, Status status = Status::deployed,
                 const char* order = "a>b") {
  return {run, status, {}, std::move(outputs), order, "", {}};
}

/// The seed scene with the tip's spring scaled by a number, and nothing else varied.
Campaign with_tip_spring(double scale, double rtol) {
  Json json = quick_campaign(10);
  json["dispersions"] = Json::array(
      {{{"name", "tip_spring"},
        {"distribution", {{"type", "constant"}, {"value", scale}}},
        {"apply", "scale"},
        {"to", {"hinges.tip.spring.torque_stowed", "hinges.tip.spring.torque_latched"}}}});
  json["integration"] = {{"rtol", rtol}, {"atol", rtol / 100}, {"t_end", 20}};
  return campaign_of(json);
}

std::string order_at(double scale, double rtol) {
  const Campaign campaign = with_tip_spring(scale, rtol);
  return Runner(RunPlan(campaign)).run(0).latch_order;
}

/// Where the order of latching changes, as a tolerance sees it, by bisection to round-off.
double edge_at(double rtol, double low, double high) {
  const std::string there = order_at(low, rtol);
  REQUIRE(order_at(high, rtol) != there);
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (order_at(middle, rtol) == there ? low : high) = middle;
  }
  return (low + high) / 2;
}

} // namespace

TEST_CASE("errors of rows against their reference, by hand", "[accuracy]") {
  const ResultNames names{{}, {"a", "b", "never", "same"}};
  const std::vector<ResultRow> rows{row_of(2, {1.003, none, none, 5}), row_of(3, {2.5, 7, none, 5}),
                                    row_of(5, {9, 9, none, 9}),        row_of(6, {9, 9, none, 9}),
                                    row_of(8, {9, none, none, 9}),     row_of(9, {9, 9, none, 9})};
  const std::vector<ResultRow> reference{
      row_of(2, {1, none, none, 5}),
      row_of(3, {2.504, 7.25, none, 5}),
      row_of(5, {1, 1, none, 1}, Status::stalled),
      row_of(6, {1, 1, none, 1}, Status::deployed, "b>a"),
      row_of(8, {9, 1, none, 9}), // b happened in one of them alone
      row_of(9, {9, 9, none, 9}, Status::failed)};
  const Accuracy found = compare_rows(names, rows, reference, {});
  CHECK(found.runs == 5);
  CHECK(found.unreached == 1);
  CHECK(found.in_doubt == std::vector<long>{5, 6, 8});
  REQUIRE(found.outputs.size() == 4);
  CHECK(found.outputs[0].output == "a");
  CHECK(found.outputs[0].runs == 2);
  // 3e-3 and 4e-3, as far as 17 digits of 1.003 and 2.504 hold them.
  CHECK(found.outputs[0].largest == Approx(4e-3).epsilon(1e-12));
  CHECK(found.outputs[0].rms == Approx(std::sqrt(12.5) * 1e-3).epsilon(1e-12));
  CHECK(found.outputs[1].runs == 1);
  CHECK(found.outputs[1].largest == 0.25);
  CHECK(found.outputs[1].rms == 0.25);
  CHECK(found.outputs[2].runs == 0);
  CHECK(std::isnan(found.outputs[2].largest));
  CHECK(std::isnan(found.outputs[2].rms));
  CHECK(found.outputs[3].largest == 0);
  CHECK(found.outputs[3].rms == 0);
}

TEST_CASE("a reference is another method, a hundred times tighter where that can be had",
          "[accuracy]") {
  const auto [method, rtol, atol, explicit_method, explicit_rtol, implicit_method, implicit_rtol] =
      GENERATE(table<const char*, double, double, const char*, double, const char*, double>(
          {{"auto", 1e-8, 1e-10, "dopri5", 1e-10, "seulex", 1e-10},
           {"auto", 1e-4, 1e-5, "dopri5", 1e-8, "seulex", 1e-8},
           {"dopri5", 1e-9, 1e-11, "dop853", 1e-11, "seulex", 1e-11},
           {"seulex", 1e-11, 1e-13, "dopri5", 1e-13, "auto", 1e-12},
           {"auto", 1e-14, 1e-16, "dopri5", 1e-14, "seulex", 1e-14}}));
  Integration own;
  own.method = method, own.rtol = rtol, own.atol = atol, own.t_end = 17;
  const std::vector<Integration> references = references_of(own);
  REQUIRE(references.size() == 2);
  CHECK(references[0].method == explicit_method);
  CHECK(references[0].rtol == explicit_rtol); // exactly: a decimal of few digits
  CHECK(references[1].method == implicit_method);
  CHECK(references[1].rtol == implicit_rtol);
  for (const Integration& each : references) {
    CHECK(each.atol / each.rtol == Approx(atol / rtol).epsilon(1e-14));
    CHECK(each.t_end == 17);
  }
}

TEST_CASE("1 % of the runs is made again, from 10 to 100, or what the campaign says",
          "[accuracy]") {
  Campaign campaign;
  for (const auto& [runs, repeated] :
       std::vector<std::pair<std::size_t, std::size_t>>{{0, 0},
                                                        {1, 1},
                                                        {21, 3},
                                                        {100, 10},
                                                        {1000, 10},
                                                        {1001, 11},
                                                        {10'000, 100},
                                                        {1'000'000, 100}})
    CHECK(count_repeated(campaign, runs) == repeated);
  campaign.statistics.accuracy_runs = 300;
  CHECK(count_repeated(campaign, 10'000) == 300);
  CHECK(count_repeated(campaign, 200) == 200);
  campaign.statistics.accuracy_runs = 0;
  CHECK(count_repeated(campaign, 10'000) == 0);
}

TEST_CASE("an output moves by more than 1 %, unless the tolerance takes it for zero",
          "[accuracy]") {
  CHECK(moved(100, 102, 0));
  CHECK(moved(-1e-3, 1e-3, 0));
  CHECK_FALSE(moved(100, 100.9, 0));
  CHECK_FALSE(moved(0, 0, 0));
  CHECK_FALSE(moved(1e-12, 3e-12, 1e-10));
  CHECK_FALSE(moved(none, none, 0));
  Integration integration;
  integration.atol = 1e-9;
  CHECK(unresolved("root.overtravel", integration) == 1e-9);
  CHECK(unresolved("root.latch_rate", integration) == 1e-9);
  CHECK(unresolved("root.peak_moment", integration) == 0);
  integration.rtol = 1e-6;
  const ResultNames names{{}, {"a.peak_moment", "b.overtravel"}};
  // Run 2: the moment moves. Run 3: a difference below rtol times the largest moment. Run 4: an overtravel of nothing.
  const std::vector<ResultRow> rows{row_of(1, {100, 1}), row_of(2, {50, 1}), row_of(3, {1e-6, 1}),
                                    row_of(4, {100, 1e-12})};
  const std::vector<ResultRow> reference{row_of(1, {100, 1}), row_of(2, {51, 1}),
                                         row_of(3, {2e-6, 1}), row_of(4, {100, 0})};
  const Accuracy found = compare_rows(names, rows, reference, integration);
  CHECK(found.moved == std::vector<long>{2});
  CHECK(found.moved_outputs == std::vector<std::string>{"a.peak_moment"});
}

TEST_CASE("the share of runs beyond is Clopper and Pearson's, with what is unknown beyond",
          "[accuracy]") {
  Accuracy accuracy;
  accuracy.runs = 100;
  CHECK(share_at_most(accuracy, 0, 0.95) == Approx(1 - std::pow(0.05, 0.01)).epsilon(1e-12));
  accuracy.runs = 999, accuracy.unreached = 1, accuracy.in_doubt = {7};
  // 3 of 1000 at 97.5 % one-sided, by the table of Clopper and Pearson's interval at 95 %.
  CHECK(share_at_most(accuracy, 1, 0.975) == Approx(0.00874202).epsilon(1e-6));
}

TEST_CASE("a loose campaign's errors are those that an independent oracle finds", "[accuracy]") {
  Json json = quick_campaign(30);
  json["outputs"] = {"latch_time", "latch_rate"};
  json["integration"] = {{"rtol", 1e-4}, {"atol", 1e-6}, {"t_end", 20}};
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  const Results results = rows_of(plan, {0, 30});
  const auto found = measure_accuracy(campaign, results, {.threads = 1});
  REQUIRE(found);
  CHECK(found->method == "auto");
  CHECK(found->rtol == 1e-4);
  CHECK(found->reference_method == "dopri5");
  CHECK(found->reference_rtol == 1e-8);
  const std::vector<std::size_t> rows = drawn_rows(results, campaign.sampling.seed, 3);
  REQUIRE(found->runs == 3);
  REQUIRE(found->in_doubt.empty());
  std::vector<double> squares(plan.names().outputs.size(), 0);
  Scene scene = campaign.scene;
  for (const std::size_t row : rows) {
    apply(campaign, results.row(row).draws, campaign.scene, scene);
    oracle::ReferenceOptions options;
    options.rtol = 1e-13, options.atol = 1e-15;                // errors are of 1e-7
    options.t_end = results.outputs.back().values[row] + 0.01; // its deployment_time
    const auto truth = oracle::high_precision_run<long double>(scene, options);
    for (const auto& latch : truth.latches) {
      const auto hinge = static_cast<std::size_t>(latch.hinge);
      const std::string& name = scene.hinges[hinge].name;
      for (std::size_t i = 0; i < squares.size(); ++i) {
        const double own = results.outputs[i].values[row];
        if (plan.names().outputs[i] == name + ".latch_time")
          squares[i] += std::pow(own - latch.time, 2);
        if (plan.names().outputs[i] == name + ".latch_rate")
          squares[i] += std::pow(own - latch.rates[hinge], 2);
      }
    }
  }
  int compared = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (squares[i] == 0) continue;
    // The reference is ten thousand times tighter than the campaign: its own error is some 1 % of theirs.
    CHECK(found->outputs[i].rms == Approx(std::sqrt(squares[i] / 3)).epsilon(3e-2));
    CHECK(found->outputs[i].rms > 1e-9);
    ++compared;
  }
  CHECK(compared == 6);
}

TEST_CASE("runs whose latch order the tolerance decides are in doubt", "[accuracy]") {
  const double loose = edge_at(1e-3, 1.3, 1.5), tight = edge_at(1e-12, 1.3, 1.5);
  CAPTURE(loose, tight);
  REQUIRE(std::abs(loose - tight) > 1e-12);
  const auto doubts = [](double scale) {
    const Campaign campaign = with_tip_spring(scale, 1e-3);
    const auto found =
        measure_accuracy(campaign, rows_of(RunPlan(campaign), {0, 10}), {.threads = 1});
    REQUIRE(found);
    REQUIRE(found->runs == 1);
    if (found->in_doubt.empty())
      CHECK(found->outputs[0].runs == 1);
    else
      CHECK(found->outputs[0].runs == 0); // such a run has no error
    return found->in_doubt.size();
  };
  CHECK(doubts((loose + tight) / 2) == 1);
  CHECK(doubts(tight + 100 * (tight - loose)) == 0);
  CHECK(doubts(loose + 100 * (loose - tight)) == 0);
}

TEST_CASE("latches too stiff for an explicit method have an implicit reference", "[accuracy]") {
  Json json = quick_campaign(12);
  for (Json& hinge : json["scene"]["hinges"])
    hinge["latch"] = {{"stiffness", 1e9}, {"damping", 1e6}};
  json["outputs"] = {"latch_time", "latch_rate", "peak_moment"};
  json["integration"] = {{"rtol", 1e-5}, {"atol", 1e-7}, {"t_end", 20}};
  const Campaign campaign = campaign_of(json);
  const auto found =
      measure_accuracy(campaign, rows_of(RunPlan(campaign), {0, 12}), {.threads = 1});
  REQUIRE(found);
  CHECK(found->reference_method == "seulex");
  CHECK(found->runs == 2);
}

// A stiff latch takes dopri5 more steps than the least limit, fewer than 100 times those of the run's own method.
TEST_CASE("the first and the middle run decide how many steps a reference may take", "[accuracy]") {
  constexpr double soft = 1e4, stiff = 1e7;
  Json json = quick_campaign(40);
  json["dispersions"] = Json::array(
      {{{"name", "latch"},
        {"distribution", {{"type", "discrete"}, {"values", {soft, stiff}}, {"weights", {1, 1}}}},
        {"apply", "set"},
        {"to",
         {"hinges.root.latch.stiffness", "hinges.mid.latch.stiffness",
          "hinges.tip.latch.stiffness"}}}});
  json["outputs"] = {"latch_time", "peak_moment"};
  const Campaign campaign = campaign_of(json);
  const Results results = rows_of(RunPlan(campaign), {0, 40});
  /// The first runs whose latches are so, in this order.
  const auto accuracy_of = [&](const std::vector<double>& latches) {
    std::vector<ResultRow> rows;
    for (std::size_t i = 0; i < results.size() && rows.size() < latches.size(); ++i)
      if (results.row(i).draws.front() == latches[rows.size()]) rows.push_back(results.row(i));
    REQUIRE(rows.size() == latches.size());
    return compare_with_reference(campaign, rows, {.threads = 1});
  };
  for (const auto& latches : {std::vector{stiff}, std::vector{stiff, soft, soft, soft},
                              std::vector{soft, soft, stiff, soft}}) {
    const Accuracy found = accuracy_of(latches);
    CHECK(found.reference_method == "dopri5");
    CHECK(found.runs == std::ssize(latches));
    CHECK(found.unreached == 0);
  }
  for (const auto& latches :
       {std::vector{soft, stiff, soft, soft}, std::vector{soft, soft, soft, stiff}}) {
    const Accuracy found = accuracy_of(latches);
    CHECK(found.reference_method == "dopri5");
    CHECK(found.unreached == 1);
  }
}

TEST_CASE("a run that no reference finishes does not hide the errors of the others", "[accuracy]") {
  Json json = quick_campaign(40);
  json["dispersions"] = Json::array(
      {{{"name", "latch"},
        {"distribution", {{"type", "discrete"}, {"values", {1e4, 1e300}}, {"weights", {1, 1}}}},
        {"apply", "set"},
        {"to", {"hinges.root.latch.stiffness"}}}});
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  std::vector<ResultRow> usable, hopeless;
  for (long run = 0; run < 40; ++run) {
    ResultRow row = Runner(plan).run(run);
    (row.status == Status::failed ? hopeless : usable).push_back(std::move(row));
  }
  REQUIRE((usable.size() > 9 && hopeless.size() > 9));
  const auto first_hopeless = std::ranges::find_if(
      hopeless, [&](const ResultRow& row) { return row.run < usable.back().run; });
  REQUIRE(first_hopeless != hopeless.end());
  std::vector<ResultRow> rows{*first_hopeless};
  std::ranges::copy_if(usable, std::back_inserter(rows),
                       [&](const ResultRow& row) { return row.run > rows.front().run; });
  const Accuracy found = compare_with_reference(campaign, rows, {.threads = 1});
  CHECK(found.reference_method == "dopri5");
  CHECK(found.unreached == 1);
  CHECK(found.runs == std::ssize(rows) - 1);
  const Accuracy none_finished = compare_with_reference(campaign, hopeless, {.threads = 1});
  CHECK(none_finished.runs == 0);
  CHECK(none_finished.unreached == std::min<long>(16, std::ssize(hopeless)));
}

TEST_CASE("there is no accuracy where none is wanted, or nothing to be made again", "[accuracy]") {
  Campaign campaign = campaign_of(quick_campaign(30));
  const Results results = rows_of(RunPlan(campaign), {0, 30});
  CHECK(measure_accuracy(campaign, results, {.threads = 1}));
  campaign.statistics.accuracy_runs = 0;
  CHECK_FALSE(measure_accuracy(campaign, results, {.threads = 1}));
  campaign.statistics.accuracy_runs.reset();
  CHECK_FALSE(measure_accuracy(campaign, Results(RunPlan(campaign).names()), {.threads = 1}));
}

TEST_CASE("accuracy does not depend on threads and lanes", "[accuracy][parallel]") {
  const Campaign campaign = campaign_of(full_campaign(60));
  const Results results = rows_of(RunPlan(campaign), {0, 60});
  const auto one = measure_accuracy(campaign, results, {1, instruction_sets().front()});
  const auto two = measure_accuracy(campaign, results, {.threads = 2});
  REQUIRE((one && two));
  CHECK(one->in_doubt == two->in_doubt);
  CHECK(one->runs == two->runs);
  for (std::size_t i = 0; i < one->outputs.size(); ++i) {
    CHECK(one->outputs[i].runs == two->outputs[i].runs);
    if (one->outputs[i].runs > 0) CHECK(one->outputs[i].rms == two->outputs[i].rms);
  }
}
