#include "montecarlo/sensitivity/design_folder.hpp"

#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/folder/folder_writer.hpp"
#include "montecarlo/folder/replay.hpp"
#include "montecarlo/folder/version.hpp"
#include "montecarlo/formats/files.hpp"
#include "montecarlo/formats/input_file.hpp"
#include "montecarlo/formats/json.hpp"
#include "montecarlo/formats/json_reader.hpp"

namespace wingspread {
namespace {

/// The design's own part: what its hash is of.
Json body(const SaltelliDesign& design) {
  return {{"samples", design.rows}, {"campaign", design.campaign.resolved}};
}

std::string design_text(const SaltelliDesign& design) {
  Json json{{stamp_key, stamp_json(stamp_of(design))}};
  json.update(body(design));
  return json_text(json);
}

void refuse_other_design(const std::filesystem::path& folder, const SaltelliDesign& design) {
  const std::filesystem::path path = folder / design_file;
  const auto there = read_text(path);
  if (there != design_text(design))
    throw SpecError({{path.string(), "", there ? "another design or version" : "no such file",
                      "this campaign, seed, number of samples and version, to continue it"}});
}

} // namespace

Stamp stamp_of(const SaltelliDesign& design) {
  return {std::string(version()), design.campaign.sampling.seed, campaign_hash(body(design)), {}};
}

bool is_design_folder(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / design_file) &&
         !std::filesystem::exists(folder / campaign_file);
}

SaltelliDesign read_design(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / design_file;
  const Json document = parse_json_file(path);
  std::vector<Problem> problems;
  JsonObject object(JsonCursor(document, path.string(), problems), "a design: an object");
  std::int64_t rows = 0;
  object.required("samples", rows, "an integer, ≥ 1");
  const auto stamp = object.require(stamp_key, "version, seed and hash");
  const auto campaign = object.require("campaign", "a campaign");
  object.refuse_others();
  if (!problems.empty()) throw SpecError(std::move(problems));
  SaltelliDesign design{read_campaign(campaign->value().dump(), folder, path.string()), rows};
  const Json& there = stamp->value();
  const bool same = there.is_object() && there.value("hash", Json()) == stamp_of(design).hash;
  if (rows < 1 || !same)
    throw SpecError({{path.string(), "/wingspread/hash", "that of another design",
                      "a design that nobody changed after it was run"}});
  return design;
}

ResultsFile read_design_runs(const std::filesystem::path& folder, const RunPlan& plan) {
  const std::filesystem::path path = folder / design_runs_file;
  if (!std::filesystem::exists(path)) return {Results(plan.names()), 0, false};
  InputFile in(path);
  ResultsFile read = read_results(in, path.string(), plan.names(), UnterminatedRow::drop);
  refuse_gaps(read.results, 0, path);
  return read;
}

DesignFolderWriter::DesignFolderWriter(const std::filesystem::path& folder,
                                       const SaltelliDesign& design, const RunPlan& plan,
                                       bool resume)
    : rows_(folder / design_runs_file, plan.names()) {
  const bool goes_on = resume && std::filesystem::exists(folder / design_file);
  if (!goes_on)
    refuse_used_folder(folder, "a new or an empty folder (--resume continues a design)");
  lock_.emplace(folder);
  if (goes_on) {
    refuse_other_design(folder, design);
    ResultsFile read = read_design_runs(folder, plan);
    refuse_other_rows(plan, read.results, folder / design_runs_file);
    rows_.go_on_behind(std::move(read), 0);
  } else {
    write_file(folder / design_file, design_text(design));
  }
  rows_.open(plan.names());
}

} // namespace wingspread
