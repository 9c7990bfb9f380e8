/// The quantities that the work-precision study compares, and the differences of two runs in them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace wingspread::study {

/// The quantities of one run. Vectors over hinges are in Scene order; NaN where a hinge did not latch.
struct Figures {
  std::vector<int> order;     ///< hinges as they latched
  std::vector<double> time;   ///< of latching, s
  std::vector<double> rate;   ///< of the hinge when it latches, rad/s
  std::vector<double> moment; ///< peak, N·m; empty if not requested
  std::vector<double> force;  ///< peak, N; empty if not requested
};

/// @param outcome core's Outcome, or an oracle's ReferenceOutcome
template <class AnyOutcome>
[[nodiscard]] Figures figures_of(const AnyOutcome& outcome, std::size_t hinges) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Figures figures{{}, std::vector(hinges, none), std::vector(hinges, none), {}, {}};
  for (const auto& latch : outcome.latches) {
    figures.order.push_back(latch.hinge);
    figures.time[latch.hinge] = latch.time;
    figures.rate[latch.hinge] = latch.rates[latch.hinge];
  }
  for (const auto& peak : outcome.peak_moment) figures.moment.push_back(peak.value);
  for (const auto& peak : outcome.peak_force) figures.force.push_back(peak.value);
  return figures;
}

/// Relative errors of one quantity, over hinges and scenes.
struct Errors {
  double squares = 0, largest = 0;
  long count = 0;

  void add(double got, double expected) {
    const double error = std::abs(got - expected) / std::abs(expected);
    squares += error * error;
    largest = std::max(largest, error);
    ++count;
  }
  /// The root mean square of the errors; NaN if there are none.
  [[nodiscard]] double rms() const { return std::sqrt(squares / static_cast<double>(count)); }
};

struct FigureErrors {
  Errors time, rate, moment, force;

  /// Adds the errors of all hinges that latched in `got`, and of all peaks that both runs have.
  /// @pre hinges that latched in `got` latched in `expected`
  void add(const Figures& got, const Figures& expected) {
    for (const int hinge : got.order) {
      time.add(got.time[hinge], expected.time[hinge]);
      rate.add(got.rate[hinge], expected.rate[hinge]);
    }
    for (std::size_t hinge = 0; hinge < std::min(got.moment.size(), expected.moment.size());
         ++hinge)
      moment.add(got.moment[hinge], expected.moment[hinge]);
    for (std::size_t hinge = 0; hinge < std::min(got.force.size(), expected.force.size()); ++hinge)
      force.add(got.force[hinge], expected.force[hinge]);
  }
};

} // namespace wingspread::study
