#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <variant>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::filesystem::path studies = std::filesystem::path(source_folder) / "studies";

std::vector<InputWarning> check_file(const std::filesystem::path& file) {
  const std::variant<Scene, Campaign> read = read_file(file);
  if (const Scene* scene = std::get_if<Scene>(&read)) return check_input(*scene, {}, file);
  return check_input(std::get<Campaign>(read), file);
}

/// The scene of that name, or the campaign with its scene inside.
Json document_of(const std::string& name) {
  const bool campaign = name.starts_with("campaigns/");
  Json document = parse_json_file(studies / name);
  if (campaign)
    document["scene"] =
        parse_json_file(studies / "campaigns" / document["scene"].get<std::string>());
  return document;
}

std::string text_of(const std::vector<InputWarning>& warnings) {
  std::string text;
  for (const InputWarning& warning : warnings) text += to_string(warning) + '\n';
  return text;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, '|');) words.push_back(word);
  return words;
}

/// A mistake in an input, and the warning expected of it.
struct Mistake {
  const char* what;
  const char* document;
  const char* patch;   ///< JSON merge patch: pointer → value; null: taken away
  const char* pointer; ///< of the warning
  const char* found;   ///< key words of its `found`, separated by |
};

/// Changes the values at the pointers of an object.
Json changed(Json document, const Json& patch) {
  for (const auto& [pointer, value] : patch.items()) {
    const Json::json_pointer at(pointer);
    if (!value.is_null())
      document[at] = value;
    else
      document[at.parent_pointer()].erase(at.back());
  }
  return document;
}

constexpr const char* flight = "scenes/three_panel_flight.json";
constexpr const char* yoke = "scenes/yoke_wing.json";
constexpr const char* seed = "campaigns/seed.json";
constexpr const char* two_wings = "scenes/two_wing_free.json";
constexpr const char* margin = "campaigns/margin.json";
constexpr const char* driven = "campaigns/prescribed_base.json";

