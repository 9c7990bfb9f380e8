#include "montecarlo/analyses/sensitivity/design_folder.hpp"

#include "montecarlo/engine/runs/row_reader.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/input_file.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/results_folder/replay.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

/// The part of design.json that its hash covers.
Json body(const SaltelliDesign& design) {
  return {{"samples", design.rows}, {"campaign", design.campaign.resolved}};
}

Json bounds_json(const BoundsAsked& asked) {
  Json json = Json::object();
  if (asked.resamples) json["resamples"] = *asked.resamples;
  if (asked.confidence) json["confidence"] = *asked.confidence;
  return json;
}

BoundsAsked read_bounds(const JsonCursor& at) {
  BoundsAsked asked;
  JsonObject object(at, "an object with resamples and confidence");
  if (object.find("resamples"))
    object.required("resamples", asked.resamples.emplace(), "an integer");
  if (object.find("confidence"))
    object.required("confidence", asked.confidence.emplace(), "a number, > 0 and < 1",
                    is_proper_share);
  object.refuse_others();
  return asked;
}

void refuse_other_design(const std::filesystem::path& folder, const SaltelliDesign& design) {
  const std::filesystem::path path = folder / design_file;
  const auto there = read_text(path);
  if (there != design_text(design))
    throw SpecError({{path.string(), "", there ? "another design or version" : "no such file",
                      "this campaign, seed, number of samples, --resamples, --confidence, shard "
                      "and version, to "
                      "continue it"}});
}

} // namespace

Stamp stamp_of(const SaltelliDesign& design) {
  return {std::string(version()), design.campaign.sampling.seed, campaign_hash(body(design)),
          design.shard, std::nullopt};
}

RunRange runs_of(const SaltelliDesign& design) {
  return shard_runs(
      saltelli_runs(design.rows, coordinates_of(design.campaign.dispersions).names.size()),
      design.shard);
}

std::string design_text(const SaltelliDesign& design) {
  Json json{{stamp_key, stamp_json(stamp_of(design))}};
  json.update(body(design));
  if (Json bounds = bounds_json(design.bounds); !bounds.empty()) json["bounds"] = std::move(bounds);
  return json_text(json);
}

bool is_design_file(const std::filesystem::path& path) {
  const Json document = parse_json_file(path);
  return document.is_object() && document.contains("samples") && document.contains("campaign");
}

bool is_design_folder(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / design_file) &&
         !std::filesystem::exists(folder / campaign_file);
}

SaltelliDesign read_design(const std::filesystem::path& folder) {
  return read_design_file(folder / design_file);
}

SaltelliDesign read_design_file(const std::filesystem::path& path) {
  const Json document = parse_json_file(path);
  std::vector<Problem> problems;
  JsonObject object(JsonCursor(document, path.string(), problems), "a design: an object");
  std::int64_t rows = 0;
  object.required("samples", rows, "an integer, ≥ 1");
  (void)object.require(stamp_key, "version, seed and hash");
  const auto campaign = object.require("campaign", "a campaign");
  const auto bounds = object.find("bounds");
  const BoundsAsked asked = bounds ? read_bounds(*bounds) : BoundsAsked{};
  object.refuse_others();
  const Stamp there = read_stamp(JsonCursor(document, path.string(), problems));
  if (!problems.empty()) throw SpecError(std::move(problems));
  SaltelliDesign design{read_campaign(campaign->value().dump(), path.parent_path(), path.string()),
                        rows, there.shard, asked};
  if (rows < 1 || there.hash != stamp_of(design).hash)
    throw SpecError({{path.string(), "/wingspread/hash", "that of another design",
                      "an unchanged design.json"}});
  return design;
}

ResultsFile read_design_runs(const std::filesystem::path& folder, const RunPlan& plan, long first) {
  const std::filesystem::path path = folder / design_runs_file;
  if (!std::filesystem::exists(path)) return {Results(plan.names()), 0, false};
  InputFile in(path);
  ResultsFile read = read_results(in, path.string(), plan.names(), UnterminatedRow::drop);
  refuse_gaps(read.results, first, path);
  return read;
}

void for_each_design_row(const std::filesystem::path& folder, const RunPlan& plan, RunRange own,
                         const std::function<void(const ResultRow&)>& take) {
  const std::filesystem::path path = folder / design_runs_file;
  if (!std::filesystem::exists(path)) return;
  InputFile in(path);
  RowReader reader(in, path.string(), plan.names(), UnterminatedRow::drop);
  while (reader.next()) {
    if (const long run = reader.row().run; run < own.first || run >= own.last)
      throw SpecError({{path.string(), "", fmt::format("run {}", run),
                        fmt::format("runs from {} up to {}", own.first, own.last - 1)}});
    take(reader.row());
  }
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
    ResultsFile read = read_design_runs(folder, plan, runs_of(design).first);
    refuse_other_rows(plan, read.results, folder / design_runs_file);
    rows_.continue_after(std::move(read), runs_of(design).first);
  } else {
    write_file(folder / design_file, design_text(design));
  }
  rows_.open();
}

} // namespace wingspread
