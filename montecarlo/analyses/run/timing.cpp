#include "montecarlo/analyses/run/timing.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <unistd.h>
#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

namespace wingspread {
namespace {

std::string host_name() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

/// The library that computes exp, log and sin. Only machines with the same library give the same bytes.
std::string math_library() {
#ifdef __GLIBC__
  return fmt::format("glibc {}", gnu_get_libc_version());
#else
  return "unknown";
#endif
}

} // namespace

void write_timing(const std::filesystem::path& folder, const SessionTiming& timing,
                  const ThreadPool& pool, const Evaluator& evaluator) {
  const long made = timing.counts.done - timing.counts.before;
  const Occupancy& lanes = evaluator.occupancy();
  const Json occupancy =
      lanes.trial_steps > 0
          ? Json(static_cast<double>(lanes.busy) / static_cast<double>(lanes.trial_steps))
          : Json();
  Json outside = Json::object(); // shares of the time
  double all = lanes.in_lanes;
  for (const double seconds : lanes.outside) all += seconds;
  for (std::size_t k = 0; k < lanes.outside.size(); ++k)
    outside[cause_names[k]] = lanes.outside[k] / std::max(all, 1e-9);
  const double runs_per_second = static_cast<double>(made) / std::max(timing.seconds, 1e-9);
  write_file(folder / timing_file,
             json_text({{"host", host_name()},
                        {"math_library", math_library()},
                        {"processors", std::thread::hardware_concurrency()},
                        {"ranks", evaluator.ranks()},
                        {"threads", thread_count(pool.threads)},
                        {"instruction_set", to_string(pool.set)},
                        {"lanes", lanes_of(pool.set)},
                        {"lane_occupancy", occupancy},
                        {"outside_lanes", lanes.trial_steps > 0 ? outside : Json()},
                        {"runs", made},
                        {"runs_before", timing.counts.before},
                        {"seconds", timing.seconds},
                        {"runs_per_second", runs_per_second},
                        {"interrupted", timing.interrupted}}));
}

void add_accuracy_timing(const std::filesystem::path& folder, const Summary& summary) {
  if (!summary.accuracy) return;
  Json timing = parse_json_file(folder / timing_file);
  timing["accuracy"] = {{"runs", summary.accuracy->runs}, {"seconds", summary.accuracy->seconds}};
  write_file(folder / timing_file, json_text(timing));
}

} // namespace wingspread
