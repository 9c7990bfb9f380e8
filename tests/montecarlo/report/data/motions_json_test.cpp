#include "montecarlo/report/data/motions_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/results/results_folder/replay.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <functional>
#include <map>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Rows that no one ran, of a campaign with every output: deployment time, root's moment and status of each.
struct Invented {
  Status status;
  double time, moment;
};

std::unique_ptr<PageSource> invented(const Json& json, const std::vector<Invented>& rows) {
  const Campaign campaign = campaign_of(json);
  Results results(RunPlan(campaign).names());
  long run = 0;
  for (const Invented& each : rows) {
    ResultRow row{
        run++,
        each.status,
        std::vector<double>(results.draws.size(), 1.0),
        std::vector<double>(results.outputs.size(), each.status == Status::failed ? nothing : 1.0),
        "root",
        "",
        PeaksFinal::yes};
    for (std::size_t i = 0; i < results.outputs.size(); ++i) {
      if (results.outputs[i].name == "root.peak_moment") row.outputs[i] = each.moment;
      if (results.outputs[i].name == "deployment_time") row.outputs[i] = each.time;
    }
    results.append(row);
  }
  return source_of(campaign, std::move(results));
}

std::vector<std::pair<std::string, long>> names_of(const std::vector<ChosenRun>& runs) {
  std::vector<std::pair<std::string, long>> names;
  for (const ChosenRun& each : runs) names.emplace_back(each.label, each.run);
  return names;
}

const std::vector<Invented> six{
    {Status::deployed, 5, 10},          {Status::deployed, 4, 30},
    {Status::deployed, 6, 20},          {Status::stalled, nothing, 5},
    {Status::failed, nothing, nothing}, {Status::timed_out, nothing, 6}};

} // namespace

TEST_CASE("the runs worth seeing, by hand", "[page]") {
  Json json = full_campaign(6);
  json["requirements"] = parse_json(R"([
    { "name": "S-1", "output": "root.peak_moment", "max": 100, "probability": 0.2, "confidence": 0.5 },
    { "output": "deployed", "probability": 0.2, "confidence": 0.5 } ])");
  const auto source = invented(json, six);
  const auto chosen = chosen_runs(*source);
  // the median of 4, 5, 6; no deployed run is above 100, and 30 is the nearest
  CHECK(names_of(chosen) == std::vector<std::pair<std::string, long>>{{"median run", 0},
                                                                      {"worst: S-1", 1},
                                                                      {"worst: deployed", 3},
                                                                      {"timed out", 5},
                                                                      {"failed", 4}});
}

TEST_CASE("where nothing breaks a requirement its worst run is the nearest to the limit",
          "[page]") {
  Json json = full_campaign(3);
  json["requirements"] = parse_json(R"([
    { "output": "root.peak_moment", "max": 100, "probability": 0.2, "confidence": 0.5 },
    { "output": "deployment_time", "min": 1, "probability": 0.2, "confidence": 0.5 } ])");
  const std::vector<Invented> runs{
      {Status::deployed, 5, 10}, {Status::deployed, 6, 30}, {Status::deployed, 4, 20}};
  const auto chosen = chosen_runs(*invented(json, runs));
  CHECK(names_of(chosen) ==
        std::vector<std::pair<std::string, long>>{
            {"median run", 0}, {"worst: root.peak_moment", 1}, {"worst: deployment_time", 2}});
  CHECK(chosen[1].why == "nearest to the limit");
  json["requirements"][0]["max"] = 25;
  CHECK(chosen_runs(*invented(json, runs))[1].why == "farthest beyond the limit");
}

TEST_CASE("without requirements the largest peaks stand for the worst", "[page]") {
  const auto chosen = chosen_runs(
      *invented(full_campaign(3),
                {{Status::deployed, 5, 10}, {Status::deployed, 6, 30}, {Status::deployed, 4, 20}}));
  REQUIRE(chosen.size() == 2);
  CHECK(chosen[1].label == "largest root.peak_moment");
  CHECK(chosen[1].run == 1); // which has the largest time too, once
  const auto failed = chosen_runs(*invented(
      full_campaign(2), {{Status::failed, nothing, nothing}, {Status::failed, nothing, nothing}}));
  REQUIRE(failed.size() == 1);
  CHECK(failed[0].label == "failed");
  CHECK(failed[0].run == 0);
}