const std::vector<Mistake> mistakes{
    // units
    {"stowed in degrees", flight, R"({"/hinges/0/angle/stowed": 90})", "/hinges/0/angle/stowed",
     "90 rad"},
    {"folded by -180 degrees", flight, R"({"/hinges/1/angle/stowed": -180})",
     "/hinges/1/angle/stowed", "-180 rad"},
    {"latched in degrees", flight, R"({"/hinges/2/angle/latched": 180})", "/hinges/2/angle/latched",
     "180 rad"},
    {"more than a turn to go", flight,
     R"({"/hinges/2/angle/stowed": 3.5, "/hinges/2/angle/latched": -3.5})", "/hinges/2/angle",
     "a travel of 7 rad"},
    {"a table in degrees", yoke, R"({"/hinges/0/harness/table/angle": [90, 63, 31.5, 9, 0]})",
     "/hinges/0/harness/table/angle", "90 rad"},
    {"a damper's window in degrees", yoke, R"({"/hinges/0/damper/window": [60, 0]})",
     "/hinges/0/damper/window/0", "60 rad"},
    {"a damper's window that ends in degrees", yoke, R"({"/hinges/0/damper/window": [1, 60]})",
     "/hinges/0/damper/window/1", "60 rad"},
    {"a stop's gap in degrees", yoke, R"({"/hinges/0/stop/gap": 0.5})", "/hinges/0/stop/gap",
     "0.5 rad|1.571 rad"},
    {"a far stop's gap in degrees", yoke,
     R"({"/hinges/0/stop": {"side": "latched", "stiffness": 100, "dissipation": 0.1, "gap": 0.5}})",
     "/hinges/0/stop/gap", "0.5 rad|1.571 rad"},
    {"a hinge in millimetres", flight, R"({"/hinges/0/child_point": [-505, 20]})",
     "/hinges/0/child_point", "505.4 m"},
    {"a hinge in inches", flight, R"({"/hinges/0/child_point": [-19.9, 0.79]})",
     "/bodies/0/inertia", "radius of gyration|0.2"},
    {"the parent's hinge in centimetres", flight, R"({"/hinges/1/parent_point": [50.5, -2]})",
     "/hinges/1/parent_point", "50.54 m"},
    {"inertia in kg·mm²", flight, R"({"/bodies/0/inertia": 5e5})", "/bodies/0/inertia",
     "radius of gyration|223.6 m"},
    {"inertia in kg·cm²", flight, R"({"/bodies/1/inertia": 5e3})", "/bodies/1/inertia",
     "22.36 m|0.5054 m"},
    {"inertia about the hinge", flight, R"({"/bodies/1/inertia": 3.4, "/bodies/1/mass": 10})",
     "/bodies/1/inertia", "3.4 kg·m²|hinge mid, 2.554 kg·m²"},
    {"inertia about the hinge, by the plate", flight,
     R"({"/bodies/2/inertia": 2.7, "/bodies/2/mass": 8,
         "/bodies/2/plate": {"from": [-0.505, 0], "to": [0.505, 0], "width": 1, "drag_coefficient": 1}})",
     "/bodies/2/inertia", "2.7 kg·m²|hinge tip, 2.043 kg·m²"},
    {"a satellite in grams", two_wings, R"({"/base/mass": 8e5})", "/base/mass", "8e+05 kg|60 kg"},
    {"a satellite in tonnes", two_wings, R"({"/base/mass": 0.05})", "/base/mass", "0.05 kg|60 kg"},
    {"a parent's hinge far out on a light parent", flight,
     R"({"/hinges/1/parent_point": [6, -0.02], "/bodies/1/inertia": 4, "/bodies/1/mass": 1})",
     "/hinges/1/parent_point", "6 m from|"},
    {"mass in grams", flight, R"({"/bodies/2/mass": 10000})", "/bodies/2/inertia",
     "0.007071 m|0.5054 m"},
    // torques
    {"a spring with the sign of its rotation", flight,
     R"({"/hinges/1/spring": {"torque_stowed": -1.5, "torque_latched": -0.5}})", "/hinges/1/spring",
     "-1.5 N·m|-3.142 rad"},
    {"a spring that is spent before the latch", flight,
     R"({"/hinges/2/spring/torque_latched": -0.2})", "/hinges/2/spring", "-0.2 N·m|0 rad"},
    {"a harness stiffer than the spring", flight, R"({"/hinges/2/harness/torque_latched": 0.5})",
     "/hinges/2/spring", "net static torque|tip|-0.4"},
    {"friction in N·mm", flight, R"({"/hinges/0/friction/coulomb": 20})", "/hinges/0/spring",
     "net static torque|root|-1"},
    {"springs too weak for the harnesses of a coupled wing", yoke,
     R"({"/hinges/0/spring/scale": 0.1, "/hinges/1/spring/scale": 0.1, "/hinges/2/spring/scale": 0.1,
         "/hinges/3/spring/scale": 0.1, "/hinges/4/spring/scale": 0.1})",
     "/hinges/0/spring", "net static torque|root+h1+h2+h3+h4|-"},
    {"a forgotten latch", flight, R"({"/hinges/1/latch": null})", "/hinges/1/latch", "no latch"},
    {"outputs that no latch has", seed, R"({"/outputs": ["latch_time", "captures"]})", "/outputs",
     "captures"},
    {"a latch that holds nothing", flight, R"({"/hinges/1/latch/stiffness": 0})",
     "/hinges/1/latch/stiffness", "0 N·m/rad"},
    // the whole life
    {"holds that wait for each other", flight,
     R"({"/hinges/0/release": {"after": "mid", "event": "released"},
         "/hinges/1/release": {"after": "root", "event": "released"}})",
     "/hinges/0/release/after", "root waits for mid waits for root"},
    {"a hold that always fails", flight, R"({"/hinges/0/release": {"time": 1, "fails": 1}})",
     "/hinges/0/release/fails", "never released"},
    {"a motor without a gain", flight,
     R"({"/hinges/0/motor": {"rate": 0.1, "gain": 0, "torque_limit": 3}})", "/hinges/0/motor/gain",
     "exerts nothing"},
    {"a motor without a torque", flight,
     R"({"/hinges/0/motor": {"rate": 0.1, "gain": 40, "torque_limit": 0}})",
     "/hinges/0/motor/torque_limit", "exerts nothing"},
    {"a motor with the sign of its rotation", flight,
     R"({"/hinges/0/motor": {"rate": -0.1, "gain": 40, "torque_limit": 3}})",
     "/hinges/0/motor/rate", "never towards the latch"},
    {"a motor in degrees a second", flight,
     R"({"/hinges/0/motor": {"rate": {"table": {"time": [0, 2], "rate": [0, 2]}}, "gain": 40, "torque_limit": 3}})",
     "/hinges/0/motor/rate", "up to 2 rad/s"},
    {"a motor that bends its latch", flight,
     R"({"/hinges/0/motor": {"rate": 0.1, "gain": 1e6, "torque_limit": 5000}})",
     "/hinges/0/motor/torque_limit", "0.5 rad|5000 N·m|1e+04 N·m/rad"},
    {"a motor that opens its latch", flight,
     R"({"/hinges/0/motor": {"rate": {"table": {"time": [0, 30], "rate": [0.1, -0.1]}}, "gain": 400, "torque_limit": 20},
         "/hinges/0/latch/holding_moment": 15})",
     "/hinges/0/motor", "20 N·m|15 N·m"},
    {"a motor too slow for the run", flight,
     R"({"/hinges/0/motor": {"rate": 0.01, "gain": 400, "torque_limit": 20},
         "/hinges/0/spring": {"torque_stowed": 0, "torque_latched": 0}})",
     "/hinges/0/motor/rate", "0.6 of its 1.571 rad|60 s"},
    {"a release in milliseconds", flight, R"({"/hinges/0/release": {"time": 500}})",
     "/hinges/0/release/time", "500 s|60 s"},
    {"a release after an angle in degrees", flight,
     R"({"/hinges/1/release": {"after": "root", "event": {"angle": 45}}})",
     "/hinges/1/release/event/angle", "45 rad|1.571 rad|root"},
    {"a latch too slow for the nominal wing", flight,
     R"({"/hinges/0/latch/capture_rate": 0.5, "/hinges/0/stop": {"side": "latched", "stiffness": 1e4}})",
     "/hinges/0/latch/capture_rate", "0.5 rad/s|rad/s ("},
    {"a latch too weak for the nominal wing", flight, R"({"/hinges/0/latch/holding_moment": 50})",
     "/hinges/0/latch/holding_moment", "50 N·m|lets go at"},
    {"nothing behind a latch that may miss", flight, R"({"/hinges/0/latch/capture_rate": 9})",
     "/hinges/0/stop", "no stop at the latched side"},
    // geometry
    {"the root's hinge points swapped", flight,
     R"({"/hinges/0/parent_point": [-0.505, 0.02], "/hinges/0/child_point": [0, 0]})",
     "/hinges/0/child_point", "0 m|panel_1"},
    {"an inner hinge's points swapped", flight,
     R"({"/hinges/1/parent_point": [-0.505, -0.02], "/hinges/1/child_point": [0.505, -0.02]})",
     "/hinges/1/parent_point", "panel_1|panel_2|root"},
    {"a child that folds back", flight, R"({"/hinges/2/child_point": [0.505, 0.02]})",
     "/hinges/2/child_point", "panel_3|folds back|panel_2"},
    {"an offset of the wrong sign", flight, R"({"/hinges/1/child_point": [-0.505, 0.02]})",
     "/hinges/1/child_point", "panel_2|0.04 m|panel_1"},
    {"the same, as it is stowed", flight, R"({"/hinges/1/child_point": [-0.505, 0.02]})",
     "/hinges/1/angle/stowed", "panel_1|panel_2|centres of mass|stowed"},
    {"a panel in the place of the one before the last", flight,
     R"({"/hinges/2/parent_point": [0.505, -0.02], "/hinges/2/child_point": [-0.505, -0.02]})",
     "/hinges/2/angle/stowed", "panel_1|panel_3|centres of mass|stowed"},
    {"folded across the stack", flight, R"({"/hinges/2/angle/stowed": 3.6})",
     "/hinges/2/angle/stowed", "panel_1|panel_3|stowed"},
    {"the wrong sense of rotation", flight, R"({"/hinges/2/angle/stowed": -3.141592653589793})",
     "/hinges/2/angle", "panel_3|turns through|panel_2|-180|0 deg"},
    {"a ratio with which only one hinge latches", yoke, R"({"/synchronisations/0/ratio": 1.9})",
     "/synchronisations/0/ratio", "171 deg of h1|root|90 deg"},
    {"a loop the wrong way round", yoke, R"({"/synchronisations/0/ratio": -2})",
     "/synchronisations/0/ratio", "-180 deg of h1"},
    {"a damper in N·mm·s", flight,
     R"({"/hinges/1/damper": {"law": "viscous", "coefficient": 120}})", "/hinges/1/damper",
     "a deployment of more than|this damper alone (a lower bound)"},
    // laws
    {"an increment used as a factor", seed,
     R"({"/dispersions/0/distribution": {"type": "normal", "mean": 0, "std": 0.03}})",
     "/dispersions/0", "a factor of 0|hinges.root.spring.torque_stowed"},
    {"per cent used as a factor", seed,
     R"({"/dispersions/0/distribution": {"type": "normal", "mean": 100, "std": 3}})",
     "/dispersions/0", "a factor of 100"},
    {"draws about 1 over a nominal factor", seed,
     R"({"/scene/hinges/1/spring/scale": 0.8,
         "/dispersions/3": {"name": "k", "distribution": {"type": "normal", "mean": 1.01, "std": 0.03},
         "apply": "set", "to": ["hinges.mid.spring.scale"]}})",
     "/dispersions/3", "a median of 1.01|replaces hinges.mid.spring.scale|0.8 in the scene"},
    {"a factor that is set", seed,
     R"({"/dispersions/0/apply": "set", "/dispersions/0/to": ["hinges.root.spring.torque_latched"]})",
     "/dispersions/0", "a median of 1 |hinges.root.spring.torque_latched|1.4 N·m"},
    {"half the nominal value, added", seed,
     R"({"/dispersions/3": {"name": "k", "distribution": {"type": "normal", "mean": 5, "std": 0.1},
         "apply": "add", "to": ["bodies.panel_2.mass"]}})",
     "/dispersions/3", "5 kg on average|bodies.panel_2.mass, 10 kg"},
    {"a factor used as an increment", seed, R"({"/dispersions/0/apply": "add"})", "/dispersions/0",
     "1 N·m|1.059 N·m|added|hinges.root.spring.torque_stowed|2 N·m"},
    {"a standard deviation in per cent", seed,
     R"({"/dispersions/0/distribution": {"type": "normal", "mean": 1, "std": 3}})",
     "/dispersions/0", "probability of 0.369|sign|hinges.root.spring.torque_stowed"},
    {"a mass that can be negative", seed,
     R"({"/dispersions/3": {"name": "mass", "distribution": {"type": "normal", "mean": 10, "std": 2},
         "apply": "set", "each": "bodies.*.mass"}})",
     "/dispersions/3", "probability of 2.87e-07|negative|bodies.panel_1.mass"},
    {"a stiffness that can be negative", seed,
     R"({"/dispersions/3": {"name": "k", "distribution": {"type": "uniform", "lower": -0.5, "upper": 2},
         "apply": "scale", "each": "hinges.*.latch.stiffness"}})",
     "/dispersions/3", "probability of 0.2|negative|hinges.root.latch.stiffness"},
    {"a mass in grams", seed,
     R"({"/dispersions/3": {"name": "mass", "distribution": {"type": "uniform", "lower": 9800,
         "upper": 10200}, "apply": "set", "each": "bodies.*.mass"}})",
     "/dispersions/3", "median|1e+04 kg|bodies.panel_1.mass|10 kg"},
    {"a tolerance in degrees", seed,
     R"({"/dispersions/3": {"name": "tilt", "distribution": {"type": "normal", "mean": 0, "std": 0.5},
         "apply": "add", "each": "hinges.*.angle.stowed"}})",
     "/dispersions/3", "±0.98 rad|hinges.root.angle.stowed|95 %"},
    {"a factor that is wide for a negative angle", seed,
     R"({"/dispersions/3": {"name": "tilt", "distribution": {"type": "normal", "mean": 1, "std": 0.1},
         "apply": "scale", "to": ["hinges.mid.angle.stowed"]}})",
     "/dispersions/3", "±0.6157 rad|hinges.mid.angle.stowed"},
    {"an angle drawn in degrees", seed,
     R"({"/dispersions/3": {"name": "tilt", "distribution": {"type": "uniform", "lower": 89.95,
         "upper": 90.05}, "apply": "set", "to": ["hinges.root.angle.stowed"]}})",
     "/dispersions/3", "90 rad|hinges.root.angle.stowed"},
    {"a temperature in kelvin, and its table in degrees", seed,
     R"({"/dispersions/3": {"name": "temperature",
         "distribution": {"type": "normal", "mean": 250, "std": 10},
         "through": [{"to": ["hinges.root.friction.coulomb"], "apply": "scale",
                      "table": {"at": [-100, 20, 60], "value": [3, 1, 0.8]}}]}})",
     "/dispersions/3/through/0/table/at", "100 % of the draws|-100|60|250"},
    {"a table that ends inside the draws", seed,
     R"({"/dispersions/3": {"name": "temperature",
         "distribution": {"type": "normal", "mean": 50, "std": 10},
         "through": [{"to": ["hinges.root.friction.coulomb"], "apply": "scale",
                      "table": {"at": [-100, 20, 60], "value": [3, 1, 0.8]}}]}})",
     "/dispersions/3/through/0/table/at", "15.9 % of the draws|-100|60|50"},
    {"a case's temperature in kelvin", seed,
     R"({"/dispersions/3": {"name": "temperature",
         "distribution": {"type": "normal", "mean": 20, "std": 10},
         "through": [{"to": ["hinges.root.friction.coulomb"], "apply": "scale",
                      "table": {"at": [-100, 20, 60], "value": [3, 1, 0.8]}}]},
         "/cases": [{"name": "hot"}, {"name": "cold",
                    "distributions": {"temperature": {"type": "normal", "mean": 213, "std": 5}}}]})",
     "/cases/1/distributions/temperature", "100 % of the draws|temperature|-100|60|213"},
    {"a case in which the harness holds the wing", seed,
     R"({"/cases": [{"name": "hot"},
                    {"name": "cold", "scale": {"hinges.tip.harness.torque_latched": 9}}]})",
     "/cases/1", "case cold|/scene/hinges/2/spring|net static torque|tip|-"},
    {"a case whose latch gives way", seed,
     R"({"/cases": [{"name": "hot"},
                    {"name": "cold", "scale": {"hinges.tip.latch.stiffness": 1e-6}}]})",
     "/cases/1", "case cold|/scene/hinges/2/latch/stiffness|turns the latched hinge"},
    {"a lot as a correlation", seed,
     R"({"/correlations": [{"between": ["root_spring", "mid_spring"], "spearman": 0.95}]})",
     "/correlations/0", "0.95|root_spring|mid_spring"},
    {"a temperature as correlations", seed,
     R"({"/correlations": [{"between": ["root_spring", "mid_spring"], "spearman": 0.6},
                           {"between": ["tip_spring", "mid_spring"], "spearman": 0.6},
                           {"between": ["root_spring", "tip_spring"], "spearman": 0.6}]})",
     "/correlations", "root_spring|mid_spring|tip_spring"},
    // requirements
    {"a limit on a rate of the other sign", margin,
     R"({"/requirements/3": {"output": "tip.latch_rate", "max": 4.5, "probability": 0.99,
                             "confidence": 0.9}})",
     "/requirements/3/max", "4.5 rad/s|nominal tip.latch_rate|-"},
    {"a limit in degrees per second", margin,
     R"({"/requirements/3": {"output": "tip.latch_rate", "max": 90, "abs": true, "probability": 0.99,
                             "confidence": 0.9}})",
     "/requirements/3/max", "90 rad/s|nominal tip.latch_rate is -"},
    {"a moment's limit in N·mm", margin,
     R"({"/requirements/1": {"output": "root.peak_moment", "max": 300000, "probability": 0.99,
                             "confidence": 0.9}})",
     "/requirements/1/max", "300000 N·m|nominal root.peak_moment"},
    {"a time's limit in hours", margin,
     R"({"/requirements/1": {"output": "deployment_time", "max": 0.005, "probability": 0.99,
                             "confidence": 0.9}})",
     "/requirements/1/max", "0.005 s|nominal deployment_time"},
    {"a limit in degrees on what is nearly 0", margin,
     R"({"/outputs": ["latch_time", "latch_rate", "peak_moment", "peak_force", "overtravel"],
         "/requirements/1": {"output": "mid.overtravel", "max": 5, "probability": 0.99,
                             "confidence": 0.9}})",
     "/requirements/1/max", "5 rad|mid travels 3.14"},
    {"a lower limit above the upper one", margin,
     R"({"/requirements/3": {"output": "root.peak_moment", "min": 400, "probability": 0.99,
                             "confidence": 0.9}})",
     "/requirements/3/min", "400 of root.peak_moment|limits to 300"},
    {"a limit converted twice", margin,
     R"({"/requirements/3": {"output": "tip.latch_rate", "max": 0.03, "abs": true,
                             "probability": 0.99, "confidence": 0.9}})",
     "/requirements/3/max", "0.03 rad/s|nominal tip.latch_rate is -"},
    {"a magnitude below zero", margin, R"({"/requirements/1/max": -300})", "/requirements/1/max",
     "-300 N·m|magnitude"},
    {"a peak that is never proven", driven,
     R"({"/scene/base/angular_acceleration": 0.01,
         "/requirements": [{"output": "root.peak_moment", "max": 300, "probability": 0.9,
                            "confidence": 0.9}]})",
     "/requirements/0", "root.peak_moment|base"}};

} // namespace

