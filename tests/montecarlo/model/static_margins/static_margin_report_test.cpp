#include "montecarlo/engine/runs/static_margin_draws.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"
#include "tests/montecarlo/csv_support.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

StaticMarginReport report_of(int runs) {
  Json json = one_panel_margin(runs);
  json["statistics"] = {{"quantiles", {0.1, 0.5}}};
  json["margin"]["motorization"] = {{"points", 3}, {"ecss", {{"friction", 2.5}}}};
  const Campaign campaign = campaign_of(json);
  StaticMarginReport report{
      campaign.motorization, campaign.scene, campaign.statistics.quantiles, {}};
  report.cases.push_back({1.25, "cold", study_static_margins(campaign)});
  return report;
}

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  return keys;
}

} // namespace

TEST_CASE("static margins as JSON: every number of the study, with the factors behind it",
          "[motorization]") {
  const StaticMarginReport report = report_of(40);
  const Json json = static_margins_json(report);
  CHECK(keys_of(json) ==
        std::vector<std::string>{"standards", "factors", "springs_per_hinge", "at"});
  CHECK(json["factors"]["ecss"]["friction"] == 2.5);
  REQUIRE(json["at"].size() == 1);
  const Json& at = json["at"][0];
  CHECK((at["scale"] == 1.25 && at["case"] == "cold" && at["draws"] == 40 && at["invalid"] == 0));
  const DriveMargins& drive = report.cases[0].study.drives.at(0);
  const Json& found = at["least_over_travel"][0];
  CHECK(found["hinge"] == drive.hinge);
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
    const Json& its = found[std::string(margin_kind_names[kind])];
    const MarginSpread& spread = drive.worst_spread[kind];
    CAPTURE(margin_kind_names[kind]);
    CHECK((its["nominal"] == drive.worst[kind] && its["angle"] == drive.worst_angle[kind]));
    CHECK(its["draws"]["worst_run"] == spread.worst_run);
    CHECK(its["draws"]["least"] == spread.least);
    CHECK(its["draws"]["share_below_0"] == spread.share_short);
    CHECK(its["draws"]["quantiles"] == Json{{{"p", 0.1}, {"value", spread.quantiles[0]}},
                                            {{"p", 0.5}, {"value", spread.quantiles[1]}}});
  }
}

TEST_CASE("where the first draw is the worst its number stands in the CSV, as any other's",
          "[motorization]") {
  for (CsvRow& row : rows_by_name(static_margins_csv(report_of(1))))
    for (const auto& kind : margin_kind_names) CHECK(row[std::string(kind) + "_worst_run"] == "0");
}

TEST_CASE("static margins as CSV: a cell for each name, and a line for each place of the travel",
          "[motorization]") {
  const StaticMarginReport report = report_of(10);
  std::istringstream csv(static_margins_csv(report));
  std::vector<long> cells;
  for (std::string line; std::getline(csv, line);)
    cells.push_back(1 + std::ranges::count(line, ','));
  REQUIRE(cells.size() == 1 + 3);
  for (const long count : cells)
    CHECK(count == 5 + 11 + 5 * (1 + 2 + 3)); // place; torques; five margins and their spreads
  const auto rows = rows_by_name(static_margins_csv(report));
  const DriveMargins& drive = report.cases[0].study.drives.at(0);
  REQUIRE(rows.size() == drive.travel.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CsvRow row = rows[k];
    const TravelPoint& at = drive.travel[k];
    const auto check = [&](const std::string& name, double value) {
      CAPTURE(k, name, row[name]);
      CHECK((row[name].empty() ? std::isnan(value) : std::stod(row[name]) == value));
    };
    CHECK((row["case"] == "cold" && row["hinge"] == drive.hinge));
    check("scale", 1.25), check("travel", at.x), check("angle", at.angle);
    check("available", at.nominal.available), check("inertia", at.nominal.inertia);
    check("spring", at.nominal.spring), check("motor", at.nominal.motor);
    check("friction", at.nominal.friction), check("hysteresis", at.nominal.hysteresis);
    check("harness", at.nominal.harness), check("adhesion", at.nominal.adhesion);
    check("acceleration", at.nominal.acceleration), check("delivered", at.nominal.delivered);
    check("damping", at.nominal.damping);
    for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
      const std::string name(margin_kind_names[kind]);
      const MarginSpread& spread = at.spread[kind];
      check(name, at.margins[kind]);
      check(name + "@0.1", spread.quantiles[0]), check(name + "@0.5", spread.quantiles[1]);
      check(name + "_share_below_0", spread.share_short), check(name + "_least", spread.least);
      CHECK(row[name + "_worst_run"] == std::to_string(spread.worst_run));
    }
  }
}

