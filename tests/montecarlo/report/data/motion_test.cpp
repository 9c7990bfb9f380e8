#include "montecarlo/report/data/motion.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace wingspread;

namespace {

const MotionLayout one{1};

/// A hinge at a cubic of time, with its rate; its moment is t.
Sample sample_at(double t) {
  Sample sample;
  sample.t = t;
  sample.angles = {1 + t * (2 - t * (3 - t))};
  sample.rates = {2 - 6 * t + 3 * t * t};
  sample.moments = {t};
  return sample;
}

std::vector<MotionSample> recorded(MotionRecorder& recorder, int steps, double end) {
  const Observer observer = recorder.observer();
  for (int k = 0; k <= steps; ++k) observer(sample_at(end * k / steps));
  return recorder.samples();
}

} // namespace

TEST_CASE("between steps a cubic motion is met exactly", "[page]") {
  MotionRecorder recorder(1);
  const auto samples = recorded(recorder, 1, 2);
  REQUIRE(samples.size() == 2);
  for (const double t : {0.1, 1.0, 1.7}) {
    const MotionSample middle = between(samples[0], samples[1], one, t);
    CHECK(middle.values[one.angle(0)] == Approx(sample_at(t).angles[0]).epsilon(1e-13));
    CHECK(middle.values[one.rate(0)] == Approx(sample_at(t).rates[0]).epsilon(1e-13));
    CHECK(middle.values[one.moment(0)] == Approx(t).epsilon(1e-13));
  }
}

TEST_CASE("a ring has settled where the last quarter moves by less than a twentieth", "[page]") {
  const double decay = 2, rate = 30; // e^(−2t) cos 30t: 5 % after 1.5 s
  std::vector<MotionSample> samples;
  double settled = 0;
  for (int k = 0; settled == 0 && k < 4000; ++k) {
    const double t = 1 + k * 1e-3;
    samples.push_back({t, {0, 0, std::exp(-decay * (t - 1)) * std::cos(rate * (t - 1)), 0, 0, 0}});
    if (t > 1.01 && has_settled(samples, one, 1)) settled = t - 1;
  }
  // from the start of the last quarter on, the swing is 2 e^(−1.5 t) of 2: settled at ln 20 / 1.5
  CHECK(settled == Approx(std::log(20) / 1.5).epsilon(0.1));
  CHECK_FALSE(has_settled(samples, one, samples.back().t)); // nothing is after it
}

TEST_CASE("samples are kept by time, by turning and by changing moments, a third each", "[page]") {
  // each of 3 s: the hinge turns by 1 rad, then its moment rises by 1000 N·m, then nothing happens
  std::vector<MotionSample> samples;
  for (int k = 0; k <= 3000; ++k) {
    const double t = k * 1e-3;
    samples.push_back({t, {std::min(t, 1.0), 0, 1000 * std::clamp(t - 1, 0.0, 1.0), 0, 0, 0}});
  }
  const std::vector<MotionSample> kept = resample(samples, one, 900);
  CHECK(std::ssize(kept) == Approx(900).margin(3));
  std::array<double, 3> in{};
  for (const MotionSample& each : kept)
    ++in[std::min<std::size_t>(2, static_cast<std::size_t>(each.t))];
  CHECK(in[0] == Approx(900 * (1. / 9 + 1. / 3)).margin(3));
  CHECK(in[1] == Approx(900 * (1. / 9 + 1. / 3)).margin(3));
  CHECK(in[2] == Approx(900 * (1. / 9)).margin(3));
}

TEST_CASE("a run of many steps is thinned, and keeps its ends", "[page]") {
  MotionRecorder recorder(1);
  const auto samples = recorded(recorder, 100'000, 2);
  CHECK(samples.size() <= (1 << 14) + 1);
  CHECK(samples.size() > 1 << 12);
  CHECK(samples.front().t == 0);
  CHECK(samples.back().t == 2);
  double widest = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    REQUIRE(samples[k].t > samples[k - 1].t);
    widest = std::max(widest, samples[k].t - samples[k - 1].t);
  }
  CHECK(widest < 4 * 2.0 / (1 << 12)); // evenly
}

