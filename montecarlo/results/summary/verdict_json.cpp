#include "montecarlo/results/summary/verdict_json.hpp"

namespace wingspread {

Json evidence_json(const Verdict& verdict) {
  Json json{{"failures",
             {{"seen", verdict.failures()},
              {"allowed", verdict.allowed ? Json(*verdict.allowed) : Json(nullptr)}}}};
  json["observed"] = {{"share", json_number(verdict.share)}};
  json["guaranteed"] = {{"share", json_number(verdict.guaranteed_share)}};
  if (verdict.requirement.output != deployed_output) {
    json["observed"]["value"] = json_number(verdict.observed);
    json["guaranteed"]["value"] = json_number(verdict.guaranteed);
  }
  return json;
}

} // namespace wingspread
