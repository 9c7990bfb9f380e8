#include "montecarlo/report/data/envelopes_json.hpp"

#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/report/data/motion.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wingspread {
namespace {

constexpr double beyond_last_latch = 1.08; // end of the displayed time over that of the last latch

constexpr std::array sequence_levels{0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};

constexpr std::array levels{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};

/// The part of a run that the envelopes need.
struct Track {
  std::vector<MotionSample> samples; ///< empty if the run is left out
  std::vector<LatchEvent> latches;
  std::vector<HingeEvent> releases, missed, let_go;
  double end = 0; ///< end of the displayed time, s
  bool deployed = false;
};

/// The goal of a run for samples and latches only, to its t_end.
constexpr Goal samples_only{.peak_moment = false,
                            .peak_force = false,
                            .overtravel = false,
                            .audit = false,
                            .end_state = false,
                            .to_t_end = true};

/// The end of the displayed time, from the campaign's deployment times; 0 without them.
double end_by_results(const Results& results) {
  const auto times = std::ranges::find(results.outputs, "deployment_time", &Column::name);
  double last = 0;
  if (times != results.outputs.end())
    for (const double time : times->values)
      if (!std::isnan(time)) last = std::max(last, time);
  return beyond_last_latch * last;
}

/// @param end end of the displayed time, s: the run is integrated to it, without peaks; 0: unknown
Track track_of(const RunPlan& plan, long run, double end) {
  constexpr std::size_t most_samples = 400;
  const std::size_t hinges = plan.campaign().scene.hinges.size();
  MotionRecorder recorder(hinges);
  Runner runner(plan);
  const Outcome outcome = end > 0 ? runner.watch(run, samples_only, end, recorder.observer())
                                  : runner.replay(run, recorder.observer()).outcome;
  Track track;
  track.deployed = outcome.status == Status::deployed;
  track.latches = outcome.latches;
  track.releases = outcome.releases, track.missed = outcome.missed, track.let_go = outcome.let_go;
  track.end = outcome.t_end;
  if (track.deployed) // beyond t_end no run is known
    track.end = std::min(beyond_last_latch * outcome.latches.back().time,
                         plan.campaign().integration.t_end);
  if (outcome.status == Status::failed) return track;
  pin_only(recorder.samples(), {});
  track.samples = resample(recorder.samples(), {hinges}, most_samples);
  return track;
}

/// Replays runs evenly spaced from the first to the last.
std::vector<Track> tracks_of(const PageSource& source, std::size_t most, int threads) {
  const auto runs = static_cast<std::size_t>(source.summary.runs);
  const std::size_t count = std::min(runs, most);
  const RunPlan plan(source.stored.campaign);
  const double end =
      std::min(end_by_results(source.results), source.stored.campaign.integration.t_end);
  std::vector<Track> tracks(count);
  for_each_task(threads, count, [&](std::size_t i) {
    const std::size_t row = i * runs / count;
    if (!source.has_rows()) {
      tracks[i] = track_of(plan, source.stored.runs().first + static_cast<long>(row), 0);
      return;
    }
    const bool deployed = source.results.status[row] == Status::deployed;
    tracks[i] = track_of(plan, source.results.runs[row], deployed ? end : 0);
  });
  std::erase_if(tracks, [](const Track& track) { return track.samples.empty(); });
  return tracks;
}

/// The 98 % quantile of the ends of the deployed runs, so that one late run does not squeeze all others; the largest
/// end of all runs if none deployed.
double end_of(const std::vector<Track>& tracks) {
  double any = 0;
  std::vector<double> deployed;
  for (const Track& track : tracks) {
    any = std::max(any, track.end);
    if (track.deployed) deployed.push_back(track.end);
  }
  std::ranges::sort(deployed);
  return deployed.empty() ? any : quantile(deployed, 0.98);
}

/// Interpolates the state of a run at ascending times. After its end the run keeps its angles, with zero rates.
class TrackInterpolator {
public:
  TrackInterpolator(const Track& track, const MotionLayout& layout)
      : track_(track), layout_(layout) {}