TEST_CASE("a run whose hinges stick and slip a hundred thousand times is thinned as well",
          "[page]") {
  MotionRecorder recorder(1);
  const Observer observer = recorder.observer();
  constexpr int steps = 300'000;
  for (int k = 0; k <= steps; ++k) {
    observer(sample_at(2. * k / steps));
    if (k > 30 && k < steps) observer(sample_at(2. * k / steps)); // the other side of an instant
  }
  const auto& samples = recorder.samples();
  CHECK(samples.size() <= (1 << 14) + 1);
  CHECK(samples.size() > 1 << 12);
  CHECK(samples.front().t == 0);
  CHECK(samples.back().t == 2);
  for (std::size_t k = 1; k < samples.size(); ++k) {
    REQUIRE(samples[k].t >= samples[k - 1].t);
    REQUIRE(samples[k].t - samples[k - 1].t < 4 * 2.0 / (1 << 12)); // evenly
  }
}

TEST_CASE("the page's samples stand where something happens, both sides of a latch among them",
          "[page]") {
  MotionRecorder recorder(1);
  const Observer observer = recorder.observer();
  const auto jump = [&](double t, double moment) {
    Sample sample = sample_at(0);
    sample.t = t;
    sample.rates = {0};
    sample.moments = {moment};
    observer(sample);
  };
  jump(0, 0);
  jump(1, 0);
  jump(1, 5); // the engagement
  for (int k = 1; k <= 1000; ++k) jump(1 + 1e-3 * k, 5 * std::cos(0.1 * k));
  jump(100, 5 * std::cos(100.0)); // nothing more
  pin_only(recorder.samples(), std::vector<double>{1.0});
  const auto samples = resample(recorder.samples(), one, 100);
  CHECK(samples.size() <= 104);
  CHECK(samples.size() > 60);
  CHECK(samples.front().t == 0);
  CHECK(samples.back().t == 100);
  const auto at_latch = std::ranges::count(samples, 1.0, &MotionSample::t);
  CHECK(at_latch == 2);
  const auto ringing =
      std::ranges::count_if(samples, [](const MotionSample& s) { return s.t > 1 && s.t <= 2; });
  CHECK(ringing >= 40); // half of them by moments
  double last = -1;
  for (const MotionSample& sample : samples) {
    CHECK(sample.t >= last);
    last = sample.t;
  }
}

TEST_CASE("few steps are filled up between", "[page]") {
  MotionRecorder recorder(1);
  (void)recorded(recorder, 2, 2);
  const auto samples = resample(recorder.samples(), one, 50);
  CHECK(samples.size() >= 45);
  CHECK(samples.size() <= 51);
  for (const MotionSample& sample : samples)
    CHECK(sample.values[0] == Approx(sample_at(sample.t).angles[0]).margin(1e-12));
}

// A large start, then a swing of a hundredth: the last quarter is small, so only its turns say whether it is over.
TEST_CASE("a slow swing with one or two turns in the last quarter has not settled", "[page]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  std::array<int, 4> tried{};
  for (int trial = 0; trial < 300; ++trial) {
    const double rate = 0.2 + 14 * uniform(random), phase = 6.3 * uniform(random);
    std::vector<MotionSample> samples;
    for (int k = 0; k <= 400; ++k) {
      const double t = 1 + 0.01 * k;
      samples.push_back(
          {t, {0, 0, std::exp(-50 * (t - 1)) + 0.01 * std::cos(rate * t + phase), 0, 0, 0}});
    }
    const auto moment = [&](std::size_t k) { return samples[k].values[2]; };
    std::size_t turns = 0; // from t = 4 on
    for (std::size_t k = 300; k <= 400; ++k)
      turns += (moment(k) - moment(k - 1)) * (moment(k - 1) - moment(k - 2)) < 0 ? 1 : 0;
    CAPTURE(rate, phase, turns);
    CHECK(has_settled(samples, one, 1) == (turns == 0 || turns > 2));
    ++tried[std::min<std::size_t>(turns, 3)];
  }
  CHECK(std::ranges::min(tried) > 5);
}