TEST_CASE("without rows the largest peaks are those that the statistics keep, with their runs",
          "[page]") {
  const auto rowless = [](const std::vector<Invented>& rows) {
    auto source = invented(full_campaign(static_cast<int>(rows.size())), rows);
    const ResultNames names = RunPlan(source->stored.campaign).names();
    source->streaming =
        std::make_unique<StreamingStatistics>(source->stored.campaign, names, source->results);
    for (std::size_t row = 0; row < rows.size(); ++row)
      (void)source->streaming->add(source->results.row(row), {});
    source->results = Results(names); // of a campaign without requirements none is kept
    return names_of(chosen_runs(*source));
  };
  CHECK(
      rowless({{Status::deployed, 5, 10}, {Status::deployed, 4, 30}, {Status::deployed, 6, 20}}) ==
      std::vector<std::pair<std::string, long>>{{"largest root.peak_moment", 1},
                                                {"largest root.peak_force", 0},
                                                {"largest deployment_time", 2}});
  CHECK(rowless({{Status::failed, nothing, nothing}, {Status::failed, nothing, nothing}}).empty());
}

TEST_CASE("motions are the runs made again, and the same on any number of threads", "[page]") {
  const auto source = made(quick_campaign(20));
  const Json motions = motions_json(*source, {}, 1);
  CHECK(motions == motions_json(*source, {}, 2));
  REQUIRE(motions.size() == 3); // nominal, median, slowest
  for (const std::size_t most : {1, 2, 3, 4}) {
    PageDetail detail;
    detail.motions = most;
    CHECK(motions_json(*source, detail, 1).size() == std::min<std::size_t>(most, 3));
  }
  CHECK(motions[0]["label"] == "nominal");
  CHECK(motions[0]["run"].is_null());
  for (const Json& motion : motions) {
    CAPTURE(motion["label"]);
    CHECK(motion["t"].size() <= 406);
    CHECK(motion["angles"].size() == 3);
    for (const char* key : {"angles", "rates", "moments"})
      for (const Json& hinge : motion[key]) CHECK(hinge.size() == motion["t"].size());
    CHECK(motion["base"].is_null());
    for (const Json& latch : motion["latches"])
      CHECK(std::ranges::count(motion["t"], latch["time"]) == 2);
  }
  const long run = motions[1]["run"];
  CHECK(motions[1]["replay"] == "wingspread replay results/set --run " + std::to_string(run));
  const double recorded = source->results.outputs[0].values[static_cast<std::size_t>(run)];
  CHECK(source->results.outputs[0].name == "root.latch_time");
  const auto root = std::ranges::find(motions[1]["latches"], 0,
                                      [](const Json& latch) { return latch["hinge"].get<int>(); });
  CHECK((*root)["time"] == rounded(recorded));
  source->stored.foreign = true;
  CHECK(motions_json(*source, {}, 1).empty());
}

TEST_CASE("a motion is drawn until its ring is over, though a proof ended the run", "[page]") {
  Json json = quick_campaign(4);
  json["outputs"] = {"latch_time", "peak_moment"};
  const Json nominal = motions_json(*made(json), {}, 1)[0];
  const double last = nominal["latches"].back()["time"], end = nominal["t"].back();
  CHECK(end > last);
  CHECK(end < 20);
  double largest = 0, left = 0; // swing after the last latch, and in the last tenth of that time
  for (const Json& hinge : nominal["moments"]) {
    std::array<double, 2> all{1e9, -1e9}, late = all;
    for (std::size_t i = 0; i < hinge.size(); ++i) {
      const double t = nominal["t"][i], moment = hinge[i];
      if (t > last) all = {std::min(all[0], moment), std::max(all[1], moment)};
      if (t > end - 0.1 * (end - last))
        late = {std::min(late[0], moment), std::max(late[1], moment)};
    }
    largest = std::max(largest, all[1] - all[0]);
    left = std::max(left, (late[1] - late[0]) / (all[1] - all[0]));
  }
  CHECK(largest > 0);
  CHECK(left <= 0.05);
}

