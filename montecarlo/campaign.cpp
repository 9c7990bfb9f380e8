#include "montecarlo/campaign.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/json_reader.hpp"
#include "montecarlo/scene_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace wingspread {
namespace {

constexpr const char* expected_scene = "a scene, or the name of the file that holds it";
constexpr const char* stamp_key = "wingspread"; // holds version, seed and hash in a results folder

/// What the format names and this version cannot do: refused here, and never ignored.
void refuse_unavailable(JsonObject& campaign, DesignKind design) {
  for (const char* key : {"correlations", "requirements", "margin"})
    if (const auto at = campaign.find(key))
      at->refuse(fmt::format("no \"{}\": not available in this version", key));
  if (!is_available(design))
    campaign.at()
        .member("sampling")
        .member("design")
        .refuse("\"random\": the other designs are not available in this version");
}

/// A scene that stands in the campaign, or in the file that is named there.
Scene read_scene_member(const JsonCursor& at, const std::filesystem::path& directory) {
  if (!at.value().is_string()) return read_scene(at);
  const std::filesystem::path path = directory / at.value().get<std::string>();
  const auto text = read_text(path);
  try {
    if (text) {
      const Json document = parse_json(*text, path.string());
      return read_scene(JsonCursor(document, path.string(), at.problems()));
    }
    at.refuse(fmt::format("no file that can be read at \"{}\"", path.string()), expected_scene);
  } catch (const SpecError& error) {
    at.problems().insert(at.problems().end(), error.problems().begin(), error.problems().end());
  }
  return {};
}

Json write_campaign(const Campaign& campaign, Json dispersions) {
  return {{"scene", write_scene(campaign.scene)},
          {"dispersions", std::move(dispersions)},
          {"sampling", write_sampling(campaign.sampling)},
          {"integration", write_integration(campaign.integration)},
          {"outputs", write_outputs(campaign.outputs)},
          {"statistics", write_statistics(campaign.statistics)}};
}

/// @throws SpecError with all that is wrong
Campaign read_document(const Json& document, const std::filesystem::path& directory,
                       const std::string& file) {
  std::vector<Problem> problems;
  Campaign campaign;
  JsonObject object(JsonCursor(document, file, problems), "a campaign: an object");
  if (const auto scene = object.require("scene", expected_scene))
    campaign.scene = read_scene_member(*scene, directory);
  const Scene* usable = problems.empty() ? &campaign.scene : nullptr;
  Dispersions dispersions{{}, Json::array()};
  if (const auto list = object.find("dispersions"))
    dispersions = read_dispersions(*list, usable, directory);
  if (const auto at = object.find("sampling")) read_sampling(*at, campaign.sampling);
  if (const auto at = object.find("integration")) read_integration(*at, campaign.integration);
  if (const auto at = object.find("outputs")) read_outputs(*at, campaign.outputs);
  if (const auto at = object.find("statistics")) read_statistics(*at, campaign.statistics);
  refuse_unavailable(object, campaign.sampling.design);
  (void)object.find(stamp_key); // known, and of no account
  object.refuse_others();
  if (!problems.empty()) throw SpecError(std::move(problems));
  campaign.dispersions = std::move(dispersions.list);
  campaign.resolved = write_campaign(campaign, std::move(dispersions.resolved));
  return campaign;
}

void apply_draw(Apply how, double draw, double& target) {
  switch (how) {
  case Apply::set:
    target = draw;
    break;
  case Apply::scale:
    target *= draw;
    break;
  case Apply::add:
    target += draw;
    break;
  }
}

} // namespace

Campaign read_campaign(const std::string& text, const std::filesystem::path& directory,
                       const std::string& file) {
  return read_document(parse_json(text, file), directory, file);
}

Campaign read_campaign_file(const std::filesystem::path& path) {
  return read_document(parse_json_file(path), path.parent_path(), path.string());
}

Scene read_scene_file(const std::filesystem::path& path) {
  return read_scene(parse_json_file(path), path.string());
}

std::variant<Scene, Campaign> read_file(const std::filesystem::path& path) {
  const Json document = parse_json_file(path);
  constexpr std::array campaign_keys{"scene", "dispersions", "sampling"};
  const auto has = [&](const char* key) { return document.contains(key); };
  if (std::ranges::any_of(campaign_keys, has))
    return read_document(document, path.parent_path(), path.string());
  return read_scene(document, path.string());
}

void override_sampling(Campaign& campaign, std::optional<std::int64_t> runs,
                       std::optional<std::uint64_t> seed) {
  campaign.sampling.runs = runs.value_or(campaign.sampling.runs);
  campaign.sampling.seed = seed.value_or(campaign.sampling.seed);
  campaign.resolved["sampling"] = write_sampling(campaign.sampling);
}

std::string campaign_hash(const Json& resolved) {
  Json hashed = resolved;
  hashed.erase(stamp_key);
  return fmt::format("{:016x}", stream_name(hashed.dump()).hash); // FNV-1a
}

void apply(const Campaign& campaign, std::span<const double> draws, const Scene& nominal,
           Scene& run_scene) {
  assert(draws.size() == campaign.dispersions.size());
  for (const Dispersion& dispersion : campaign.dispersions)
    for (const ParameterRef& target : dispersion.targets) target.in(run_scene) = target.in(nominal);
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Dispersion& dispersion = campaign.dispersions[i];
    for (const ParameterRef& target : dispersion.targets)
      apply_draw(dispersion.apply, draws[i], target.in(run_scene));
  }
}

} // namespace wingspread
