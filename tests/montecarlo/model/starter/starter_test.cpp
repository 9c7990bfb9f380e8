#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/starter/starter.hpp"
#include "montecarlo/model/starter/starter_campaign.hpp"
#include "montecarlo/model/starter/starter_scene.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>
#include <string>

using namespace wingspread;

namespace {

/// The starter's files in a folder, as `new` writes them.
struct Written {
  test::Folder folder{};
  std::filesystem::path file;
  Campaign campaign;
  explicit Written(const Starter& starter) {
    (void)folder.write(starter_scene_file, starter.scene);
    file = folder.write(starter_campaign_file, starter.campaign);
    campaign = read_campaign_file(file);
  }
  [[nodiscard]] std::vector<InputWarning> warnings() const { return check_input(campaign, file); }
};

/// Checks that the files are read without a warning and that every case deploys.
void check_starter(const WingDesign& design) {
  const Starter starter = make_starter(design, "wingspread new");
  CHECK(starter.deploys);
  const Written written(starter);
  const Campaign& campaign = written.campaign;
  for (const InputWarning& warning : written.warnings()) FAIL_CHECK(to_string(warning));
  for (const Campaign& each : campaigns_of(campaign)) {
    const Outcome outcome = Deployment().run(nominal_scene(each), each.integration, {});
    CHECK(outcome.status == Status::deployed);
    CHECK(outcome.peaks_final);
    CHECK(outcome.latches.back().time < each.integration.t_end / 2);
  }
  CHECK(campaign.requirements.size() == static_cast<std::size_t>(2 + design.wings));
}

} // namespace

TEST_CASE("new wings of all kinds deploy in every case, without a warning") {
  for (int panels = 1; panels <= 6; ++panels) {
    const bool yoke = panels % 2 == 0;
    for (const int wings : {1, 2}) {
      WingDesign design;
      design.panels = panels, design.yoke = yoke == (wings == 1), design.wings = wings;
      CAPTURE(panels, design.yoke, wings);
      check_starter(design);
    }
  }
}

TEST_CASE("a small wing, a large one and one of springs alone deploy as well") {
  WingDesign small;
  small.panels = 2;
  small.panel_length = 0.3, small.panel_width = 0.1, small.panel_mass = 0.25, small.pitch = 0.006;
  small.bus_width = 0.1;
  small.root_spring = 0.06, small.spring = 0.04, small.friction = 0.002, small.harness = 0.008;
  check_starter(small);
  WingDesign large;
  large.panels = 5, large.yoke = true;
  large.panel_length = 3.5, large.panel_mass = 40, large.yoke_length = 2, large.yoke_mass = 12;
  large.root_spring = 12, large.spring = 6, large.harness = 1;
  check_starter(large);
  WingDesign bare; // whose ring nothing proves to fall
  bare.friction = bare.harness = 0, bare.damper = 0;
  CHECK(make_starter(bare, "").deploys);
}

TEST_CASE("the same design gives the same bytes, and each kind of line is explained") {
  WingDesign design;
  design.panels = 4, design.yoke = true, design.wings = 2;
  const Starter starter = make_starter(design, "wingspread new --wings 2");
  const Starter again = make_starter(design, "wingspread new --wings 2");
  CHECK(starter.scene == again.scene);
  CHECK(starter.campaign == again.campaign);
  CHECK(starter.page == again.page);
  for (const char* key : {"\"mass\"", "\"plate\"", "\"parent_point\"", "\"angle\"", "\"spring\"",
                          "\"harness\"", "\"friction\"", "\"damper\"", "\"stop\"", "\"latch\"",
                          "\"ratio\"", "\"preload\"", "\"temperature\"", "\"each\"", "\"cold\"",
                          "\"sampling\"", "\"t_end\"", "\"deployed\"", "R_root.peak_moment"}) {
    CAPTURE(key);
    const std::size_t at = starter.page.find(key, starter.page.find("| line | what it says |"));
    REQUIRE(at != std::string::npos);
    const std::string line = starter.page.substr(at, starter.page.find('\n', at) - at);
    const std::size_t note = line.find("` | ");
    REQUIRE(note != std::string::npos);
    CHECK(line.size() - note > 20);
  }
  CHECK(starter.page.find("    wingspread new --wings 2\n") != std::string::npos);
}

TEST_CASE("a new wing's files have their parts in the order of the manual") {
  const Starter starter = make_starter(WingDesign{}, "wingspread new");
  const auto in_order = [](const std::string& text, const std::vector<std::string>& keys) {
    std::size_t at = 0;
    for (const std::string& key : keys) {
      CAPTURE(key);
      const std::size_t found = text.find("\n  \"" + key + "\"");
      REQUIRE(found != std::string::npos);
      CHECK(found >= at);
      at = found;
    }
  };
  in_order(starter.campaign,
           {"scene", "dispersions", "cases", "sampling", "integration", "requirements"});
  in_order(starter.scene, {"name", "base", "bodies", "hinges"});
}

