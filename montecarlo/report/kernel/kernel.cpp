/// The kernel in the page: core and distributions, compiled to WebAssembly (build_kernel.sh). The page fills `input`
/// with the campaign's numbers, draws a run or sets draws itself, changes parameters, runs, and reads results and
/// samples.
///
///     input(count) → fill → open() → draw(run) | median() → run(changes) → result(), samples()
#include "core/mechanics/structure.hpp"
#include "core/run/integrator.hpp"
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/report/data/motion.hpp"
#include "montecarlo/report/kernel/campaign_numbers.hpp"

#include <boost/assert/source_location.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <span>

// Called by Boost where it would throw: for arguments that the program's checks refuse.
namespace boost {
void throw_exception(const std::exception&) { __builtin_trap(); }
void throw_exception(const std::exception&, const source_location&) { __builtin_trap(); }
} // namespace boost

using namespace wingspread;

/// a·b + c with one rounding. WebAssembly has no such instruction, and the C library's function takes ten times as
/// long. With it the kernel has the program's bits; with two roundings stiff runs would differ by 1e-7. Products of
/// Dekker, the last sum rounded to odd: S. Boldo and G. Melquiond, IEEE Trans. Comput. 57 (2008) 462–471. Two roundings
/// beyond 1e290, where a product of halves overflows, and for infinities and NaN.
extern "C" double fma(double a, double b, double c) {
  const double product = a * b;
  if (!(std::abs(product) < 1e290 && std::abs(c) < 1e290 && std::abs(a) < 1e290 &&
        std::abs(b) < 1e290) ||
      product == 0)
    return product + c;
  constexpr double splitter = 134217729; // 2²⁷ + 1
  const double a_top = splitter * a - (splitter * a - a), a_rest = a - a_top;
  const double b_top = splitter * b - (splitter * b - b), b_rest = b - b_top;
  const double low =
      a_rest * b_rest - (((product - a_top * b_top) - a_rest * b_top) - a_top * b_rest);
  const auto sum = [](double x, double y) { // and its rounding error
    const double s = x + y, part = s - x;
    return std::array{s, (x - (s - part)) + (y - part)};
  };
  const auto [upper, upper_low] = sum(c, low);
  const auto [whole, whole_low] = sum(product, upper);
  auto [last, error] = sum(upper_low, whole_low);
  auto bits = std::bit_cast<std::int64_t>(last);
  if (error != 0 && bits % 2 == 0) // to the odd neighbour on the error's side
    last = std::bit_cast<double>(bits + ((error > 0) == (last > 0) ? 1 : -1));
  return whole + last;
}

namespace {

/// Fills a campaign from the numbers.
class NumberReader {
public:
  static constexpr bool reads = true;
  explicit NumberReader(const double* next) : next_(next) {}

  void number(double& value) {
    places.push_back(&value);
    value = *next_++;
  }
  void integer(int& value) { value = static_cast<int>(*next_++); }
  void list(std::vector<double>& values) {
    int count = 0;
    integer(count);
    values.assign(next_, next_ + count);
    next_ += count;
  }
  void text(std::string& text) {
    std::vector<double> bytes;
    list(bytes);
    text.clear();
    for (const double byte : bytes) text += static_cast<char>(byte);
  }

  std::vector<double*> places; ///< of the numbers, in their order

private:
  const double* next_;
};

template <BaseMotion M>
Outcome integrate(const Wing<double>& wing, const Integration& how, const Goal& goal,
                  const Observer& observer) {
  Workspace<double> scratch;
  System<double, Tree, M> system(wing, how.smoothing, scratch);
  return Integrator<double, Tree, M>(system, how, goal, observer).run();
}

Outcome integrate(const Scene& scene, const Integration& how, const Goal& goal,
                  const Observer& observer) {
  Outcome out;
  if (const std::vector<Fault> faults = unphysical(scene); !faults.empty()) {
    out.status = Status::invalid;
    for (const Fault& fault : faults)
      out.reason += (out.reason.empty() ? "" : "; ") + fault.path + " is " + fault.found +
                    ", expected " + fault.expected;
    return out;
  }
  if (how.smoothing && hinge_with_event_latch(scene)) {
    out.reason = needs_event_latches; // status failed
    return out;
  }
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  if (scene.base.motion == BaseMotion::free)
    return integrate<BaseMotion::free>(wing, how, goal, observer);
  if (scene.base.motion == BaseMotion::prescribed)
    return integrate<BaseMotion::prescribed>(wing, how, goal, observer);
  return integrate<BaseMotion::fixed>(wing, how, goal, observer);
}

/// The campaign in the page, and its latest run.
class Kernel {
public:
  explicit Kernel(std::vector<double> numbers) {
    NumberReader reading(numbers.data());
    CampaignNumbers<NumberReader> visit(reading);
    visit.scene(campaign_.scene);
    places_ = reading.places; // vectors of the scene keep their size: the addresses stay
    visit.rest(campaign_);
    for (const double* place : places_) nominal_.push_back(*place);
    std::vector<std::string> names;
    for (const NumberedDispersion& each : campaign_.dispersions) {
      names.push_back(each.name);
      laws_.emplace_back(each.distribution);
    }
    design_.emplace(campaign_.design, names);
    copula_.emplace(order_by_name(names), campaign_.correlations);
    draws.resize(names.size());
  }