TEST_CASE("curves for the page: the nominal margins, and the draws' quantile at the lowest level",
          "[motorization]") {
  const StaticMarginReport report = report_of(30);
  const StaticMarginStudy& study = report.cases[0].study;
  const Json json = static_margin_curves(study, MarginKind::nasa, report.probabilities);
  const auto nasa = static_cast<std::size_t>(MarginKind::nasa);
  CHECK((json["draws"] == 30 && json["lower_p"] == 0.1));
  const Json& curve = json["hinges"][0];
  const DriveMargins& drive = study.drives[0];
  for (std::size_t k = 0; k < drive.travel.size(); ++k) {
    const TravelPoint& point = drive.travel[k];
    CHECK(curve["angle"][k].get<double>() == Approx(point.angle).epsilon(1e-6).margin(1e-12));
    CHECK(curve["margin"][k].get<double>() == Approx(point.margins[nasa]).epsilon(1e-4));
    CHECK(curve["margin_lower"][k].get<double>() ==
          Approx(point.spread[nasa].quantiles[0]).epsilon(1e-4));
  }
  CHECK(curve["least"].get<double>() == Approx(drive.worst[nasa]).epsilon(1e-4));
  CHECK(curve["lower"].get<double>() ==
        Approx(drive.worst_spread[nasa].quantiles[0]).epsilon(1e-4));
  CHECK(static_margin_curves({}, MarginKind::nasa, {}).is_null());
}

TEST_CASE("a hinge that only a motor drives has no margin with one spring out", "[motorization]") {
  Json json = one_panel_margin(20);
  Json& hinge = json["scene"]["hinges"][0];
  hinge["spring"] = {{"torque_stowed", 0}, {"torque_latched", 0}};
  hinge["motor"] = {{"rate", 0.1}, {"gain", 100}, {"torque_limit", 5}};
  json.erase("margin");
  json.erase("dispersions");
  json["requirements"] = {{{"motorization", "NASA"}, {"probability", 0.9}, {"confidence", 0.9}}};
  const Campaign campaign = campaign_of(json);
  StaticMarginReport report{
      campaign.motorization, campaign.scene, campaign.statistics.quantiles, {}};
  report.cases.push_back({1, "", study_static_margins(campaign)});
  const Json found = static_margins_json(report)["at"][0]["least_over_travel"][0];
  CHECK(found["nasa"]["nominal"].get<double>() > 0);
  const Json& lost = found["nasa_one_spring_out"];
  CHECK((lost["nominal"].is_null() && lost["angle"].is_null() && lost["draws"]["least"].is_null()));
  CHECK(lost["draws"]["share_below_0"].is_null());
  const StaticMarginStudy& study = report.cases[0].study;
  CHECK(static_margin_curves(study, MarginKind::nasa_one_spring_out, {0.5}).is_null());
  const auto cells_of = [](const std::string& text) {
    std::vector<std::string> cells;
    std::istringstream in(text.substr(text.rfind("root")));
    for (std::string cell; in >> cell;) cells.push_back(cell);
    return cells;
  };
  const auto cells = cells_of(nominal_margins_text({{"", campaign.scene}}, campaign.motorization));
  REQUIRE(cells.size() == 6); // the hinge and five margins
  CHECK((cells[2].starts_with('+') && cells[3] == "–" && cells[4].starts_with('+')));
  const std::string table = static_margins_text(report);
  const std::string line = table.substr(table.find("NASA, one spring out"));
  CHECK(std::ranges::count(line.substr(0, line.find('\n')), '\xE2') == 5); // five dashes
  json["requirements"][0]["motorization"] = "NASA_one_spring_out";
  CHECK_THROWS_WITH(campaign_of(json),
                    Catch::Contains("/requirements/0/motorization: ") && Catch::Contains("spring"));
}

// check prints nominal_margins_text, margin and the report show the study, run judges least_margin.
TEST_CASE("check, run and the study agree on one spring out", "[motorization]") {
  const Campaign campaign = campaign_of(one_panel_margin(20));
  const RequiredMargin required{MarginKind::nasa_one_spring_out, "*"};
  const Scene nominal = nominal_scene(campaign);
  const double judged = least_margin(nominal, required_drives(nominal, required), required.kind,
                                     campaign.motorization);
  CHECK(study_static_margins(campaign).drives.at(0).worst[2] == judged);
  CHECK_THAT(nominal_margins_text({{"", nominal}}, campaign.motorization),
             Catch::Contains(fmt::format("{:+.3f}", judged)));
}

TEST_CASE("check says that static margins leave out gravity and the base's accelerations",
          "[motorization]") {
  const Campaign campaign = campaign_of(one_panel_margin(20));
  const auto text = [&](const Scene& scene) {
    return nominal_margins_text({{"", scene}}, campaign.motorization);
  };
  Scene scene = nominal_scene(campaign);
  const auto left_out = Catch::Contains("\n  without gravity and the base's accelerations\n");
  CHECK_THAT(text(scene), !left_out);
  scene.environment.gravity.y() = 0.6;
  CHECK_THAT(text(scene), left_out);
  scene.environment.gravity.y() = 0;
  scene.base.motion = BaseMotion::prescribed;
  CHECK_THAT(text(scene), left_out);
}
