#include "montecarlo/analyses/margin/margin_findings.hpp"
#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/margin/weaker_springs.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <array>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The panel with a joint search, as if these scales were recommended. Its spring's end torque is below its friction.
struct ReportedPanel {
  Campaign campaign = campaign_of(one_panel_margin(20));
  MarginResult result;

  explicit ReportedPanel(const std::vector<std::optional<double>>& recommended) {
    result.cases = {{"nominal", {}}};
    result.campaigns = {campaign};
    for (const auto& scale : recommended) {
      MarginSearch& search = result.searches.emplace_back();
      search.scaled = campaign.margin->scaled;
      search.recommended = scale;
    }
  }
};

} // namespace

TEST_CASE("the report has the static margins of the present springs, and of others if recommended",
          "[margin]") {
  for (const std::optional<double> scale : {std::optional<double>(), {1.0}, {1.5}}) {
    const ReportedPanel panel({scale});
    const MarginReport report = margin_report(panel.campaign, panel.result);
    const std::vector<CaseMargins>& cases = report.static_margins.cases;
    REQUIRE(cases.size() == (scale == 1.5 ? 2 : 1));
    CHECK(cases[0].scale == 1);
    if (cases.size() == 1) continue;
    CHECK(cases[1].scale == 1.5);
    for (const CaseMargins& each : cases) {
      REQUIRE(each.study.drives.size() == 1);
      std::size_t kinds = 0;
      for (const Json& draw : each.study.drives[0].worst_draw) {
        if (draw.is_null() || draw.empty()) continue;
        ++kinds;
        CHECK(draw.size() == 3); // the campaign's own dispersions: the scale is none
        for (const char* name : {"spring", "friction", "mass"}) CHECK(draw.contains(name));
      }
      CHECK(kinds > 0);
    }
  }
}

TEST_CASE("static margins below 0 at a recommended scale are warned of, and only there",
          "[margin]") {
  CHECK(margin_warnings(ReportedPanel({std::nullopt}).result).empty());
  CHECK(margin_warnings(ReportedPanel({200.0}).result).empty());
  const auto lines = margin_warnings(ReportedPanel({200.0, 1.5, std::nullopt, 0.75}).result);
  REQUIRE(lines.size() == 2);
  for (const auto& [line, scale, other] :
       {std::tuple(lines[0], 1.5, 0.75), std::tuple(lines[1], 0.75, 1.5)}) {
    CHECK_THAT(line, Catch::Contains("scale " + fmt::format("{} ", scale)) &&
                         Catch::Contains("below 0") && Catch::Contains("margin of root"));
    CHECK_THAT(line, !Catch::Contains(fmt::format("scale {} ", other)));
    const ReportedPanel panel({scale});
    const auto shorts =
        short_margins(panel.result.campaigns, panel.result.searches[0].scaled, scale);
    REQUIRE_FALSE(shorts.empty());
    for (const Shortfall& each : shorts) CHECK_THAT(line, Catch::Contains(to_string(each)));
  }
}

TEST_CASE("a scale that static margins rule out is told with its own numbers", "[margin]") {
  Campaign campaign = campaign_of(one_panel_margin(76));
  MarginResult result = margin_of(campaign);
  MarginSearch& search = result.searches.front();
  REQUIRE(search.recommended);
  for (const double scale : {0.3, 0.7})
    for (const MarginKind kind : {MarginKind::ecss, MarginKind::nasa}) {
      search.passed_over = Shortfall{scale, "root", kind, scale - 1, scale + 1};
      const Json json = margin_json(margin_report(campaign, result), Json::object());
      const Json& told = json["searches"][0]["passed_over"];
      CHECK(told.size() == 5);
      CHECK((told["scale"] == scale && told["drive"] == "root"));
      CHECK(told["margin"] == margin_kind_names[static_cast<std::size_t>(kind)]);
      CHECK((told["at_scale"] == scale - 1 && told["at_1"] == scale + 1));
    }
}

TEST_CASE("margin.json has the campaign's confidence, and what the recommended scale gives up",
          "[margin]") {
  Json json = one_panel_margin(76);
  json["statistics"] = {{"confidence", 0.8}};
  json["report"] = {{"title", "T"}, {"author", "A"}};
  const Campaign campaign = campaign_of(json);
  MarginResult result = margin_of(campaign);
  MarginSearch& search = result.searches.front();
  const ClosedForm present = closed_form(campaign, 1);
  auto weaker = search.seen.find(1); // then the next scale at which more runs do not deploy
  REQUIRE(weaker != search.seen.end());
  while (weaker != search.seen.begin() &&
         closed_form(campaign, weaker->first).not_deployed <= present.not_deployed)
    --weaker;
  const double scale = weaker->first;
  const ClosedForm worse = closed_form(campaign, scale);
  REQUIRE(worse.not_deployed > present.not_deployed);
  search.recommended = scale, search.confirmation = weaker->second;
  const Json found = margin_json(margin_report(campaign, result), Json::object());
  CHECK(found["confidence"] == 0.8);
  CHECK((found["report"] == json["report"] && found.at("case").is_null()));
  Campaign hot = campaign;
  hot.of_case = "hot";
  CHECK(margin_json(margin_report(hot, result), Json::object())["case"] == "hot");

  const Json& given_up = found["searches"][0]["recommended"]["given_up"];
  const Json& requirements = given_up["requirements"];
  REQUIRE(requirements.size() == 2);
  const std::array expected{std::pair(present.not_deployed, worse.not_deployed),
                            std::pair(present.too_fast, worse.too_fast)};
  for (std::size_t k = 0; k < 2; ++k) {
    const Json& each = requirements[k];
    CHECK(each["requirement"] == to_string(campaign.requirements[k]));
    CHECK(each["case"] == "nominal");
    CHECK(each["at_1"]["failures"]["seen"] == expected[k].first);
    CHECK(each["at_scale"]["failures"]["seen"] == expected[k].second);
  }
  CHECK(requirements[0]["at_1"]["quantile_over_runs"].is_null()); // of "deployed"
  // The rates are below 0, and smaller in size with weaker springs.
  const auto rate_at = [&](const char* key) {
    return requirements[1][key]["quantile_over_runs"].get<double>();
  };
  CHECK(rate_at("at_1") < rate_at("at_scale"));

  const Json& margins = given_up["static_margins"];
  REQUIRE(margins.size() == 4);
  const Json& gevs = margins[2];
  CHECK((gevs["margin"] == "gevs" && gevs["drive"] == "root"));
  CHECK(gevs["at_1"].get<double>() == Approx(0.2 / (3 * 0.8) - 1).epsilon(1e-12));
  CHECK(gevs["at_scale"].get<double>() == Approx(scale * 0.2 / (3 * 0.8) - 1).epsilon(1e-12));
}
