#include "distributions/reached_correlation.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/copula.hpp"
#include "distributions/math_policy.hpp"
#include "distributions/step_law.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/owens_t.hpp>

#include <cmath>
#include <numbers>
#include <type_traits>
#include <variant>
#include <vector>

namespace wingspread {
namespace {

/// A law's mid-rank as a function of its normal score z. A law without jumps is continuous: its rank is Φ(z).
struct MidRank {
  struct Jump {
    double score;  ///< s_k
    double height; ///< w_k
  };
  std::vector<Jump> jumps;
  double variance = 1.0 / 12;
};

/// The distribution function's tails at each value but the last, of equal values at the last of them. Of a law with many
/// values, neighbours that together weigh little are one step: only great steps matter for (1).
std::vector<Tails> steps_of(const StepLaw& law) {
  constexpr std::size_t many = 200;
  constexpr double little = 1.0 / many; // changes V by at most a 40,000th
  std::vector<Tails> ends;
  double begin = 0; // of the last step
  for (std::size_t k = 0; k < law.values.size(); ++k) {
    if (k + 1 < law.values.size() && law.values[k + 1] == law.values[k]) continue;
    const Tails end{law.below[k], law.above[k]};
    if (law.values.size() > many && !ends.empty() && end.below - begin <= little) {
      ends.back() = end;
      continue;
    }
    begin = ends.empty() ? 0 : ends.back().below;
    ends.push_back(end);
  }
  ends.pop_back();
  return ends;
}

MidRank mid_rank(const StepLaw& law) {
  const std::vector<Tails> ends = steps_of(law);
  MidRank rank;
  double cubes = 0, begin = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const double after = k + 1 < ends.size() ? ends[k].above - ends[k + 1].above : ends[k].above;
    const double weight = ends[k].below - begin;
    rank.jumps.push_back({inverse(Normal{}, ends[k]), (weight + after) / 2});
    cubes += std::pow(weight, 3);
    begin = ends[k].below;
  }
  cubes += std::pow(ends.empty() ? 1 : ends.back().above, 3);
  rank.variance = (1 - cubes) / 12;
  return rank;
}

MidRank mid_rank(const Distribution& distribution) {
  return std::visit(
      []<class L>(const L& law) -> MidRank {
        if constexpr (std::is_same_v<L, Discrete> || std::is_same_v<L, Empirical> ||
                      std::is_same_v<L, Constant>)
          return mid_rank(step_law(law));
        else
          return {};
      },
      distribution.law);
}

/// (3). @pre |r| ≤ 1
double covariance_of_steps(double s, double t, double r) {
  const auto density = [&](double angle) {
    const double sine = std::sin(angle), cosine = std::cos(angle);
    return std::exp(-(s * s + t * t - 2 * s * t * sine) / (2 * cosine * cosine));
  };
  return boost::math::quadrature::gauss_kronrod<double, 15>::integrate(density, 0.0, std::asin(r),
                                                                       8, 1e-5) /
         (2 * std::numbers::pi);
}

/// Of a law with jumps and a continuous one: (2).
double covariance(const MidRank& stepped, double r) {
  double sum = 0;
  for (const auto& [score, height] : stepped.jumps)
    sum += height * boost::math::owens_t(score, r / std::sqrt(2 - r * r), MathPolicy());
  return sum;
}

double covariance(const MidRank& first, const MidRank& second, double r) {
  double sum = 0;
  for (const auto& [s, w] : first.jumps)
    for (const auto& [t, v] : second.jumps) sum += w * v * covariance_of_steps(s, t, r);
  return sum;
}

} // namespace

double reached_correlation(const Distribution& first, const Distribution& second, double spearman) {
  const MidRank one = mid_rank(first), other = mid_rank(second);
  const double scale = std::sqrt(one.variance * other.variance);
  if (!(scale > 0)) return 0;
  if (one.jumps.empty() && other.jumps.empty()) return spearman;
  const double r = normal_correlation(spearman);
  if (one.jumps.empty()) return covariance(other, r) / scale;
  if (other.jumps.empty()) return covariance(one, r) / scale;
  return covariance(one, other, r) / scale;
}

} // namespace wingspread
