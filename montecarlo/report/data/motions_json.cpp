#include "montecarlo/report/data/motions_json.hpp"

#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/report/data/motion.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/results/results_folder/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

constexpr std::array other_statuses{Status::stalled, Status::timed_out, Status::failed};

/// Collects runs, each once, at most `most`.
class Choice {
public:
  Choice(const Results& results, std::size_t most) : results_(results), most_(most) {}

  void add(std::string label, std::string why, long run) {
    if (chosen_.size() < most_ && !std::ranges::count(chosen_, run, &ChosenRun::run))
      chosen_.push_back({std::move(label), std::move(why), run});
  }
  void add_row(std::string label, std::string why, std::size_t row) {
    add(std::move(label), std::move(why), results_.runs[row]);
  }
  [[nodiscard]] std::size_t size() const { return chosen_.size(); }
  [[nodiscard]] std::vector<ChosenRun> take() { return std::move(chosen_); }

private:
  const Results& results_;
  std::size_t most_;
  std::vector<ChosenRun> chosen_;
};

const Column* column_named(const Results& results, std::string_view name) {
  const auto found = std::ranges::find(results.outputs, name, &Column::name);
  return found == results.outputs.end() ? nullptr : &*found;
}

/// The row with the largest value, the first of equals; none without values.
std::optional<std::size_t> largest(const Column& column) {
  std::optional<std::size_t> best;
  for (std::size_t row = 0; row < column.values.size(); ++row)
    if (!std::isnan(column.values[row]) && (!best || column.values[row] > column.values[*best]))
      best = row;
  return best;
}

/// Adds the run with the median deployment time, the first of equals. Without rows that run is unknown.
void add_median(const PageSource& source, Choice& choice) {
  if (!source.has_rows()) return;
  const Column* column = column_named(source.results, "deployment_time");
  if (!column) return;
  std::vector<double> times;
  std::ranges::copy_if(column->values, std::back_inserter(times),
                       [](double time) { return !std::isnan(time); });
  if (times.empty()) return;
  const auto middle = times.begin() + (quantile_rank(std::ssize(times), 0.5) - 1);
  std::ranges::nth_element(times, middle);
  const auto row = std::ranges::find(column->values, *middle) - column->values.begin();
  choice.add_row("median run", "median deployment time of the deployed runs",
                 static_cast<std::size_t>(row));
}

/// Adds one run for a requirement: the deployed run with the worst value or, if none has a value, the run with the
/// fewest latched hinges.
void add_worst_of(const PageSource& source, const Verdict& verdict, Choice& choice) {
  const BrokenRuns broken = broken_runs_of(source, verdict, 1);
  const std::string label = "worst: " + name_of(verdict.requirement);
  if (broken.worst)
    choice.add(label, broken.beyond > 0 ? "farthest beyond the limit" : "nearest to the limit",
               broken.worst->run);
  else if (!broken.not_deployed_runs.empty())
    choice.add(label, "did not deploy, with the fewest latched hinges",
               broken.not_deployed_runs.front().run);
  else if (!verdict.broken.empty())
    choice.add(label, "breaks the requirement", verdict.broken.front());
}

/// The run with the largest value of an output; nothing without values.
std::optional<JudgedRun> largest_of(const PageSource& source, std::size_t output) {
  if (!source.has_rows()) {
    const Population& values = source.streaming->outputs()[output].values;
    if (values.count() == 0) return std::nullopt;
    const RunValue most = values.highest().sorted().front();
    return JudgedRun{most.run, most.value};
  }
  const Column& column = source.results.outputs[output];
  const auto row = largest(column);
  if (!row) return std::nullopt;
  return JudgedRun{source.results.runs[*row], column.values[*row]};
}

/// Adds the run with the largest value of any output of a family.
void add_largest_of(const PageSource& source, std::string_view family, Choice& choice) {
  std::string of;
  JudgedRun best;
  for (std::size_t output = 0; output < source.results.outputs.size(); ++output) {
    const std::string& name = source.results.outputs[output].name;
    const std::size_t dot = name.rfind('.');
    if (std::string_view(name).substr(dot == std::string::npos ? 0 : dot + 1) != family) continue;
    const auto found = largest_of(source, output);
    if (!found || (!of.empty() && found->value <= best.value)) continue;
    of = name;
    best = *found;
  }
  if (!of.empty()) choice.add("largest " + of, "largest " + of + " of all runs", best.run);
}

