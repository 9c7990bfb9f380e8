#include "montecarlo/analyses/fit/trace_check.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/analyses/fit/parameter_space.hpp"
#include "montecarlo/engine/runs/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace wingspread {
namespace {

// Heuristics. A trace is refused only where it misses all runs of the prior by 30 % of its range and another column,
// unit or sense fits to 10 % and five times better: with less, a good trace of an unlikely unit would be refused; with
// more, a trace in degrees would pass. 16 runs show the prior's spread; 10 to 500 numbers of a trace are enough to tell.
constexpr long prior_runs = 16;
constexpr std::size_t least_compared = 10, most_compared = 500;
constexpr double own_misfit = 0.3, other_fit = 0.1, times_better = 5;

/// A hypothesis: measured number = factor · column of the trajectory at (time · time_factor − time_shift), less the
/// column's first value if it counts from the start.
struct Explanation {
  std::size_t column = 0; ///< of the trajectory, without t
  double factor = 1, time_factor = 1, time_shift = 0;
  bool from_start = false;
};

/// Root mean square of the residuals, and the largest predicted number less the least.
struct Misfit {
  double rms = std::numeric_limits<double>::infinity(), range = 0;
};

/// The prior's median, then independent points.
void place_in_prior(long run, std::span<Tails> u) {
  RandomStream random(0, static_cast<std::uint64_t>(run),
                      stream_name("\x7F"
                                  "trace"));
  for (Tails& at : u) at = run == 0 ? Tails{0.5, 0.5} : tails_of_uniform(open_uniform(random()));
}

class Comparison {
public:
  Comparison(const FitTest& test, const std::vector<std::size_t>& fitted)
      : test_(test), campaign_(fixed_but(test.campaign, fitted)),
        names_(trajectory_columns(test.campaign.scene)), samples_(samples_of(test, names_.size())),
        motion_(test.campaign.scene, samples_) {
    const RunPlan plan(campaign_, place_in_prior, samples_);
    Runner runner(plan);
    for (long k = 0; k < prior_runs; ++k) {
      std::vector<double> numbers = runner.run(k).outputs;
      if (motion_.is_whole(numbers)) runs_.push_back(std::move(numbers));
    }
  }

  /// Another explanation of the test's column c; nothing if its own is good enough, or no other is good.
  [[nodiscard]] std::optional<Explanation> explain(std::size_t c) const {
    const std::size_t own = test_.columns[c].index - 1;
    const Misfit as_given = misfit(c, {own});
    if (runs_.empty() || !(as_given.rms > own_misfit * as_given.range)) return std::nullopt;
    Misfit least;
    std::optional<Explanation> best;
    for (const Explanation& other : others(c)) {
      const Misfit found = misfit(c, other);
      if (!(found.rms < other_fit * found.range && found.rms < least.rms)) continue;
      least = found;
      best = other;
    }
    return as_given.rms > times_better * least.rms ? best : std::nullopt;
  }

  [[nodiscard]] const std::string& name_of(const Explanation& other) const {
    return names_[other.column + 1];
  }

private:
  static SampledColumns samples_of(const FitTest& test, std::size_t count) {
    SampledColumns samples;
    for (std::size_t k = 1; k < count; ++k) samples.columns.push_back(k);
    samples.t_end = std::min(test.times.back(), test.campaign.integration.t_end);
    samples.interval =
        samples.t_end / (most_compared + 0.5); // the last sample is not lost by rounding
    return samples;
  }

  [[nodiscard]] std::vector<Explanation> others(std::size_t c) const {
    constexpr double degrees = 180 / std::numbers::pi;
    const FitColumn& column = test_.columns[c];
    const std::size_t own = column.index - 1;
    std::vector<Explanation> list;
    // turns, in SI or as degrees; milliradians as degrees
    constexpr double turns = degrees / 360, turns_as_degrees = 1 / 360.0,
                     milli_as_degrees = 1e3 / degrees;
    for (const double factor :
         {-1.0, degrees, 1 / degrees, 1e3, 1e-3, turns, turns_as_degrees, milli_as_degrees})
      list.push_back({own, factor});
    list.push_back({own, 1, 1e-3});
    constexpr double explained =
        4; // standard deviations: an offset that the test allows is no mistake
    if (test_.times.front() > explained * test_.time_offset_std)
      list.push_back({own, 1, 1, test_.times.front()});
    const bool is_angle = column.unit == "rad" && !runs_.empty();
    if (is_angle && std::abs(motion_.at(runs_.front(), own, 0)) > explained * column.offset_std)
      for (const double factor : {1.0, -1.0, degrees, -degrees, 1 / degrees, -1 / degrees})
        list.push_back({own, factor, 1, 0, true});
    for (std::size_t k = 1; k < names_.size(); ++k)
      if (k != column.index && unit_of_column(names_[k]) == column.unit) list.push_back({k - 1});
    return list;
  }

