#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/results/summary/overtravel.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/table.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <numbers>

using namespace wingspread;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// Four runs of the small wing: root is thrown back in three of them, one by just what is allowed.
Results some_overtravel() {
  Results results(ResultNames{{}, {"root.overtravel", "mid.overtravel", "deployment_time"}});
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  for (const double root : {40 * degree, most_overtravel, 2 * degree, unknown})
    results.append({std::ssize(results.runs), Status::deployed, {}, {root, 0, 1}, "root", ""});
  return results;
}

} // namespace

TEST_CASE("hinges without a stop that turn through their stowed angle are found") {
  const Scene scene = read_scene(test::small_scene());
  const std::vector<Overtravel> found = overtravels(scene, some_overtravel());
  REQUIRE(found.size() == 1);
  CHECK(found[0].hinge == "root");
  CHECK(found[0].runs == 2);
  CHECK(found[0].largest == 40 * degree);
  CHECK(warning(found[0], 4) == "in 2 of 4 runs root turns up to 40 deg backwards, beyond its "
                                "stowed angle (overtravel); it has no stop");
}

TEST_CASE("a hinge with a stop is not warned of, nor one whose overtravel is not recorded") {
  Scene scene = read_scene(test::small_scene());
  CHECK(overtravels(scene, Results(ResultNames{{}, {"deployment_time"}})).empty());
  scene.hinges[0].stop = Stop{100, 0, 0};
  CHECK(overtravels(scene, some_overtravel()).empty());
}

TEST_CASE("one run's overtravel is warned of") {
  Scene scene = read_scene(test::small_scene());
  Outcome outcome;
  CHECK(overtravels(scene, outcome).empty()); // not watched
  outcome.overtravel = {0.5 * degree, 31.44 * degree};
  const std::vector<Overtravel> found = overtravels(scene, outcome);
  REQUIRE(found.size() == 1);
  CHECK(warning(found[0]) ==
        "mid turns up to 31.4 deg backwards, beyond its stowed angle (overtravel); it has no stop");
  scene.hinges[1].stop = Stop{};
  CHECK(overtravels(scene, outcome).empty());
}

TEST_CASE("the table and summary.json warn of overtravel, where there is any") {
  const Results results = some_overtravel();
  Summary summary = summarize(results, {});
  CHECK(summary_table(summary, "t", "").find("WARNING") == std::string::npos);
  CHECK_FALSE(summary_json(summary, nullptr).contains("warnings"));
  summary.overtravels = overtravels(read_scene(test::small_scene()), results);
  const std::string text = "in 2 of 4 runs root turns up to 40 deg backwards, beyond its stowed "
                           "angle (overtravel); it has no stop";
  CHECK_THAT(summary_table(summary, "t", ""),
             Catch::Contains("\nWARNING\n  " + wrapped(text, 2) + "\n"));
  CHECK(summary_json(summary, nullptr)["warnings"] == Json::array({text}));
}
