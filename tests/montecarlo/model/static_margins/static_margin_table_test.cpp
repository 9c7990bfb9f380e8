// The table of static margins against the study that it shows.
#include "montecarlo/engine/runs/static_margin_draws.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <set>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("each line of the table of static margins has its own standard's numbers",
          "[motorization]") {
  Json json = one_panel_margin(60);
  json["margin"]["springs_per_hinge"] = 4;
  json["statistics"] = {{"quantiles", {0.1, 0.5}}};
  const Campaign campaign = campaign_of(json);
  StaticMarginReport report{
      campaign.motorization, campaign.scene, campaign.statistics.quantiles, {}};
  report.cases.push_back({1, "", study_static_margins(campaign)});
  DriveMargins& drive = report.cases[0].study.drives.at(0);
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) { // no two alike
    const auto k = static_cast<double>(kind);
    drive.worst[kind] = 1 + k, drive.worst_angle[kind] = 0.1 * k;
    MarginSpread& spread = drive.worst_spread[kind];
    spread.quantiles = {0.5 + k / 10, 2 + k / 10};
    spread.least = -0.25 - k, spread.worst_run = 100 + static_cast<long>(kind);
  }
  const std::string table = static_margins_text(report);
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
    const std::string name(margin_kind_texts[kind]);
    CAPTURE(name);
    std::istringstream lines(table.substr(table.find("\nSCALE") + 1));
    std::vector<std::string> cells;
    for (std::string line; cells.empty() && std::getline(lines, line);)
      if (const std::size_t at = line.find(" " + name + " "); at != std::string::npos) {
        std::istringstream in(line.substr(at + 1 + name.size()));
        for (std::string cell; in >> cell;) cells.push_back(cell);
      }
    const auto k = static_cast<double>(kind);
    CHECK(cells == std::vector<std::string>{fmt::format("{:+.2f}", 1 + k), degrees_text(0.1 * k),
                                            fmt::format("{:+.2f}", 0.5 + k / 10),
                                            fmt::format("{:+.2f}", -0.25 - k),
                                            std::to_string(100 + kind)});
  }
}