  void draw(std::uint64_t run) {
    std::vector<Tails> u(draws.size()), coupled(draws.size());
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = tails_of_uniform(design_->uniform(run, i));
    copula_->couple(u, coupled);
    for (std::size_t i = 0; i < u.size(); ++i)
      draws[i] = copula_->is_independent() ? laws_[i].quantile(design_->uniform(run, i))
                                           : laws_[i].quantile(coupled[i]);
  }
  void median() {
    for (std::size_t i = 0; i < draws.size(); ++i) draws[i] = laws_[i].quantile(0.5);
  }

  /// @param changes pairs: a place, and the factor of its number
  void run(int count, const double* changes) {
    apply_draws();
    for (int i = 0; i < count; ++i)
      *places_[static_cast<std::size_t>(changes[2 * i])] *= changes[2 * i + 1];
    MotionRecorder recorder(campaign_.scene.hinges.size());
    Outcome outcome =
        integrate(campaign_.scene, campaign_.integration, campaign_.goal, recorder.observer());
    name_held_hinges(campaign_.scene, outcome);
    reason = outcome.reason;
    keep_result(outcome);
    keep_samples(recorder, outcome);
  }

  std::vector<double> draws, result, samples;
  std::string reason;

private:
  void apply_draws() {
    for (std::size_t place = 0; place < places_.size(); ++place) *places_[place] = nominal_[place];
    for (std::size_t i = 0; i < draws.size(); ++i)
      for (const NumberedEffect& effect : campaign_.dispersions[i].effects) {
        const double by =
            effect.at.empty()
                ? draws[i]
                : Curve(effect.at, effect.value, Interpolation::monotone).value_at(draws[i]);
        double& number = *places_[static_cast<std::size_t>(effect.place)];
        number = effect.how == 0 ? by : effect.how == 1 ? number * by : number + by;
      }
  }

  /// Sets `result`, which 66-run.js reads, in this order:
  ///
  ///   status, t_end, whether the moments (1) and the forces (2) are final, in sum
  ///   number of latches; of each: hinge, time, rates…
  ///   of each hinge: peak moment and its time, peak force, overtravel, hold moment, final angle, motor energy
  ///   the base's peak angle and rate
  ///   three times, for releases, missed and let_go: their number; of each: hinge, time
  ///
  /// NaN stands for a number that is not asked for.
  void keep_result(const Outcome& outcome) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    result = {static_cast<double>(outcome.status), outcome.t_end,
              (outcome.moments_final ? 1.0 : 0.0) + (outcome.forces_final ? 2.0 : 0.0),
              static_cast<double>(outcome.latches.size())};
    for (const LatchEvent& latch : outcome.latches) {
      result.push_back(latch.hinge);
      result.push_back(latch.time);
      result.insert(result.end(), latch.rates.begin(), latch.rates.end());
    }
    for (std::size_t h = 0; h < campaign_.scene.hinges.size(); ++h) {
      const bool moment = h < outcome.peak_moment.size();
      result.push_back(moment ? outcome.peak_moment[h].value : none);
      result.push_back(moment ? outcome.peak_moment[h].time : none);
      result.push_back(h < outcome.peak_force.size() ? outcome.peak_force[h].value : none);
      result.push_back(h < outcome.overtravel.size() ? outcome.overtravel[h] : none);
      result.push_back(h < outcome.hold_moment.size() ? outcome.hold_moment[h].value : none);
      result.push_back(h < outcome.final_angle.size() ? outcome.final_angle[h] : none);
      result.push_back(h < outcome.motor_energy.size() ? outcome.motor_energy[h] : none);
    }
    result.push_back(outcome.base_peaks ? outcome.base_peaks->angle : none);
    result.push_back(outcome.base_peaks ? outcome.base_peaks->rate : none);
    for (const auto* events : {&outcome.releases, &outcome.missed, &outcome.let_go}) {
      result.push_back(static_cast<double>(events->size()));
      for (const HingeEvent& event : *events)
        result.insert(result.end(), {static_cast<double>(event.hinge), event.time});
    }
  }

