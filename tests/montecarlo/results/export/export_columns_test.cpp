#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/results/export/export_columns.hpp"
#include "montecarlo/results/export/hdf5_export.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("export: every column of runs.csv has a description, in its order") {
  Json json = full_campaign(1);
  json["scene"]["base"] = {{"motion", "free"}, {"mass", 500}, {"inertia", 300}};
  json["outputs"].push_back("base_motion");
  const Campaign campaign = campaign_of(json);
  const ResultNames names = RunPlan(campaign).names();
  const std::vector<ExportColumn> columns = export_columns(campaign, names);
  std::vector<std::string> found;
  for (const ExportColumn& column : columns) {
    CAPTURE(column.name);
    CHECK_FALSE(column.description.empty());
    found.push_back(column.name);
  }
  CHECK(found == header_cells(names));
}

TEST_CASE("export: a draw has its target's unit, unless it is a factor or goes by a table") {
  Json json = quick_campaign(1);
  json["dispersions"].push_back(parse_json(R"({
    "name": "offset", "distribution": { "type": "normal", "mean": 0, "std": 0.1 },
    "apply": "add", "to": ["hinges.root.angle.stowed"] })"));
  json["dispersions"].push_back(parse_json(R"({
    "name": "temperature", "distribution": { "type": "normal", "mean": 20, "std": 5 },
    "through": [ { "to": ["hinges.*.friction.viscous"], "apply": "add",
                   "table": { "at": [-100, 20], "value": [0.8, 0] } } ] })"));
  std::map<std::string, std::string> units;
  for (const Dispersion& dispersion : campaign_of(json).dispersions)
    units[dispersion.name] = draw_unit(dispersion);
  CHECK(units == std::map<std::string, std::string>{{"root_spring", ""},
                                                    {"mass.panel_1", "kg"},
                                                    {"mass.panel_2", "kg"},
                                                    {"mass.panel_3", "kg"},
                                                    {"offset", "rad"},
                                                    {"temperature", ""}});
}

TEST_CASE("export: a program without HDF5 says so") {
  if (has_hdf5()) return; // tests/export/
  CHECK_THROWS_WITH(export_hdf5("nowhere", "nowhere.h5"),
                    "this wingspread: found no HDF5 in it, expected one that was built with "
                    "Debian's package libhdf5-dev: install it, then configure and build again");
}