TEST_CASE("the shipped scenes and campaigns get no warning", "[warnings]") {
  int files = 0;
  for (const char* folder : {"scenes", "campaigns", "../examples"}) {
    if (!std::filesystem::exists(studies / folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(studies / folder)) {
      if (entry.path().extension() != ".json") continue;
      CAPTURE(entry.path().string());
      CHECK(text_of(check_file(entry.path())) == "");
      ++files;
    }
  }
  CHECK(files >= 19);
}

TEST_CASE("each mistake gets a warning at its pointer", "[warnings]") {
  const Folder folder;
  for (const auto& [what, document, patch, pointer, found] : mistakes) {
    const Json spoilt = changed(document_of(document), parse_json(patch));
    const auto file = folder.write("spoilt.json", spoilt.dump());
    const std::vector<InputWarning> warnings = check_file(file);
    const auto at_place = std::ranges::find(warnings, std::string(pointer), &InputWarning::pointer);
    CAPTURE(what, text_of(warnings));
    REQUIRE(at_place != warnings.end());
    for (const std::string& word : words_of(found))
      CHECK_THAT(at_place->found, Catch::Contains(word));
    CHECK_FALSE(at_place->usual.empty());
    CHECK(at_place->file == file.string());
    CHECK(warnings.size() <= 6); // few enough to be read
  }
  CHECK(mistakes.size() >= 24);
}

TEST_CASE("a scene's warnings name the scene's file and pointer", "[warnings]") {
  const Folder folder;
  Json campaign = document_of(seed);
  campaign["scene"]["hinges"][0]["angle"]["stowed"] = 90;
  const auto inside = folder.write("inside.json", campaign.dump());
  const InputWarning first = check_file(inside).at(0);
  CHECK(first.file == inside.string());
  CHECK(first.pointer == "/scene/hinges/0/angle/stowed");
  CHECK(first.found == "90 rad");
  const auto scene = folder.write("wing.json", campaign["scene"].dump());
  CHECK((scene_place(scene).file == scene.string() && scene_place(scene).prefix.empty()));
  campaign["scene"] = "wing.json";
  const auto outside = folder.write("outside.json", campaign.dump());
  CHECK(check_file(outside).at(0).file == scene.string());
  CHECK(check_file(outside).at(0).pointer == "/hinges/0/angle/stowed");
}

TEST_CASE("correlations that come with a covariance are not scolded", "[warnings]") {
  const Folder folder;
  Json campaign = document_of(seed);
  for (const std::size_t k : {0U, 1U, 2U})
    campaign["dispersions"][k]["distribution"] = {{"type", "normal"}, {"mean", 1}, {"std", 0.02}};
  const auto correlated = [&](const char* key, double value) {
    campaign["correlations"] = Json::array();
    for (const auto& [a, b] : {std::pair{"root_spring", "mid_spring"},
                               {"mid_spring", "tip_spring"},
                               {"root_spring", "tip_spring"}})
      campaign["correlations"].push_back({{"between", {a, b}}, {key, value}});
    return check_file(folder.write("correlated.json", campaign.dump()));
  };
  CHECK(correlated("spearman", 0.9).size() == 4);
  CHECK(text_of(correlated("covariance", 0.00036)) == "");
}
