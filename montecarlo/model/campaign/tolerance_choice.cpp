#include "montecarlo/model/campaign/tolerance_choice.hpp"

namespace wingspread {
namespace {

bool is_some(const std::int64_t& number) { return number >= 1; }

void read_repeated(const JsonCursor& at, std::vector<std::int64_t>& repeated) {
  constexpr const char* expected = "an array of integers ≥ 0, each less than the next";
  if (!at.value().is_array()) return void(at.refuse(expected));
  for (const JsonCursor& element : at.elements()) {
    std::int64_t run = 0;
    if (!element.read(run, expected)) return;
    if (run < 0 || (!repeated.empty() && run <= repeated.back()))
      return void(element.refuse(expected));
    repeated.push_back(run);
  }
}

TolerancePilot read_pilot(const JsonCursor& at) {
  TolerancePilot pilot;
  JsonObject object(at, "what `wingspread run` wrote of its pilot: an object");
  object.required("seed", pilot.seed, "an integer from 0 to 2^64 - 1");
  object.required("runs", pilot.runs, "an integer, ≥ 1", is_some);
  object.required("for_runs", pilot.for_runs, "an integer, ≥ 1", is_some);
  if (const auto repeated = object.require("repeated", "an array of runs"))
    read_repeated(*repeated, pilot.repeated);
  if (const auto reached = object.find("not_reached")) {
    pilot.reached = reached->value() != true;
    if (pilot.reached) reached->refuse("true, or no such key");
  }
  object.refuse_others();
  return pilot;
}

} // namespace

void read_tolerance_choice(JsonObject& integration, bool automatic,
                           std::optional<ToleranceChoice>& choice) {
  const auto share = integration.find("rtol_share"), pilot = integration.find("rtol_pilot");
  if (automatic && pilot)
    pilot->refuse("a pilot's record beside \"rtol\": \"auto\"", "it beside the tolerance it chose");
  if (share && !automatic && !pilot)
    share->refuse("a share of the sampling error beside a fixed \"rtol\"", "\"rtol\": \"auto\"");
  if (!automatic && !pilot) return;
  choice.emplace();
  choice->has_atol = integration.find("atol").has_value();
  integration.optional("rtol_share", choice->share, "a number, > 0 and < 1", is_proper_share);
  if (pilot && !automatic) choice->pilot = read_pilot(*pilot);
}

void write_tolerance_choice(const ToleranceChoice& choice, Json& integration) {
  integration["rtol_share"] = choice.share;
  if (!choice.pilot) {
    integration["rtol"] = "auto";
    if (!choice.has_atol) integration.erase("atol");
    return;
  }
  const auto& [seed, runs, repeated, for_runs, reached] = *choice.pilot;
  Json pilot{{"seed", seed}, {"runs", runs}, {"for_runs", for_runs}, {"repeated", repeated}};
  if (!reached) pilot["not_reached"] = true;
  integration["rtol_pilot"] = std::move(pilot);
}

} // namespace wingspread
