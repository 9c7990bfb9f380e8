#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

std::string spoilt_synchronisation(const test::Spoiled& change) {
  return test::message_of([&] { return read_scene(test::spoil(test::real_scene(), change)); });
}

} // namespace

TEST_CASE("Loops are read, with a ratio or a table", "[synchronisation]") {
  const Scene scene = read_scene(test::real_scene());
  REQUIRE(scene.synchronisations.size() == 2);
  const Synchronisation& loop = scene.synchronisations[0];
  CHECK(loop.name == "loop");
  CHECK(loop.first == 0);
  CHECK(loop.second == 1);
  CHECK(loop.ratio == 2);
  CHECK_FALSE(loop.table);
  CHECK(loop.stiffness == 300);
  CHECK(loop.damping == 0.5);
  CHECK(loop.preload == 8.0);
  const Synchronisation& cam = scene.synchronisations[1];
  CHECK(cam.first == 1);
  CHECK(cam.second == 0);
  REQUIRE(cam.table);
  CHECK(cam.travel == std::vector<double>{0, 1, 3});
  CHECK(cam.travel_of_second == std::vector<double>{0, 0.6, 1.5});
  CHECK(cam.table->knots() == cam.travel);
  CHECK(cam.table->pieces().back().c[0] == 1.5);
  CHECK(cam.table->pieces().back().c[1] > 0); // straight on beyond the end
  CHECK(cam.damping == 0);
  CHECK_FALSE(cam.preload);
}

TEST_CASE("A loop's numbers may have their units", "[synchronisation]") {
  const Scene scene = read_scene(test::spoil(
      test::real_scene(),
      {"/synchronisations/0",
       R"({ "name": "loop", "between": ["root", "mid"], "stiffness": "1 N*m/rad", "damping": "2 N*mm*s/rad",
            "preload": "1 in*lbf", "ratio": { "table": { "travel": [0, "90 deg"],
                                                         "travel_of_second": [0, "180 deg"] } } })",
       ""}));
  const Synchronisation& loop = scene.synchronisations[0];
  CHECK(loop.damping == 0.002);
  CHECK(loop.preload == 0.1129848290276167);
  CHECK(loop.travel == std::vector<double>{0, 1.5707963267948966});
  CHECK(loop.travel_of_second == std::vector<double>{0, 3.141592653589793});
}

