#include "montecarlo/analyses/fit/fit_folder.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/results/checkpoint/study_folder.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

FitSpec timer_spec(const Campaign& campaign, long samples = 300) {
  Json tests = parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 2.3, "std": "10 ms" } ] } ],
    "fit": { "parameters": ["spring"], "samples": 300, "starts": 2 } })");
  tests["fit"]["samples"] = samples;
  return read_fit(tests, "", ".", campaign);
}

/// Fits into a folder. @param stop_after diagnoses of the chains; −1: never. @return whether it was stopped
bool fit_into(const std::filesystem::path& path, const Campaign& campaign, const FitSpec& spec,
              bool resume = false, int stop_after = -1, long most_runs = 0) {
  FitFolder folder(path, about_fit(campaign, spec), resume);
  if (folder.is_finished()) return false;
  FitOptions options;
  options.pool.threads = 1;
  options.most_runs = most_runs;
  std::atomic<bool> stop = false;
  const auto told = [&](const EnsembleState&) {
    if (stop_after-- == 0) stop = true;
  };
  try {
    FitResult result = fit_campaign(campaign, spec, options, stop, &folder.log(), told);
    folder.write(result, campaign, spec, options.pool, stop);
  } catch (const Stopped&) {
    return true;
  }
  return false;
}

} // namespace

TEST_CASE("a fit's folder, interrupted and resumed, has the same bytes") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign(0.01));
  const FitSpec spec = timer_spec(campaign);
  CHECK_FALSE(fit_into(folder.path() / "whole", campaign, spec));
  CHECK(fit_into(folder.path() / "parts", campaign, spec, false, 0));
  CHECK(std::filesystem::exists(folder.path() / "parts" / checkpoint_file));
  CHECK(message_of([&] {
          return fit_into(folder.path() / "parts", campaign, spec);
        }).find("an interrupted study") != std::string::npos);
  const FitSpec other = timer_spec(campaign, 301);
  CHECK_FALSE(
      message_of([&] { return fit_into(folder.path() / "parts", campaign, other, true); }).empty());
  CHECK_FALSE(fit_into(folder.path() / "parts", campaign, spec, true));
  CHECK(contents(folder.path() / "whole") == contents(folder.path() / "parts"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "parts" / checkpoint_file));
}

TEST_CASE("unfinished chains are kept, and go on with more runs") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign(0.01));
  const FitSpec spec = timer_spec(campaign, 3000);
  const auto path = folder.path() / "long";
  CHECK_FALSE(fit_into(path, campaign, spec, false, -1, 100));
  CHECK(parse_json_file(path / fit_json_file)["finished"] == false);
  CHECK(std::filesystem::exists(path / checkpoint_file));
  CHECK_FALSE(fit_into(path, campaign, spec, true));
  CHECK(parse_json_file(path / fit_json_file)["finished"] == true);
  CHECK_FALSE(fit_into(folder.path() / "whole", campaign, spec));
  CHECK(contents(folder.path() / "whole") == contents(path));
}

TEST_CASE("the written campaign draws rows of the posterior and predicts what the test has shown") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign(0.05));
  const FitSpec spec = timer_spec(campaign);
  CHECK_FALSE(fit_into(folder.path() / "fit", campaign, spec));
  const Campaign after = read_campaign_file(folder.path() / "fit" / campaign_file);
  REQUIRE(after.dispersions.size() == 2);
  CHECK(after.dispersions[0].name == "spring");
  CHECK(after.dispersions[0].rows == "fitted");
  CHECK(after.dispersions[1].name == "friction"); // not fitted: still dispersed
  CHECK(after.dispersions[1].rows.empty());
  const Json json = parse_json_file(folder.path() / "fit" / fit_json_file);
  const Json& predicted = json["prediction"]["root.latch_time"];
  const double before = predicted["before"][2].get<double>() - predicted["before"][0].get<double>();
  const double width = predicted["after"][2].get<double>() - predicted["after"][0].get<double>();
  CHECK(width < 0.95 * before);
  CHECK(json["tests"][0]["values"]["root.latch_time"]["measured"] == 2.3);
  CHECK(json["correlation"]["spring"]["spring"] == 1);
}

