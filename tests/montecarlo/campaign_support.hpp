/// For tests that run campaigns: campaigns of the seed scene, and running one into a folder.
#pragma once

#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "tests/montecarlo/spec_support.hpp"
#include "tests/support/source_folder.hpp"

#include <atomic>
#include <map>

namespace wingspread::test {

inline std::filesystem::path three_panel_file() {
  return std::filesystem::path(source_folder) / "studies/scenes/three_panel.json";
}

/// The seed scene with a spring and all masses dispersed. Runs end at the last latch, after about 0.2 ms of work.
inline Json quick_campaign(int runs) {
  Json campaign = parse_json(R"({
    "dispersions": [
      { "name": "root_spring", "distribution": { "type": "normal", "mean": 1, "std": 0.05 },
        "apply": "scale",
        "to": ["hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"] },
      { "name": "mass", "distribution": { "type": "uniform", "lower": 9, "upper": 11 },
        "apply": "set", "each": "bodies.*.mass" } ],
    "integration": { "rtol": 1e-6, "atol": 1e-8, "t_end": 20 },
    "outputs": ["latch_time", "latch_rate", "rate_at"] })");
  campaign["scene"] = parse_json_file(three_panel_file());
  campaign["sampling"] = {{"runs", runs}, {"seed", 7}};
  return campaign;
}

/// The same campaign with all outputs. Some of its draws are unphysical, and some of its runs time out.
inline Json full_campaign(int runs) {
  Json campaign = quick_campaign(runs);
  campaign["outputs"] = {"latch_time", "latch_rate", "peak_moment", "peak_force", "rate_at"};
  campaign["integration"]["t_end"] = 6.75;
  campaign["dispersions"][1]["distribution"] = {{"type", "normal"}, {"mean", 10}, {"std", 6}};
  return campaign;
}

/// One panel under a constant torque, with a soft latch. All runs deploy at 2.15 to 2.2 s, and their moment peaks about
/// 0.5 s later, below 15 N·m: t_end between the two cuts the peaks of all runs.
inline Json ringing_panel(int runs, double t_end, double dissipation) {
  Json campaign = parse_json(R"({
    "scene": { "name": "ringing_panel", "base": { "motion": "fixed" },
      "bodies": [ { "name": "panel", "mass": 10, "inertia": 0.5 } ],
      "hinges": [ { "name": "root", "parent": "base", "child": "panel",
        "parent_point": [0, 0], "child_point": [-0.5, 0],
        "angle": { "stowed": "90 deg", "latched": 0 },
        "spring": { "torque_stowed": 2, "torque_latched": 2 },
        "latch": { "stiffness": 30 } } ] },
    "dispersions": [ { "name": "spring", "distribution": { "type": "uniform", "lower": 0.98, "upper": 1.02 },
                       "apply": "scale", "to": ["hinges.root.spring.scale"] } ],
    "requirements": [ { "output": "root.peak_moment", "max": 20, "probability": 0.9, "confidence": 0.9 } ],
    "margin": { "scale": ["hinges.root.spring.scale"], "range": [0.9, 1.6] } })");
  campaign["scene"]["hinges"][0]["latch"]["dissipation"] = dissipation;
  campaign["sampling"] = {{"runs", runs}, {"seed", 3}};
  campaign["integration"] = {{"t_end", t_end}};
  return campaign;
}

inline Campaign campaign_of(const Json& json) { return read_campaign(json.dump(), ""); }

inline const std::atomic<bool> never = false;

/// The rows of a range of runs.
inline Results rows_of(const RunPlan& plan, RunRange range, int threads = 2) {
  Results results(plan.names());
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) results.append(row);
  };
  (void)ThreadEvaluator({.threads = threads}, never).make(plan, range, {keep});
  return results;
}

/// A stopping rule with one goal, in the syntax of `run --until`.
inline StoppingRule rule_of(const char* text) {
  StoppingRule rule;
  std::vector<Problem> problems;
  const Json goals{parse_stopping_goal(text).value()};
  read_stopping_rule(JsonCursor(goals, "", problems), nullptr, nullptr, rule);
  return rule;
}

struct Session {
  int threads = 1;
  std::optional<Shard> shard{};
  bool resume = false;
  long stop_after = -1; ///< runs; −1: never
};

/// Runs a campaign into a folder as `wingspread run` does; returns the number of runs made.
inline long run_into(const std::filesystem::path& path, const Campaign& campaign,
                     const Session& session = {}) {
  const RunPlan plan(campaign);
  FolderWriter folder(path, plan, session.shard, session.resume);
  std::atomic<bool> stop = session.stop_after == 0;
  long made = 0;
  const auto keep = [&](const Batch& batch) {
    folder.add(batch);
    made += std::ssize(batch.rows);
    if (session.stop_after >= 0 && made >= session.stop_after) stop = true;
  };
  ThreadEvaluator evaluator({.threads = session.threads}, stop);
  while (!stop && folder.remaining().size() > 0)
    (void)evaluator.make(plan, folder.remaining(), {keep, true});
  (void)write_statistics(folder.stored(), folder.results());
  return made;
}

/// The bytes of every file but timing.json.
inline std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename() != timing_file)
      files[entry.path().filename().string()] = read_text(entry.path()).value_or("(unreadable)");
  return files;
}

} // namespace wingspread::test
