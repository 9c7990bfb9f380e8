#include "montecarlo/model/campaign/outputs.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "montecarlo/report/text/trajectory.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

#include <set>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::filesystem::path root = source_folder;

/// With HINGE for the scene's own names, and OTHER behind rate_at; empty for a name alone.
std::string general(std::string name) {
  for (const char* hinge : {"root", "mid", "tip"}) {
    if (name == hinge) return "";
    if (name.starts_with(std::string(hinge) + '.'))
      name.replace(0, 3 + (*hinge == 'r' ? 1 : 0), "HINGE");
    if (const std::size_t at = name.find(std::string(".rate_at.") + hinge); at != std::string::npos)
      name.replace(at, std::string::npos, ".rate_at.OTHER");
  }
  return name;
}

void take_keys(const Json& json, std::set<std::string>& names) {
  if (json.is_object())
    for (const auto& [key, value] : json.items()) {
      names.insert(general(key));
      take_keys(value, names);
    }
  if (json.is_array())
    for (const Json& element : json) take_keys(element, names);
}

void take_cells(const std::string& line, std::set<std::string>& names) {
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) names.insert(general(cell));
}

Campaign everything() {
  Json json = quick_campaign(50);
  json["scene"]["base"] = {{"motion", "free"}, {"mass", 500}, {"inertia", 300}};
  json["outputs"] = Json::array();
  for (const std::string_view family : output_family_names) json["outputs"].push_back(family);
  json["dispersions"] = Json::array();
  json["requirements"] = parse_json(R"([
    { "output": "deployed", "probability": 0.9, "confidence": 0.9, "group": "A" },
    { "output": "root.latch_rate", "max": 1, "abs": true, "probability": 0.9, "confidence": 0.9,
      "group": "A" } ])");
  json["statistics"] =
      parse_json(R"({ "tolerance": [{ "probability": 0.9, "confidence": 0.9, "side": "both" }] })");
  return campaign_of(json);
}

/// Names that a results folder, a trajectory and the JSON of a run have.
std::set<std::string> all_names() {
  const Folder folder;
  const Campaign campaign = everything();
  (void)run_into(folder.path() / "r", campaign);
  std::set<std::string> names;
  std::istringstream rows(read_text(folder.path() / "r" / runs_file).value());
  std::string header;
  std::getline(rows, header);
  take_cells(header, names);
  Json summary = parse_json_file(folder.path() / "r" / summary_file);
  summary.erase("definitions"); // words of their own
  summary.erase("wingspread");
  summary["latch_order"].clear(); // orders of this campaign
  take_keys(summary, names);
  TrajectoryWriter writer(folder.path() / "t.csv", campaign.scene);
  const Outcome outcome =
      Deployment().run(campaign.scene, campaign.integration, {}, writer.observer());
  writer.finish();
  std::istringstream samples(read_text(folder.path() / "t.csv").value());
  std::getline(samples, header);
  take_cells(header, names);
  take_keys(outcome_json(campaign.scene, outcome), names);
  for (const std::string_view family : output_family_names) names.insert(std::string(family));
  for (const Status status : statuses) names.insert(to_string(status));
  names.erase("");
  return names;
}

} // namespace

TEST_CASE(
    "every name that the program writes is on the page of outputs, and the page in the README") {
  const std::string page = read_text(root / "montecarlo/OUTPUTS.md").value();
  const std::set<std::string> names = all_names();
  CHECK(names.size() > 90); // what is collected is not cut short
  for (const std::string& name : names) {
    CAPTURE(name);
    CHECK(page.find('`' + name + '`') != std::string::npos);
  }
  CHECK(read_text(root / "README.md").value().find("(montecarlo/OUTPUTS.md)") != std::string::npos);
}