  /// The least over the runs.
  [[nodiscard]] Misfit misfit(std::size_t c, const Explanation& other) const {
    const std::vector<double>& measured = test_.columns[c].measured;
    const std::size_t stride = measured.size() / most_compared + 1;
    Misfit least;
    for (const std::vector<double>& run : runs_) {
      double sum = 0, low = std::numeric_limits<double>::infinity(), high = -low;
      long count = 0;
      for (std::size_t i = 0; i < measured.size(); i += stride, ++count) {
        const double t = test_.times[i] * other.time_factor - other.time_shift;
        const double start = other.from_start ? motion_.at(run, other.column, 0) : 0;
        const double predicted = other.factor * (motion_.at(run, other.column, t) - start);
        sum += std::pow(measured[i] - predicted, 2);
        low = std::min(low, predicted), high = std::max(high, predicted);
      }
      const double rms = std::sqrt(sum / static_cast<double>(count));
      if (rms < least.rms) least = {rms, high - low};
    }
    return least;
  }

  const FitTest& test_;
  const Campaign campaign_;
  const std::vector<std::string> names_;
  const SampledColumns samples_;
  const SampledMotion motion_;
  std::vector<std::vector<double>> runs_; ///< their samples
};

/// @param at the column's, `time` the time's
void refuse(const TraceColumn& at, const TraceColumn& time, const std::string& own,
            const Explanation& other, const std::string& its_name) {
  if (other.time_factor != 1)
    return void(time.at.refuse("times a thousand times too long for the motion, as in milliseconds",
                               "seconds, or \"time\": { \"column\": \"" + time.header +
                                   "\", \"unit\": \"ms\" }"));
  if (other.time_shift != 0)
    return void(
        time.at.refuse(fmt::format("times that begin at {:g} s, with a motion that begins there",
                                   other.time_shift),
                       "times since the release"));
  if (its_name != own)
    return void(at.at.refuse(fmt::format("the motion of {}", its_name),
                             fmt::format("the motion of {}: is it another hinge's column?", own)));
  if (other.from_start)
    return void(at.at.refuse(fmt::format("the travel from the start of the motion{}",
                                         other.factor < 0 ? ", in the opposite sense" : ""),
                             fmt::format("{}, which begins at its stowed angle{}", own,
                                         other.factor == 1 || other.factor == -1
                                             ? ""
                                             : ", in a \"unit\" that fits the numbers")));
  if (other.factor < 0)
    return void(at.at.refuse(
        "the motion in the opposite sense",
        fmt::format("the sense of {}, towards the latched angle as in the scene", own)));
  at.at.refuse(fmt::format("numbers {:.3g} times those of the motion", other.factor),
               other.factor == 1e3 || other.factor == 1e-3
                   ? "a \"unit\" that fits the numbers"
                   : "a \"unit\" that fits the numbers: \"rad\" or \"deg\"?");
}

} // namespace

void refuse_foreign_trace(const FitTest& test, const std::vector<std::size_t>& fitted,
                          std::span<const TraceColumn> columns) {
  if (test.times.size() < least_compared || !(test.times.back() > 0)) return;
  const Comparison comparison(test, fitted);
  for (std::size_t c = 0; c < test.columns.size(); ++c) {
    const auto other = comparison.explain(c);
    if (!other) continue;
    refuse(columns[c + 1], columns[0], test.columns[c].name, *other, comparison.name_of(*other));
    if (other->time_factor != 1 || other->time_shift != 0) return; // the same for all columns
  }
}

} // namespace wingspread