/// Adds the run with the fewest latched hinges of each status except `deployed` and `invalid` (no motion).
void add_statuses(const PageSource& source, Choice& choice) {
  for (const Status status : other_statuses)
    for (const LatchedRun& each : fewest_latched(source.results, status, 1))
      choice.add(spaced(to_string(status)),
                 fmt::format("of the runs that {}, one with the fewest latched hinges",
                             status == Status::stalled  ? "stalled"
                             : status == Status::failed ? "failed numerically"
                                                        : "did not end by t_end"),
                 each.run);
}

/// The page's MOTION of a run.
Json motion_json(const Scene& scene, MotionRecorder& recorder, const Outcome& outcome,
                 std::size_t most) {
  const MotionLayout layout{scene.hinges.size()};
  std::vector<double> latched;
  for (const LatchEvent& latch : outcome.latches) latched.push_back(latch.time);
  pin_only(recorder.samples(), latched);
  const std::vector<MotionSample> samples = resample(recorder.samples(), layout, most);
  const auto column = [&](std::size_t place, int digits) {
    Json json = Json::array();
    for (const MotionSample& sample : samples)
      json.push_back(page_number(sample.values[place], digits));
    return json;
  };
  Json json{{"status", to_string(outcome.status)}, {"reason", outcome.reason}};
  json["t"] = Json::array();
  for (const MotionSample& sample : samples) json["t"].push_back(page_number(sample.t));
  for (const char* key : {"angles", "rates", "moments"}) json[key] = Json::array();
  for (std::size_t h = 0; h < layout.hinges; ++h) {
    json["angles"].push_back(column(layout.angle(h), 6));
    json["rates"].push_back(column(layout.rate(h), 5));
    json["moments"].push_back(column(layout.moment(h), 5));
  }
  json["base"] = nullptr;
  if (scene.base.motion != BaseMotion::fixed)
    json["base"] = {{"x", column(layout.base(), 6)},
                    {"y", column(layout.base() + 1, 6)},
                    {"angle", column(layout.base() + 2, 6)}};
  json["latches"] = Json::array();
  for (const LatchEvent& latch : outcome.latches)
    json["latches"].push_back({{"hinge", latch.hinge}, {"time", page_number(latch.time)}});
  json["events"] = Json::array();
  for (const auto& [kind, events] : {std::pair("released", &outcome.releases),
                                     {"missed", &outcome.missed},
                                     {"let_go", &outcome.let_go}})
    for (const HingeEvent& event : *events)
      json["events"].push_back(
          {{"kind", kind}, {"hinge", event.hinge}, {"time", page_number(event.time)}});
  for (const auto& [key, peaks] :
       {std::pair("peaks", &outcome.peak_moment), {"force_peaks", &outcome.peak_force}}) {
    json[key] = Json::array();
    for (std::size_t h = 0; h < peaks->size(); ++h)
      json[key].push_back({{"hinge", h},
                           {"value", page_number((*peaks)[h].value)},
                           {"time", page_number((*peaks)[h].time)}});
  }
  return json;
}

/// Records a run until the moments have settled after `since`, or to t_end.
/// @param run makes the run with the observer passed to it; the observer ends the run by an exception
template <class Run>
void record_until_settled(double since, const MotionLayout& layout, MotionRecorder& recorder,
                          Run run) {
  struct Settled {};
  long seen = 0, next = 64; // each check reads all samples, so checks become rarer
  try {
    run([&, record = recorder.observer()](const Sample& sample) {
      record(sample);
      if (++seen < next || sample.t <= since) return;
      if (has_settled(recorder.samples(), layout, since)) throw Settled{};
      next = seen + seen / 16 + 16;
    });
  } catch (const Settled&) {
  }
}

/// The last latch; 0 without latches.
double last_latch(const Outcome& outcome) {
  return outcome.latches.empty() ? 0 : outcome.latches.back().time;
}