TEST_CASE("Each fault of a loop is told", "[synchronisation]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"/synchronisations", "{}",
        "/synchronisations: found an object, expected an array of synchronisations"},
       {"/synchronisations/0", "1",
        "/synchronisations/0: found 1, expected a synchronisation: an object"},
       {"/synchronisations/0/name", "",
        "/synchronisations/0/name: found nothing, expected a string, the synchronisation's name"},
       {"/synchronisations/1/name", "\"loop\"",
        "/synchronisations/1/name: found string \"loop\", the name of /synchronisations/0 too, "
        "expected a name of its own"},
       {"/synchronisations/1/name", "\"a.b\"",
        "/synchronisations/1/name: found string \"a.b\", expected a name, not empty, without . * / "
        ", \" > and control characters"},
       {"/synchronisations/0/between", "",
        "/synchronisations/0/between: found nothing, expected an array of 2 hinges' names"},
       {"/synchronisations/0/between", "[\"root\"]",
        "/synchronisations/0/between: found an array of 1, expected an array of 2 hinges' names"},
       {"/synchronisations/0/between/0", "3",
        "/synchronisations/0/between/0: found 3, expected a string, a hinge's name"},
       {"/synchronisations/0/between/1", "\"midd\"",
        "/synchronisations/0/between/1: found string \"midd\", expected a hinge's name (did you "
        "mean \"mid\"?)"},
       {"/synchronisations/0/between/1", "\"root\"",
        "/synchronisations/0/between/1: found string \"root\" a second time, expected another "
        "hinge"},
       {"/synchronisations/0/ratio", "",
        "/synchronisations/0/ratio: found nothing, expected a number, not 0, or an object with a "
        "table of travel and travel_of_second"},
       {"/synchronisations/0/ratio", "\"2\"",
        "/synchronisations/0/ratio: found string \"2\", expected a number, not 0, or an object "
        "with a table of travel and travel_of_second"},
       {"/synchronisations/0/ratio", "0",
        "/synchronisations/0/ratio: found 0, expected a number, not 0"},
       {"/synchronisations/1/ratio", "{}",
        "/synchronisations/1/ratio/table: found nothing, expected a table: an object with travel "
        "and travel_of_second"},
       {"/synchronisations/1/ratio/table/travel", "[0]",
        "/synchronisations/1/ratio/table/travel: found an array of 1, expected an array of 2 to "
        "1000 numbers, rad"},
       {"/synchronisations/1/ratio/table/travel/2", "1",
        "/synchronisations/1/ratio/table/travel/2: found 1, expected more than 1, the travel "
        "before"},
       {"/synchronisations/1/ratio/table/travel_of_second", "[0, 1]",
        "/synchronisations/1/ratio/table/travel_of_second: found an array of 2, expected as many "
        "numbers as there are travels: 3"},
       {"/synchronisations/1/ratio/table/travel", "[0, 1e-320, 1]",
        "/synchronisations/1/ratio/table: found a curve too steep for numbers, expected travels "
        "further apart"},
       {"/synchronisations/1/ratio/tabel", "1",
        "/synchronisations/1/ratio/tabel: found the unknown key \"tabel\", expected \"table\" (did "
        "you mean \"table\"?)"},
       {"/synchronisations/0/stiffness", "",
        "/synchronisations/0/stiffness: found nothing, expected a number, N·m/rad, ≥ 0"},
       {"/synchronisations/0/stiffness", "-1",
        "/synchronisations/0/stiffness: found -1, expected >= 0"},
       {"/synchronisations/0/damping", "-1",
        "/synchronisations/0/damping: found -1, expected >= 0"},
       {"/synchronisations/0/preload", "0", "/synchronisations/0/preload: found 0, expected > 0"},
       {"/synchronisations/0/prelaod", "1",
        "/synchronisations/0/prelaod: found the unknown key \"prelaod\", expected \"name\", "
        "\"between\", \"ratio\", \"stiffness\", \"damping\" or \"preload\" (did you mean "
        "\"preload\"?)"}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(spoilt_synchronisation(change)) == test::facts_of(change.message));
}

TEST_CASE("Loops are written in full, and not at all where there are none", "[synchronisation]") {
  const Json written = write_scene(read_scene(test::real_scene()))["synchronisations"];
  CHECK(written[0].dump() ==
        R"({"name":"loop","between":["root","mid"],"ratio":2.0,"stiffness":300.0,"damping":0.5,)"
        R"("preload":8.0})");
  CHECK(written[1].dump() ==
        R"({"name":"cam","between":["mid","root"],"ratio":{"table":{"travel":[0.0,1.0,3.0],)"
        R"("travel_of_second":[0.0,0.6,1.5]}},"stiffness":100.0,"damping":0.0})");
  CHECK_FALSE(write_scene(read_scene(test::small_scene())).contains("synchronisations"));
}

TEST_CASE("A loop is written with its preload, whether it has a ratio or a table",
          "[synchronisation]") {
  for (const std::size_t loop : {0U, 1U})
    for (const double preload : {0.0, 2.5}) { // 0: none
      Json scene = test::real_scene();
      Json& given = scene["synchronisations"][loop];
      given.erase("preload");
      if (preload > 0) given["preload"] = preload;
      const Scene again = read_scene(write_scene(read_scene(scene)));
      CAPTURE(loop, preload);
      CHECK(again.synchronisations[loop].preload.value_or(0) == preload);
      CHECK(bool(again.synchronisations[loop].table) == (loop == 1));
    }
}