TEST_CASE(
    "a prediction states who deploys, and its quantiles are over all runs as those of a campaign") {
  Json json = panel_campaign(0.3); // of the prior one in five is slower than t_end
  json["integration"]["t_end"] = 2.6;
  const Campaign before = campaign_of(json);
  json["dispersions"][0]["distribution"]["std"] = 0.01; // all are faster
  const FitPrediction prediction = predict(before, campaign_of(json), {.threads = 1}, never);
  const double least = (2 * panel_travel * panel_inertia / (2.6 * 2.6) + 0.3) /
                       panel_torque; // spring that latches in time
  const double share = 1 - std::erfc((1 - least) / 0.3 / std::sqrt(2.0)) /
                               2; // friction varies too: it widens little
  CHECK(prediction.deployed[0] == Approx(share).margin(0.05));
  CHECK(prediction.deployed[0] < 0.95);
  CHECK(prediction.deployed[1] == 1);
  const auto found =
      std::ranges::find(prediction.outputs, "root.latch_time", &PredictedOutput::name);
  REQUIRE(found != prediction.outputs.end());
  const PredictedOutput& time = *found;
  CHECK(std::isnan(time.before[2])); // fewer than 95 % latch
  CHECK(time.before[1] ==
        Approx(panel_latch_time(1, 1)).epsilon(0.03)); // of all runs the middle one
  CHECK(time.after[2] > time.after[1]);
}

TEST_CASE("a prediction asks both campaigns why no peak is final: cut runs of both are counted") {
  Json json = panel_campaign(0.05);
  json["outputs"] = {"latch_time", "peak_moment"};
  json["scene"]["base"] = parse_json(R"({ "motion": "prescribed" })");
  const Campaign still = campaign_of(json);
  json["scene"]["base"]["angular_acceleration"] = 1e-4;
  const Campaign turned = campaign_of(json);
  const auto why = [](const Campaign& before, const Campaign& after) {
    return predict(before, after, {.threads = 1}, never).never_final;
  };
  CHECK(why(still, still).empty());
  CHECK(why(turned, turned) == "with a base that turns faster and faster");
  for (const auto& [before, after] : {std::pair(&still, &turned), {&turned, &still}})
    CHECK(why(*before, *after) == "for runs with a base that turns faster and faster");
}

TEST_CASE("a prediction has the runs of a whole design, however few or many the campaign has") {
  Json json = panel_campaign(0.3);
  json["sampling"]["design"] = "latin_hypercube";
  const auto medians = [&](long runs, long replicates) {
    json["sampling"]["runs"] = runs, json["sampling"]["replicates"] = replicates;
    const Campaign campaign = campaign_of(json);
    const FitPrediction all = predict(campaign, campaign, {.threads = 1}, never);
    CHECK(all.deployed[0] == all.deployed[1]);
    return all.outputs.at(0).before;
  };
  for (const long replicates : {1, 4}) {
    const auto whole = medians(predicted_runs, replicates);
    for (const long runs : {7, 100, 5000}) CHECK(medians(runs, replicates) == whole);
  }
}

// Of two campaigns a and b, the runs cut are cut(a) + cut(b), whichever comes first; quantiles change places.
TEST_CASE("a prediction counts the cut peaks of both campaigns, and has the quantiles of each") {
  Json json = panel_campaign(0.05);
  json["outputs"] = {"latch_time", "peak_moment"};
  json["integration"]["t_end"] = 2.3; // near the median of the latch time
  const Campaign a = campaign_of(json);
  json["integration"]["t_end"] = 2.36;
  const Campaign b = campaign_of(json);
  const auto predicted = [](const Campaign& before, const Campaign& after) {
    return predict(before, after, {.threads = 2}, never).outputs;
  };
  const auto same = [](const std::array<double, 3>& x, const std::array<double, 3>& y) {
    return std::ranges::equal(x, y, [](double one, double other) {
      return one == other || (std::isnan(one) && std::isnan(other));
    });
  };
  const auto both = predicted(a, b), swapped = predicted(b, a), first = predicted(a, a),
             second = predicted(b, b);
  REQUIRE(both.size() == first.size());
  bool differ = false;
  for (std::size_t k = 0; k < both.size(); ++k) {
    CAPTURE(both[k].name);
    CHECK(2 * both[k].cut == first[k].cut + second[k].cut);
    CHECK(both[k].cut == swapped[k].cut);
    CHECK((same(both[k].before, swapped[k].after) && same(both[k].after, swapped[k].before)));
    CHECK((same(both[k].before, first[k].after) && same(both[k].after, second[k].before)));
    differ = differ || first[k].cut != second[k].cut;
  }
  CHECK(differ);
}