  /// @param t at least the t of the previous call
  [[nodiscard]] MotionSample at(double t) {
    const std::vector<MotionSample>& samples = track_.samples;
    while (next_ < samples.size() && samples[next_].t <= t) ++next_;
    if (next_ == 0) return samples.front();
    if (next_ < samples.size()) return between(samples[next_ - 1], samples[next_], layout_, t);
    MotionSample rest = samples.back();
    if (t > rest.t)
      for (std::size_t h = 0; h < layout_.hinges; ++h) rest.values[layout_.rate(h)] = 0;
    return rest;
  }

private:
  const Track& track_;
  MotionLayout layout_;
  std::size_t next_ = 0;
};

/// values[place][level][time]
using Bands = std::vector<std::vector<std::vector<double>>>;

Bands bands_of(const std::vector<Track>& tracks, const MotionLayout& layout,
               const std::vector<double>& times) {
  Bands bands(2 * layout.hinges, std::vector(levels.size(), std::vector<double>()));
  std::vector<TrackInterpolator> tracks_at;
  for (const Track& track : tracks) tracks_at.emplace_back(track, layout);
  for (const double t : times) {
    std::vector<std::vector<double>> there(2 * layout.hinges);
    for (TrackInterpolator& track_at : tracks_at) {
      const MotionSample sample = track_at.at(t);
      for (std::size_t place = 0; place < there.size(); ++place)
        there[place].push_back(sample.values[place]);
    }
    for (std::size_t place = 0; place < there.size(); ++place) {
      std::ranges::sort(there[place]);
      for (std::size_t level = 0; level < levels.size(); ++level)
        bands[place][level].push_back(quantile(there[place], levels[level]));
    }
  }
  return bands;
}

Json bands_json(const Bands& bands, std::size_t first, std::size_t count, int digits) {
  Json json = Json::array();
  for (std::size_t place = first; place < first + count; ++place) {
    Json of_place = Json::array();
    for (const std::vector<double>& level : bands[place])
      of_place.push_back(page_numbers(level, digits));
    json.push_back(std::move(of_place));
  }
  return json;
}

/// Ascending times, with the digits that show their spread.
Json page_times(const std::vector<double>& times) {
  const double spread = times.empty() ? 0 : times.back() - times.front();
  return page_numbers(times, digits_that_show(spread, times.empty() ? 0 : times.back(), 6));
}

/// The latch times of each hinge, sorted; thinned evenly to `most`, the first and the last among them.
Json latch_times_json(const std::vector<Track>& tracks, std::size_t hinges, std::size_t most) {
  std::vector<std::vector<double>> times(hinges);
  for (const Track& track : tracks)
    for (const LatchEvent& latch : track.latches)
      times[static_cast<std::size_t>(latch.hinge)].push_back(latch.time);
  Json json = Json::array();
  for (std::vector<double>& each : times) {
    std::ranges::sort(each);
    std::vector<double> shown;
    const std::size_t count = std::min(each.size(), most);
    const std::size_t steps = std::max<std::size_t>(count, 2) - 1;
    for (std::size_t i = 0; i < count; ++i) shown.push_back(each[i * (each.size() - 1) / steps]);
    json.push_back(page_times(shown));
  }
  return json;
}

/// The number of runs in which each hinge latched.
std::vector<long> latched_runs(const std::vector<Track>& tracks, std::size_t hinges) {
  std::vector<long> runs;
  for (int hinge = 0; hinge < static_cast<int>(hinges); ++hinge)
    runs.push_back(std::ranges::count_if(tracks, [&](const Track& track) {
      return std::ranges::find(track.latches, hinge, &LatchEvent::hinge) != track.latches.end();
    }));
  return runs;
}

// ---- the sequence of releases and captures

/// Counts and quantiles of one kind of event of a hinge over the runs.
template <class Events> Json events_json(const std::vector<Track>& tracks, int hinge, Events of) {
  std::vector<double> times;
  std::size_t runs = 0;
  for (const Track& track : tracks) {
    const std::size_t before = times.size();
    for (const auto& event : of(track))
      if (event.hinge == hinge) times.push_back(event.time);
    runs += times.size() > before ? 1 : 0;
  }
  std::ranges::sort(times);
  std::vector<double> shown;
  if (!times.empty())
    for (const double p : sequence_levels) shown.push_back(quantile(times, p));
  return {{"runs", runs}, {"count", times.size()}, {"times", page_times(shown)}};
}

/// The nominal release of a hinge; null without one.
Json release_json(const Hinge& hinge) {
  if (!hinge.release) return nullptr;
  constexpr std::array events{"time", "latched", "released", "passed"}; // in the order of Event
  const Release& release = *hinge.release;
  return {{"event", events[static_cast<std::size_t>(release.event)]},
          {"time", page_number(release.time)},
          {"after", release.after},
          {"angle", page_number(release.angle)},
          {"delay", page_number(release.delay)},
          {"fails", release.fails}};
}

/// Null for a wing without holds whose latches cannot miss: its sequence is in the latch times.
Json sequence_json(const std::vector<Track>& tracks, const Scene& scene) {
  if (std::ranges::none_of(scene.hinges, [](const Hinge& hinge) {
        return hinge.release || (hinge.latch && hinge.latch->can_miss());
      }))
    return nullptr;
  Json json = Json::array();
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    const auto of = [&](auto Track::*events) {
      return events_json(
          tracks, static_cast<int>(h), [events](const Track& track) -> const auto& {
            return track.*events;
          });
    };
    json.push_back({{"release", release_json(scene.hinges[h])},
                    {"released", of(&Track::releases)},
                    {"missed", of(&Track::missed)},
                    {"latched", of(&Track::latches)},
                    {"let_go", of(&Track::let_go)}});
  }
  return json;
}

} // namespace

Json envelopes_json(const PageSource& source, const PageDetail& detail, int threads) {
  if (!source.replayable()) return nullptr;
  const MotionLayout layout{source.stored.campaign.scene.hinges.size()};
  const std::vector<Track> tracks = tracks_of(source, detail.envelope_runs, threads);
  if (tracks.empty()) return nullptr;
  std::vector<double> times;
  const double end = end_of(tracks);
  for (std::size_t i = 0; i < detail.envelope_times; ++i)
    times.push_back(end * static_cast<double>(i) / static_cast<double>(detail.envelope_times - 1));
  const Bands bands = bands_of(tracks, layout, times);
  return {{"runs", tracks.size()},
          {"t", page_numbers(times, 6)},
          {"levels", levels},
          {"angles", bands_json(bands, 0, layout.hinges, 5)},
          {"rates", bands_json(bands, layout.hinges, layout.hinges, 4)},
          {"latch_times", latch_times_json(tracks, layout.hinges, detail.latch_times)},
          {"latched", latched_runs(tracks, layout.hinges)},
          {"sequence", sequence_json(tracks, source.stored.campaign.scene)}};
}

} // namespace wingspread
