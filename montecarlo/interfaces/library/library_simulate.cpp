#include "core/deployment.hpp"
#include "montecarlo/foundation/platform/arithmetic.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/library/wingspread.hpp"
#include "montecarlo/report/text/check_report.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "montecarlo/report/text/trajectory.hpp"

#include <utility>

namespace wingspread::api {
namespace {

std::vector<Peak> peaks_of(const std::vector<wingspread::Peak>& peaks) {
  std::vector<Peak> plain;
  for (const auto& [value, time] : peaks) plain.push_back({value, time});
  return plain;
}

std::vector<Latch> latches_of(const Scene& scene, const wingspread::Outcome& outcome) {
  std::vector<Latch> plain;
  for (const LatchEvent& latch : outcome.latches)
    plain.push_back(
        {scene.hinges[latch.hinge].name, latch.time, latch.rates[latch.hinge], latch.rates});
  return plain;
}

Outcome plain_outcome(const Scene& scene, const wingspread::Outcome& outcome) {
  Outcome plain;
  plain.status = to_string(outcome.status);
  plain.reason = outcome.reason;
  plain.json = json_text(outcome_json(scene, outcome));
  for (const Hinge& hinge : scene.hinges) plain.hinges.push_back(hinge.name);
  plain.t_end = outcome.t_end;
  plain.latches = latches_of(scene, outcome);
  if (outcome.status != Status::failed) { // else a larger peak might have followed
    plain.peak_moment = peaks_of(outcome.peak_moment);
    plain.peak_force = peaks_of(outcome.peak_force);
  }
  plain.angles = outcome.final.angles;
  plain.rates = outcome.final.rates;
  return plain;
}

} // namespace

Input from_file(std::filesystem::path file) {
  if (file.empty() || file.native().find('\0') != std::string::npos)
    throw SpecError({{"", "file", file.empty() ? "an empty path" : "a path with a NUL",
                      "the path of a scene or of a campaign"}});
  return {std::move(file), {}, {}};
}

Input from_text(std::string json, std::filesystem::path directory) {
  return {{}, std::move(json), std::move(directory)};
}

Outcome simulate(const Input& input, const Settings& settings, std::optional<double> interval,
                 bool check, const std::atomic<bool>* stop) {
  const DefaultArithmetic arithmetic;
  const Task task = task_of(read_input(input), settings);
  if (interval && *interval != 0) check_interval(*interval, task.integration.t_end);
  Goal goal;
  goal.to_t_end = true;
  goal.sample_interval = interval.value_or(0);
  std::vector<Series> trajectory;
  if (interval)
    for (const std::string& column : trajectory_columns(task.scene))
      trajectory.push_back({column, {}});
  const auto keep = [&](const Sample& sample) {
    if (stop && *stop) throw Stopped();
    auto series = trajectory.begin();
    take_sample(sample, task.scene.base.motion,
                [&](double value) { (series++)->values.push_back(value); });
  };
  const auto watch = [&](const Sample& /*sample*/) {
    if (stop && *stop) throw Stopped();
  };
  const Observer observer = interval ? Observer(keep) : stop ? Observer(watch) : Observer();
  const wingspread::Outcome outcome =
      Deployment().run(task.scene, task.integration, goal, observer);
  Outcome plain = plain_outcome(task.scene, outcome);
  goal.sample_interval = 0;
  if (check) {
    Json json = outcome_json(task.scene, outcome);
    json["check"] = check_json(check_of(task, goal, outcome));
    plain.json = json_text(json);
  }
  plain.trajectory = std::move(trajectory);
  plain.notices = notices_of(task, input.file);
  return plain;
}

} // namespace wingspread::api
