#include "montecarlo/results/summary/verdict_json.hpp"

namespace wingspread {

Json evidence_json(const Verdict& verdict) {
  Json json{{"failures",
             {{"seen", verdict.failures()},
              {"allowed", verdict.allowed ? Json(*verdict.allowed) : Json(nullptr)}}}};
  if (verdict.cut > 0) {
    json["failures"]["peaks_cut"] = verdict.cut;
    json["failures"]["peaks_cut_within_limit"] = verdict.open;
  }
  if (verdict.absent > 0) json["failures"]["without_value"] = verdict.absent;
  json["observed"] = {{"share", json_number(verdict.share)}};
  json["guaranteed"] = {{"share", json_number(verdict.guaranteed_share)}};
  if (verdict.requirement.output != deployed_output) {
    json["observed"]["value"] = json_number(verdict.observed);
    json["guaranteed"]["value"] = json_number(verdict.guaranteed);
  }
  return json;
}

Json peaks_json(const PeaksCount& peaks) {
  const auto& [proven, cut, unknown, moments, forces] = peaks;
  Json json{{"true", proven}, {"false", cut}, {"missing", unknown}};
  if (moments != forces) json.update({{"moments_cut", moments}, {"forces_cut", forces}});
  return json;
}

} // namespace wingspread