  /// Keeps the samples up to the end of the ring. If a proof ended the run earlier, repeats the run with a later end.
  /// (An observer cannot end the run, because the kernel is compiled without exceptions.)
  void keep_samples(MotionRecorder& recorder, const Outcome& outcome) {
    const MotionLayout layout{campaign_.scene.hinges.size()};
    const double since = outcome.latches.empty() ? 0 : outcome.latches.back().time;
    Integration how = campaign_.integration;
    Goal goal = campaign_.goal;
    goal.to_t_end = true;
    double end = outcome.t_end;
    while (!cut_at_end_of_ring(recorder.samples(), layout, since) &&
           end < campaign_.integration.t_end) {
      const double next = since + 2 * (end - since) + 0.1 * since;
      // A run that stalls at t = 0 has no length to double.
      how.t_end = end =
          next > end ? std::min(campaign_.integration.t_end, next) : campaign_.integration.t_end;
      recorder = MotionRecorder(layout.hinges);
      (void)integrate(campaign_.scene, how, goal, recorder.observer());
    }
    keep_resampled(recorder, layout, outcome);
  }

  /// Drops the samples after the moments have settled. @return whether they have
  static bool cut_at_end_of_ring(std::vector<MotionSample>& samples, const MotionLayout& layout,
                                 double since) {
    if (samples.empty()) return true;
    for (double length = 0.05 * since + 1e-3; since + length < samples.back().t; length *= 1.25) {
      const auto after =
          std::upper_bound(samples.begin(), samples.end(), since + length,
                           [](double t, const MotionSample& sample) { return t < sample.t; });
      const auto count = static_cast<std::size_t>(after - samples.begin());
      if (!has_settled(std::span(samples).first(count), layout, since)) continue;
      samples.resize(count);
      return true;
    }
    return has_settled(samples, layout, since);
  }

  /// Rows of t, then the values of MotionLayout.
  void keep_resampled(MotionRecorder& recorder, const MotionLayout& layout,
                      const Outcome& outcome) {
    constexpr std::size_t most = 800;
    std::vector<double> latched;
    for (const LatchEvent& latch : outcome.latches) latched.push_back(latch.time);
    pin_only(recorder.samples(), latched);
    samples.clear();
    for (const MotionSample& sample : resample(recorder.samples(), layout, most)) {
      samples.push_back(sample.t);
      samples.insert(samples.end(), sample.values.begin(), sample.values.end());
    }
  }

  NumberedCampaign campaign_;
  std::vector<double*> places_; ///< of the scene's numbers
  std::vector<double> nominal_; ///< their values
  std::vector<PreparedDistribution> laws_;
  std::optional<PreparedDesign> design_;
  std::optional<GaussianCopula> copula_;
};

std::vector<double> numbers;
std::optional<Kernel> kernel;

} // namespace

#define IN_PAGE(name) extern "C" __attribute__((export_name(#name)))

IN_PAGE(input) double* input(int count) {
  numbers.assign(static_cast<std::size_t>(count), 0);
  return numbers.data();
}
IN_PAGE(open) void open_campaign() { kernel.emplace(numbers); }
IN_PAGE(draw) void draw(double run) { kernel->draw(static_cast<std::uint64_t>(run)); }
IN_PAGE(median) void median() { kernel->median(); }
/// @param count of pairs (place, factor) that `input` holds
IN_PAGE(run) void run(int count) { kernel->run(count, numbers.data()); }
IN_PAGE(draws) double* draws() { return kernel->draws.data(); }
IN_PAGE(draw_count) int draw_count() { return static_cast<int>(kernel->draws.size()); }
IN_PAGE(result) double* result() { return kernel->result.data(); }
IN_PAGE(result_count) int result_count() { return static_cast<int>(kernel->result.size()); }
IN_PAGE(samples) double* samples() { return kernel->samples.data(); }
IN_PAGE(sample_count) int sample_count() { return static_cast<int>(kernel->samples.size()); }
IN_PAGE(reason) const char* reason() { return kernel->reason.data(); }
IN_PAGE(reason_count) int reason_count() { return static_cast<int>(kernel->reason.size()); }
