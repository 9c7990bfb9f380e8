#include "distributions/reached_correlation.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/copula.hpp"
#include "distributions/step_law.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>
#include <vector>

namespace wingspread {
namespace {

double normal_below(double z) { return std::erfc(-z / std::sqrt(2.0)) / 2; }

/// The steps of a law's distribution function; none of a continuous law.
struct TieSteps {
  std::vector<double> ends;   ///< the distribution function at each value, ascending to 1
  std::vector<double> scores; ///< Φ⁻¹ of the ends

  [[nodiscard]] bool empty() const { return ends.empty(); }
  [[nodiscard]] double begin(std::size_t k) const { return k == 0 ? 0 : ends[k - 1]; }
  [[nodiscard]] double middle(std::size_t k) const { return (begin(k) + ends[k]) / 2; }

  [[nodiscard]] double variance() const {
    double cubes = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) cubes += std::pow(ends[k] - begin(k), 3);
    return (1 - cubes) / 12;
  }
  /// E[R | the other's score z].
  [[nodiscard]] double mean_rank(double r, double z) const {
    if (empty()) return normal_below(r * z / std::sqrt(2 - r * r));
    double sum = 0, below = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const double up_to =
          k + 1 == ends.size() ? 1 : normal_below((scores[k] - r * z) / std::sqrt(1 - r * r));
      sum += middle(k) * (up_to - below);
      below = up_to;
    }
    return sum;
  }
};

TieSteps steps_of(const StepLaw& law) {
  // Ties of more values than these have no effect that matters; heuristic.
  constexpr std::size_t most = 200;
  TieSteps steps;
  for (std::size_t k = 0; k < law.values.size(); ++k)
    if (k + 1 == law.values.size() || law.values[k + 1] != law.values[k])
      steps.ends.push_back(law.below[k]);
  if (steps.ends.size() > most) return {};
  for (const double end : steps.ends)
    steps.scores.push_back(end < 1 ? inverse(Normal{}, tails_of_uniform(end)) : 0);
  return steps;
}

TieSteps steps_of(const Distribution& distribution) {
  return std::visit(
      []<class L>(const L& law) -> TieSteps {
        if constexpr (std::is_same_v<L, Discrete> || std::is_same_v<L, Empirical> ||
                      std::is_same_v<L, Constant>)
          return steps_of(step_law(law));
        else
          return {};
      },
      distribution.law);
}

} // namespace

double reached_correlation(const Distribution& first, const Distribution& second, double spearman) {
  constexpr int points = 400; // of the middle rule; heuristic
  const TieSteps one = steps_of(first), other = steps_of(second);
  const double scale = std::sqrt(one.variance() * other.variance());
  if (!(scale > 0)) return 0;
  const double r = normal_correlation(spearman);
  double sum = 0;
  const std::size_t parts = std::max<std::size_t>(other.ends.size(), 1);
  for (std::size_t k = 0; k < parts; ++k) {
    const double from = other.empty() ? 0 : other.begin(k), to = other.empty() ? 1 : other.ends[k];
    const int count = std::max(8, static_cast<int>(points * (to - from)));
    for (int i = 0; i < count; ++i) {
      const double u = from + (to - from) * (i + 0.5) / count;
      const double rank = other.empty() ? u : other.middle(k);
      sum += (to - from) / count * rank * one.mean_rank(r, inverse(Normal{}, tails_of_uniform(u)));
    }
  }
  return (sum - 0.25) / scale;
}

} // namespace wingspread