TEST_CASE("a motion has the base's path beside those of the hinges, each in its own column",
          "[page]") {
  Json json = quick_campaign(1);
  json["scene"]["base"] = parse_json(R"({ "motion": "free", "mass": 60, "inertia": 20 })");
  const auto source = made(json);
  const Json motion = motions_json(*source, {}, 1)[0];
  Goal goal = goal_of(source->stored.campaign.outputs);
  goal.to_t_end = true;
  std::vector<Sample> samples;
  (void)Deployment().run(nominal_scene(source->stored.campaign),
                         source->stored.campaign.integration, goal,
                         [&](const Sample& sample) { samples.push_back(sample); });
  const auto times = motion["t"].get<std::vector<double>>();
  struct Column {
    const Json& values;
    std::function<double(const Sample&)> of;
    double swing; ///< at least: it tells the columns apart
  };
  const std::vector<Column> columns{
      {motion["base"]["x"], [](const Sample& one) { return one.base_position.x(); }, 0.05},
      {motion["base"]["y"], [](const Sample& one) { return one.base_position.y(); }, 0.05},
      {motion["base"]["angle"], [](const Sample& one) { return one.base_angle; }, 0.05},
      {motion["angles"][0], [](const Sample& one) { return one.angles[0]; }, 1},
      {motion["angles"][2], [](const Sample& one) { return one.angles[2]; }, 1},
      {motion["rates"][1], [](const Sample& one) { return one.rates[1]; }, 0.1}};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    double least = 1e9, most = -1e9;
    for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
      const auto at = std::ranges::find(times, rounded(samples[k].t));
      if (at == times.end() || samples[k + 1].t == samples[k].t || // both sides of a latch
          (k > 0 && samples[k - 1].t == samples[k].t))
        continue;
      const double value = columns[c].values[static_cast<std::size_t>(at - times.begin())];
      CAPTURE(c, samples[k].t);
      CHECK(value == Approx(columns[c].of(samples[k])).margin(1e-3));
      least = std::min(least, value), most = std::max(most, value);
    }
    CHECK(most - least > columns[c].swing);
  }
}

TEST_CASE("a run of each status that some run has is shown, however many requirements there are",
          "[page]") {
  std::mt19937_64 random(8);
  const std::vector<std::string> outputs{"root.peak_moment", "mid.peak_moment", "tip.peak_moment",
                                         "root.latch_time",  "mid.latch_time",  "tip.latch_time",
                                         "root.peak_force",  "mid.peak_force",  "tip.peak_force"};
  for (int k = 0; k < 15; ++k) {
    Json json = full_campaign(60);
    json["requirements"] = Json::array();
    const std::size_t requirements = random() % (outputs.size() + 1);
    for (std::size_t i = 0; i < requirements; ++i)
      json["requirements"].push_back(
          {{"output", outputs[i]}, {"max", 2}, {"probability", 0.2}, {"confidence", 0.5}});
    const Campaign campaign = campaign_of(json);
    Results results(RunPlan(campaign).names());
    std::map<Status, long> seen;
    for (long run = 0; run < 60; ++run) {
      const std::array some{Status::stalled, Status::timed_out, Status::failed};
      const Status status = run < 50 ? Status::deployed : some[random() % some.size()];
      ResultRow row{run, status,         std::vector<double>(results.draws.size(), 1.0), {}, "root",
                    "",  PeaksFinal::yes};
      for (std::size_t i = 0; i < results.outputs.size(); ++i)
        row.outputs.push_back(status == Status::deployed ? uniform(random) : nothing);
      results.append(row);
      ++seen[status];
    }
    const auto source = source_of(campaign, std::move(results));
    const std::size_t most = 4 + random() % 9;
    CAPTURE(requirements, most);
    const auto chosen = chosen_runs(*source, most);
    CHECK(chosen.size() <= most);
    std::map<Status, long> shown;
    for (const ChosenRun& each : chosen)
      ++shown[source->results.status[static_cast<std::size_t>(each.run)]];
    for (const auto& [status, count] : seen) CHECK(shown[status] > 0);
  }
}
