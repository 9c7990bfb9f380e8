// --set changes the nominal scene.
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("what --set changes is the nominal scene, and part of the campaign") {
  const Folder folder;
  const std::string file = folder.write("c.json", quick_campaign(4).dump());
  const std::string out = folder.path() / "r";
  const auto made =
      run_program(folder, {"run", file, "--out", out, "--set", "hinges.*.spring.scale=1.1", "--set",
                           "bodies.panel_1.inertia=12 lb*ft^2"});
  CHECK(made.code == 0);
  const Json scene = parse_json_file(out + "/campaign.json")["scene"];
  CHECK(scene["hinges"][2]["spring"]["scale"] == 1.1);
  CHECK(scene["bodies"][0]["inertia"] == Approx(12 * 0.45359237 * 0.3048 * 0.3048).epsilon(1e-15));
  CHECK(run_program(folder, {"replay", out, "--run", "2"}).code == 0);
  const auto resumed = run_program(folder, {"run", file, "--out", out, "--resume"});
  CHECK(resumed.code == 2);
  CHECK_THAT(resumed.error,
             HasFacts({"/scene/hinges/0/spring/scale: found 1.1", "expected nothing"}));

  const std::string panel = three_panel_file();
  const auto simulated = run_program(
      folder, {"simulate", panel, "--t-end", "1", "--set", "hinges.mid.initial_rate=-10 deg/s"});
  CHECK(simulated.code == 0);
  CHECK(simulated.out != run_program(folder, {"simulate", panel, "--t-end", "1"}).out);
  CHECK_THAT(run_program(folder, {"check", panel, "--set", "bodies.panel_2.mass=11"}).out,
             Catch::Contains("panel_2: mass 11 kg"));
}

TEST_CASE("a name with an equals sign can be set") {
  const Folder folder;
  Json json = parse_json_file(three_panel_file());
  json["hinges"][0]["name"] = "ro=ot";
  const std::string file = folder.write("s.json", json.dump());
  const auto shown =
      run_program(folder, {"check", file, "--set", "hinges.ro=ot.initial_rate=-0.1"});
  CHECK(shown.code == 0);
  CHECK(shown.out != run_program(folder, {"check", file}).out);
}

TEST_CASE("Each fault of --set is told") {
  const Folder folder;
  const std::string file = folder.write("c.json", quick_campaign(4).dump());
  const auto [code, out, error] =
      run_program(folder, {"check", file, "--set", "hinges.*.sprng.scale=1.1", "--set",
                           "bodies.panel_1.inertia", "--set", "bodies.panel_1.inertia=1 kg",
                           "--set", "bodies.*.inertia=1", "--set", "bodies.panel_2.inertia=2"});
  CHECK(code == 2);
  CHECK_THAT(
      error,
      HasFacts({"error: --set hinges.*.sprng.scale: found", "\"hinges.*.spring.scale\"?",
                "\nerror: --set bodies.panel_1.inertia: found", "PATH=VALUE",
                "\nerror: --set bodies.panel_1.inertia: found string \"1 kg\"", "kg·m²",
                "\"lb*in^2\"", "\nerror: --set bodies.panel_2.inertia: found", "a second time"}));
  CHECK(lines_of(error).size() == 4);
  CHECK_THAT(run_program(folder, {"simulate", file, "--set", "bodies.panel_1.mass=12"}).error,
             HasFacts({"error: --set bodies.panel_1.mass: found", "\"mass.panel_1\" sets"}));
  CHECK(run_program(folder, {"check", file, "--set", "bodies.panel_1.inertia=-1"}).error ==
        "error: --set: found bodies.panel_1.inertia of -1, expected > 0\n");
}
