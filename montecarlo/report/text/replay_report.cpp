#include "montecarlo/report/text/replay_report.hpp"

#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "montecarlo/report/text/outcome_report.hpp"

#include <fmt/format.h>

namespace wingspread {

Json replay_json(const Replayed& replayed) {
  Json json = outcome_json(replayed.scene, replayed.outcome);
  json["run"] = replayed.row.run;
  json["draws"] = Json::object();
  for (std::size_t i = 0; i < replayed.row.draws.size(); ++i)
    json["draws"][replayed.names.draws[i]] = replayed.row.draws[i];
  json["same_as_recorded"] = replayed.recorded ? Json(replayed.differences.empty()) : Json(nullptr);
  return json;
}

std::string replay_text(const Replayed& replayed) {
  std::string text = outcome_text(replayed.scene, replayed.outcome);
  if (!replayed.row.draws.empty()) text += "\nDRAW\n";
  for (std::size_t i = 0; i < replayed.row.draws.size(); ++i)
    text += fmt::format("  {:<40}{:>24.17g}\n", replayed.names.draws[i], replayed.row.draws[i]);
  if (!replayed.recorded)
    text += fmt::format("\nRun {} is not in {}: no comparison.\n", replayed.row.run, replayed.file);
  else if (replayed.differences.empty())
    text += fmt::format("\nRun {} equals the one in {}, bit for bit.\n", replayed.row.run,
                        replayed.file);
  return text;
}

std::string options_of(const Integration& integration, const Outcome& replayed) {
  const Integration usual;
  std::string text;
  const auto add = [&](const char* option, const auto& value, const auto& by_default) {
    if (value != by_default) text += fmt::format(" --{} {}", option, value);
  };
  add("method", integration.method, usual.method);
  if (has_fixed_step(integration.method)) add("step", integration.step, 0.0);
  add("rtol", integration.rtol, usual.rtol);
  add("atol", integration.atol, usual.atol);
  add("t-end", integration.t_end, usual.t_end);
  // `simulate` goes on to t_end: fewer steps than usual might end it after a replay that ended well
  if (integration.max_steps > usual.max_steps || replayed.status == Status::failed)
    add("max-steps", integration.max_steps, usual.max_steps);
  if (integration.smoothing) text += fmt::format(" --latch smoothed:{}", *integration.smoothing);
  return text;
}

} // namespace wingspread