TEST_CASE("each note of a new wing's page stands once, though its lines are alike") {
  for (const int panels : {1, 2, 4}) {
    WingDesign design;
    design.panels = panels, design.yoke = true, design.wings = 2;
    const std::string page = make_starter(design, "wingspread new").page;
    std::set<std::string> notes;
    for (std::size_t at = page.find("` | "); at != std::string::npos;
         at = page.find("` | ", at + 1)) {
      const std::string note = page.substr(at + 4, page.find('\n', at) - at - 4);
      CAPTURE(panels, note);
      CHECK(notes.insert(note).second);
    }
    CHECK(notes.size() > 20);
  }
}

TEST_CASE("new wings without friction, cables and dampers have final peaks") {
  for (const int panels : {1, 3}) {
    WingDesign design;
    design.panels = panels, design.friction = design.harness = 0, design.damper = 0;
    CAPTURE(panels);
    check_starter(design);
  }
}

TEST_CASE("the suggested damper doubles the nominal time to a tenth") {
  const auto time_of = [](WingDesign design, double damper) {
    design.damper = damper;
    Integration integration;
    integration.t_end = latest_end;
    return Deployment().run(scene_of(design), integration, {}).latches.back().time;
  };
  for (const auto& [panels, yoke, wings, spring] : {std::tuple{1, false, 1, 1.5},
                                                    {1, true, 2, 1.5},
                                                    {2, false, 1, 0.9},
                                                    {3, false, 1, 1.5},
                                                    {4, true, 1, 4.0},
                                                    {6, false, 1, 1.5},
                                                    {8, false, 1, 1.5}}) {
    WingDesign design;
    design.panels = panels, design.yoke = yoke, design.wings = wings, design.spring = spring;
    const double suggested = suggested_damper(design);
    CAPTURE(panels, yoke, wings, spring, suggested);
    REQUIRE(suggested > 0);
    CHECK(time_of(design, suggested) / time_of(design, 0) == Approx(2).epsilon(0.1));
    CHECK(suggested == two_digits(suggested));
    design.damper = 7; // is for the user to give, and no part of the suggestion
    CHECK(suggested_damper(design) == suggested);
  }
}

TEST_CASE("a wing that no damper slows to twice its time has none") {
  WingDesign design;
  design.harness = 4;
  CHECK(suggested_damper(design) == 0); // it does not deploy at all
}

TEST_CASE("only a damper that the program chose is said to be chosen") {
  WingDesign design;
  const auto chosen = [&] {
    return make_starter(design, "wingspread new").page.find("chosen so that") != std::string::npos;
  };
  CHECK(chosen());
  design.damper = 3;
  CHECK_FALSE(chosen());
}

TEST_CASE("a wing that does not deploy is written, and said to stall") {
  WingDesign design;
  design.harness = 4;
  const Starter starter = make_starter(design, "wingspread new --harness 4");
  CHECK_FALSE(starter.deploys);
  CHECK_FALSE(Written(starter).warnings().empty());
}

TEST_CASE(
    "limits are twice the nominal time and three times the moments, rounded up to two digits") {
  WingDesign slow, fast; // in some 5 s and in less than one
  slow.damper = suggested_damper(slow);
  fast.panels = 2, fast.wings = 2, fast.bus_width = 0.1, fast.damper = 0;
  fast.panel_length = 0.3, fast.panel_width = 0.1, fast.panel_mass = 0.25, fast.pitch = 0.006;
  fast.root_spring = 0.6, fast.spring = 0.4, fast.friction = 0.002, fast.harness = 0.008;
  WingDesign uneven; // its largest moment is that of the second of three cases
  uneven.wings = 2, uneven.yoke = true, uneven.root_spring = 0.64, uneven.spring = 0.77;
  uneven.friction = 0.08, uneven.harness = 0, uneven.damper = 11.5;
  long in_last_case = 0;
  for (const WingDesign& design : {slow, fast, uneven}) {
    const StarterLimits limits = starter_limits(design).value();
    Json json = parse_json(json_file_text(starter_campaign(design, "", limits)));
    json["scene"] = parse_json(json_file_text(starter_scene(design)));
    double slowest = 0, last = 0;
    std::vector<double> largest(static_cast<std::size_t>(design.wings), 0.0);
    for (const Campaign& each : campaigns_of(read_campaign(json.dump(), ""))) {
      const Outcome outcome = Deployment().run(nominal_scene(each), each.integration, {});
      slowest = std::max(slowest, outcome.latches.back().time);
      const std::size_t hinges = outcome.peak_moment.size() / largest.size();
      for (std::size_t wing = 0; wing < largest.size(); ++wing)
        largest[wing] = std::max(largest[wing], outcome.peak_moment[wing * hinges].value);
      last = outcome.peak_moment.front().value;
    }
    in_last_case += last == largest.front();
    CAPTURE(slowest);
    CHECK((slowest < 1) == (design.panel_length == 0.3));
    CHECK(limits.deployment_time >= 2 * slowest);
    CHECK(limits.deployment_time <= 2 * slowest * 1.1);
    CHECK(limits.t_end >= 2 * limits.deployment_time);
    REQUIRE(limits.moment.size() == largest.size());
    for (std::size_t wing = 0; wing < largest.size(); ++wing) {
      CHECK(limits.moment[wing] >= 3 * largest[wing]);
      CHECK(limits.moment[wing] <= 3 * largest[wing] * 1.1);
      CHECK(two_digits(limits.moment[wing]) == limits.moment[wing]);
    }
  }
  CHECK(in_last_case == 2);
}
