#include "montecarlo/report/data/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wingspread {
namespace {

/// The three measures of progress between two samples: time, path length of all angles, path length of all moments.
std::array<double, 3> progress_between(const MotionSample& from, const MotionSample& to,
                                       const MotionLayout& layout) {
  std::array<double, 3> ways{to.t - from.t, 0, 0};
  for (std::size_t h = 0; h < layout.hinges; ++h) {
    ways[1] += std::abs(to.values[layout.angle(h)] - from.values[layout.angle(h)]);
    ways[2] += std::abs(to.values[layout.moment(h)] - from.values[layout.moment(h)]);
  }
  return ways;
}

/// The progress of a run at each sample, from 0 to 1: the mean of the three measures, each divided by its total.
std::vector<double> progress_of(std::span<const MotionSample> samples, const MotionLayout& layout) {
  std::vector<std::array<double, 3>> ways;
  std::array<double, 3> whole{0, 0, 0};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ways.push_back(progress_between(samples[i - 1], samples[i], layout));
    for (std::size_t k = 0; k < 3; ++k) whole[k] += ways.back()[k];
  }
  const auto there =
      static_cast<double>(std::ranges::count_if(whole, [](double w) { return w > 0; }));
  std::vector<double> progress{0};
  for (const auto& each : ways) {
    double step = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (whole[k] > 0) step += each[k] / whole[k] / there;
    progress.push_back(progress.back() + step);
  }
  return progress;
}

} // namespace

Observer MotionRecorder::observer() {
  return [this](const Sample& sample) { record_sample(sample); };
}

void MotionRecorder::record_sample(const Sample& sample) {
  const bool again = pins_ && !samples_.empty() && samples_.back().t == sample.t;
  if (again) samples_.back().pinned = true;
  // The newest sample is always stored, so that the run's end is there. If only every n-th sample is kept, the next one
  // replaces it, unless it is an n-th or a pinned one.
  if (!again && ++seen_ % stride_ != 0 && samples_.size() > 1 && !samples_.back().pinned)
    samples_.pop_back();
  MotionSample kept{sample.t, {}, again};
  kept.values.reserve(layout_.size());
  for (const auto* row : {&sample.angles, &sample.rates, &sample.moments})
    kept.values.insert(kept.values.end(), row->begin(), row->end());
  kept.values.insert(kept.values.end(),
                     {sample.base_position.x(), sample.base_position.y(), sample.base_angle});
  samples_.push_back(std::move(kept));
  if (samples_.size() > most_kept) drop_every_second();
}

void MotionRecorder::drop_every_second() {
  // Engagements are few. Thousands of instants with two sides are a hinge that sticks and slips: from here on they are samples
  // like others, because pinned ones would fill the room.
  if (std::ranges::count_if(samples_, [](const MotionSample& sample) { return sample.pinned; }) >
      std::ssize(samples_) / 2) {
    pins_ = false;
    for (MotionSample& sample : samples_) sample.pinned = false;
  }
  std::size_t place = 0;
  std::erase_if(samples_, [&](const MotionSample& sample) {
    return place++ % 2 == 1 && !sample.pinned && &sample != &samples_.back();
  });
  stride_ *= 2;
}

bool has_settled(std::span<const MotionSample> samples, const MotionLayout& layout, double since) {
  const auto after = std::ranges::lower_bound(samples, since, {}, &MotionSample::t);
  if (after == samples.end() || !(samples.back().t > since)) return false;
  const double late = since + 0.75 * (samples.back().t - since);
  // Heuristic: fewer samples do not span a cycle of a mode. With a smaller number a ring would seem over at its start.
  constexpr std::ptrdiff_t fewest = 16;
  if (samples.end() - std::ranges::lower_bound(samples, late, {}, &MotionSample::t) < fewest)
    return false;
  for (std::size_t h = 0; h < layout.hinges; ++h) {
    int turns = 0; // of the moment in the last quarter
    double before = after->values[layout.moment(h)], way = 0;
    std::array<double, 2> all{after->values[layout.moment(h)], after->values[layout.moment(h)]},
        last{samples.back().values[layout.moment(h)], samples.back().values[layout.moment(h)]};
    for (auto sample = after; sample != samples.end(); ++sample) {
      const double moment = sample->values[layout.moment(h)];
      all = {std::min(all[0], moment), std::max(all[1], moment)};
      if (sample->t >= late) {
        last = {std::min(last[0], moment), std::max(last[1], moment)};
        if (way * (moment - before) < 0) ++turns;
      }
      if (moment != before) way = moment - before, before = moment;
    }
    if (turns == 1 || turns == 2)
      return false; // less than a cycle: near its crest a slow swing seems to stand still
    if (last[1] - last[0] > settled_share * (all[1] - all[0])) return false;
  }
  return true;
}

MotionSample between(const MotionSample& from, const MotionSample& to, const MotionLayout& layout,
                     double t) {
  const double h = to.t - from.t, s = (t - from.t) / h;
  MotionSample sample{t, {}, false};
  for (std::size_t i = 0; i < layout.size(); ++i)
    sample.values.push_back(std::lerp(from.values[i], to.values[i], s));
  for (std::size_t k = 0; k < layout.hinges; ++k) {
    const double a = from.values[layout.angle(k)], b = to.values[layout.angle(k)];
    const double da = h * from.values[layout.rate(k)], db = h * to.values[layout.rate(k)];
    const double c = 3 * (b - a) - 2 * da - db, d = 2 * (a - b) + da + db;
    sample.values[layout.angle(k)] = a + s * (da + s * (c + s * d));
    sample.values[layout.rate(k)] = (da + s * (2 * c + 3 * s * d)) / h;
  }
  return sample;
}

void pin_only(std::span<MotionSample> samples, std::span<const double> times) {
  for (MotionSample& sample : samples)
    sample.pinned = std::ranges::find(times, sample.t) != times.end();
}

std::vector<MotionSample> resample(std::span<const MotionSample> samples,
                                   const MotionLayout& layout, std::size_t most) {
  if (samples.size() < 2) return {samples.begin(), samples.end()};
  const std::vector<double> progress = progress_of(samples, layout);
  const double step = progress.back() / static_cast<double>(std::max<std::size_t>(most, 2) - 1);
  std::vector<MotionSample> chosen{samples.front()};
  double next = step;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double from = progress[i - 1], to = progress[i];
    bool due = samples[i].pinned || i + 1 == samples.size();
    for (; next <= to && step > 0; next += step) {
      const double t = std::lerp(samples[i - 1].t, samples[i].t, (next - from) / (to - from));
      if (to - from > step && t > chosen.back().t && t < samples[i].t)
        chosen.push_back(between(samples[i - 1], samples[i], layout, t));
      else
        due = true;
    }
    if (due) chosen.push_back(samples[i]);
  }
  return chosen;
}

} // namespace wingspread
