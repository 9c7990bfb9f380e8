#include "montecarlo/model/campaign/plain_words.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::vector<SceneParameter> parameters_at(const Scene& scene,
                                          const std::vector<std::string>& paths) {
  std::vector<SceneParameter> found;
  for (const std::string& path : paths)
    for (const ParameterMatch& match : resolve(scene, path).matches)
      found.push_back(match.parameter);
  REQUIRE(!found.empty());
  return found;
}

} // namespace

TEST_CASE("parameters in plain words", "[campaign]") {
  const Scene scene = campaign_of(quick_campaign(1)).scene;
  const auto words = [&](const std::vector<std::string>& paths) {
    return plain_words(scene, parameters_at(scene, paths));
  };
  CHECK(words({"hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"}) ==
        "root spring");
  CHECK(words({"hinges.root.spring.scale"}) == "root spring");
  CHECK(words({"hinges.*.latch.stiffness"}) == "latch stiffness of all hinges");
  CHECK(words({"hinges.root.latch.stiffness", "hinges.tip.latch.stiffness"}) ==
        "latch stiffness of root and tip");
  CHECK(words({"hinges.root.latch.stiffness", "hinges.root.latch.damping"}) == "root latch");
  CHECK(words({"bodies.panel_2.mass"}) == "panel_2 mass");
  CHECK(words({"bodies.panel_2.mass", "bodies.panel_2.inertia"}) == "2 parameters");
  CHECK(words({"bodies.panel_2.mass", "hinges.root.latch.stiffness"}) == "2 parameters");
}

TEST_CASE("paths are short where a star names the same parameters", "[campaign]") {
  const Scene scene = campaign_of(quick_campaign(1)).scene;
  const auto paths = [&](const std::vector<std::string>& given) {
    return short_paths(scene, parameters_at(scene, given));
  };
  using List = std::vector<std::string>;
  CHECK(paths({"bodies.*.mass"}) == List{"bodies.*.mass"});
  CHECK(paths({"bodies.panel_1.mass", "bodies.panel_3.mass"}) ==
        List{"bodies.panel_1.mass", "bodies.panel_3.mass"});
  CHECK(paths({"bodies.panel_1.mass"}) == List{"bodies.panel_1.mass"});
}