Json nominal_json(const PageSource& source, std::size_t most) {
  const Campaign& campaign = source.stored.campaign;
  const Scene scene = nominal_scene(campaign);
  Goal goal = goal_of(campaign.outputs);
  const Outcome outcome = Deployment().run(scene, campaign.integration, goal);
  goal.to_t_end = true;
  MotionRecorder recorder(scene.hinges.size());
  record_until_settled(last_latch(outcome), {scene.hinges.size()}, recorder,
                       [&](const Observer& observer) {
                         (void)Deployment().run(scene, campaign.integration, goal, observer);
                       });
  Json json{{"label", "nominal"},
            {"why", "dispersions at their medians"},
            {"run", nullptr},
            {"replay", fmt::format("wingspread simulate {}",
                                   shell_word((source.stored.folder / campaign_file).string()))}};
  json.update(motion_json(campaign.scene, recorder, outcome, most));
  return json;
}

/// Columns in which the recorded row of a run differs from the run made again. Last digits may differ on another machine.
std::vector<std::string> recorded_otherwise(const PageSource& source, const ResultNames& names,
                                            ResultRow made) {
  const auto at = std::ranges::lower_bound(source.results.runs, made.run);
  if (at == source.results.runs.end() || *at != made.run) return {};
  const ResultRow recorded =
      source.results.row(static_cast<std::size_t>(at - source.results.runs.begin()));
  constexpr double digits = 1e-6;
  const auto keep_near = [](const std::vector<double>& there, std::vector<double>& here) {
    for (std::size_t i = 0; i < there.size(); ++i)
      if (std::abs(here[i] - there[i]) <= digits * std::abs(there[i])) here[i] = there[i];
  };
  keep_near(recorded.draws, made.draws);
  keep_near(recorded.outputs, made.outputs);
  if (made.reason != recorded.reason && made.status == recorded.status)
    made.reason = recorded.reason; // it has numbers of the run
  return differences(names, recorded, made);
}

Json chosen_json(const PageSource& source, const RunPlan& plan, const ChosenRun& chosen,
                 std::size_t most) {
  Runner runner(plan);
  const Runner::Replay made = runner.replay(chosen.run, {});
  const MotionLayout layout{source.stored.campaign.scene.hinges.size()};
  MotionRecorder recorder(layout.hinges);
  Goal goal = plan.goal();
  goal.to_t_end = true;
  record_until_settled(last_latch(made.outcome), layout, recorder, [&](const Observer& observer) {
    (void)runner.watch(chosen.run, goal, plan.campaign().integration.t_end, observer);
  });
  Json json{{"label", chosen.label},
            {"why", chosen.why},
            {"run", chosen.run},
            {"replay", replay_command(source.stored.folder.string(), chosen.run)},
            {"differs", recorded_otherwise(source, plan.names(), made.row)}};
  json.update(motion_json(source.stored.campaign.scene, recorder, made.outcome, most));
  return json;
}

} // namespace

std::vector<ChosenRun> chosen_runs(const PageSource& source, std::size_t most) {
  Choice choice(source.results, most);
  const auto kept_free =
      static_cast<std::size_t>(std::ranges::count_if(other_statuses, [&](Status status) {
        return !fewest_latched(source.results, status, 1).empty();
      }));
  const auto has_room = [&] { return choice.size() + kept_free < most; };
  add_median(source, choice);
  for (const Verdict& verdict : source.summary.requirements)
    if (has_room()) add_worst_of(source, verdict, choice);
  if (source.summary.requirements.empty())
    for (const char* family : {"peak_moment", "peak_force", "deployment_time"})
      if (has_room()) add_largest_of(source, family, choice);
  add_statuses(source, choice);
  return choice.take();
}

Json motions_json(const PageSource& source, const PageDetail& detail, int threads) {
  if (!source.replayable()) return Json::array();
  const std::vector<ChosenRun> chosen = chosen_runs(source, detail.motions - 1);
  const RunPlan plan(source.stored.campaign);
  std::vector<Json> motions(1 + chosen.size());
  for_each_task(threads, motions.size(), [&](std::size_t i) {
    motions[i] = i == 0 ? nominal_json(source, detail.motion_samples)
                        : chosen_json(source, plan, chosen[i - 1], detail.motion_samples);
  });
  std::erase_if(motions, [](const Json& motion) { return motion["t"].empty(); });
  return motions;
}

} // namespace wingspread
