#include "montecarlo/analyses/rare/subset_simulation.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace wingspread {
namespace {

constexpr long chain_length = 10; // L
constexpr double aimed_at =
    0.44; // share of accepted moves: optimal for one dimension (Papaioannou et al. 2015, section 4)
constexpr double first_scale =
    0.6; // λ of the first chains (ibid.); a bad value costs accepted moves in the first steps only
constexpr double bias_of_square = 0.5; // bias / δ²: the middle of the measurements in README.md
// Heuristic: share of the steps that draw labels anew. Larger: the other coordinates move less often. Smaller: the labels
// of a level stay those of its seeds.
constexpr double new_labels = 1.0 / 3;
// Heuristic. Below a tie of g a level may start its chains from so few points: the standard error of its share is then
// 1/√30 = 18 %.
constexpr long fewest_seeds = 30;

// Heuristic: so many standard errors between the largest and the smallest repetition are too many. Among 1000 normal
// repetitions they are at most 4.7 apart; logarithms of estimates with a variation of 50 % have longer tails.
constexpr double far_apart = 7;

double standard_normal(RandomStream& stream) {
  const double u = open_uniform(stream());
  return inverse(Normal{}, {u, 1 - u});
}

/// A level's points with their g, chain by chain.
struct Level {
  std::vector<NormalPoint> points;
  std::vector<double> g;
};

class SubsetSimulation {
public:
  SubsetSimulation(const LimitStateFunction& g, std::size_t dimensions,
                   const SubsetOptions& options)
      : g_(g), dimensions_(dimensions), options_(options) {
    assert(options.samples >= 10 * chain_length && options.samples % chain_length == 0);
  }

  SubsetEstimate run() {
    level_ = plain_level();
    estimate_.first_points = options_.samples;
    estimate_.first_hits = count_inside();
    double taken = undefined;
    while (true) {
      const long inside = count_inside();
      const double threshold = next_threshold();
      estimate_.stuck = inside < chains() && !(threshold < std::ranges::max(level_.g));
      const bool ends = inside >= chains() || estimate_.stuck ||
                        estimate_.last_level / chain_length <= options_.smallest;
      estimate_.reached = ends && inside > 0;
      record_level(estimate_.reached ? 0 : threshold, taken);
      if (ends) break;
      level_ = next_level(threshold, taken);
    }
    return finish_estimate();
  }

private:
  [[nodiscard]] long chains() const { return options_.samples / chain_length; }

  [[nodiscard]] long count_inside() const {
    return std::ranges::count_if(level_.g, [](double g) { return g < 0; });
  }

  std::vector<double> evaluate_points(std::span<const NormalPoint> points) {
    std::vector<double> g = g_(points);
    assert(g.size() == points.size());
    for (double& value : g)
      if (std::isnan(value)) value = -std::numeric_limits<double>::infinity();
    estimate_.evaluations += std::ssize(g);
    return g;
  }

  /// The random stream of one point of the current level.
  [[nodiscard]] RandomStream stream(long point) const {
    const std::string name = "\x7Fsubset " + std::to_string(options_.repetition) + ' ' +
                             std::to_string(estimate_.levels.size());
    return {options_.seed, static_cast<std::uint64_t>(point), stream_name(name)};
  }

  Level plain_level() {
    Level level;
    for (long k = 0; k < options_.samples; ++k) {
      RandomStream random = stream(k);
      NormalPoint point(dimensions_);
      std::ranges::generate(point, [&] { return standard_normal(random); });
      level.points.push_back(std::move(point));
    }
    level.g = evaluate_points(level.points);
    return level;
  }

  /// The lower decile of g over the points. If nine tenths of them are equal: the next smaller g outside the event, if
  /// enough points have it or less.
  [[nodiscard]] double next_threshold() const {
    std::vector<double> sorted = level_.g;
    std::ranges::sort(sorted);
    const double decile = sorted[static_cast<std::size_t>(chains() - 1)];
    const auto below = std::ranges::lower_bound(sorted, sorted.back()) - sorted.begin();
    if (decile < sorted.back() || below < fewest_seeds) return decile;
    const double next = sorted[static_cast<std::size_t>(below - 1)];
    return next < 0 ? decile : next;
  }

  /// γ_j by (4).
  [[nodiscard]] double chain_correlation(const std::vector<bool>& in, double share) const {
    if (!(share < 1) || estimate_.levels.empty()) return 0;
    double gamma = 0;
    for (long k = 1; k < chain_length; ++k) {
      long both = 0;
      for (long start = 0; start < options_.samples; start += chain_length)
        for (long at = start; at + k < start + chain_length; ++at)
          both += in[static_cast<std::size_t>(at)] && in[static_cast<std::size_t>(at + k)];
      const auto pairs = static_cast<double>(chains() * (chain_length - k));
      const double covariance = static_cast<double>(both) / pairs - share * share;
      gamma += 2 * (1 - static_cast<double>(k) / chain_length) * covariance / (share * (1 - share));
    }
    return std::max(0.0, gamma); // a negative estimate is sampling noise
  }

  void record_level(double threshold, double taken) {
    std::vector<bool> in;
    for (const double g : level_.g) in.push_back(estimate_.reached ? g < 0 : g <= threshold);
    const auto n = static_cast<double>(options_.samples);
    const double share = static_cast<double>(std::ranges::count(in, true)) / n;
    const double gamma = chain_correlation(in, share);
    const double variation = std::sqrt((1 - share) / (share * n) * (1 + gamma) * copies_);
    estimate_.levels.push_back({threshold, share, gamma, variation, taken});
    estimate_.last_level *= share;
  }

  /// Indices of c points with g ≤ threshold: evenly chosen if there are more than c, repeated if there are fewer.
  [[nodiscard]] std::vector<std::size_t> seeds(double threshold) const {
    std::vector<std::size_t> in;
    for (std::size_t k = 0; k < level_.g.size(); ++k)
      if (level_.g[k] <= threshold) in.push_back(k);
    std::vector<std::size_t> chosen;
    const std::size_t wanted = static_cast<std::size_t>(chains());
    for (std::size_t k = 0; k < wanted; ++k) chosen.push_back(in[k * in.size() / wanted]);
    return chosen;
  }

  struct Candidate {
    NormalPoint point;
    bool scaled; ///< by (2), not by new labels
  };

  [[nodiscard]] Candidate candidate_from(const NormalPoint& from, RandomStream random) const {
    NormalPoint to(dimensions_);
    const std::vector<std::size_t>& labels = options_.labels;
    const double share = labels.size() == dimensions_ ? 1 : new_labels;
    if (const double u = labels.empty() ? 1 : open_uniform(random()); u < share) {
      to = from;
      const auto one = static_cast<std::size_t>(u / share * static_cast<double>(labels.size()));
      for (std::size_t k = 0; k < labels.size(); ++k)
        if (open_uniform(random()) < label_share_ || k == one)
          to[labels[k]] = standard_normal(random);
      return {std::move(to), false};
    }
    const double rho = std::sqrt(1 - scale_ * scale_);
    for (std::size_t i = 0; i < dimensions_; ++i)
      to[i] = rho * from[i] + scale_ * standard_normal(random);
    for (const std::size_t label : labels) to[label] = from[label];
    return {std::move(to), true};
  }

  /// The next level: all chains advance step by step.
  Level next_level(double threshold, double& taken) {
    std::vector<NormalPoint> at;
    std::vector<double> g;
    const auto inside = std::ranges::count_if(level_.g, [&](double x) { return x <= threshold; });
    copies_ = std::max(1.0, static_cast<double>(chains()) / static_cast<double>(inside));
    for (const std::size_t seed : seeds(threshold)) {
      at.push_back(level_.points[seed]);
      g.push_back(level_.g[seed]);
    }
    const std::size_t chains = at.size();
    Level level;
    level.points.resize(chains * chain_length);
    level.g.resize(chains * chain_length);
    long moves = 0;
    for (long step = 0; step < chain_length; ++step) {
      if (step > 0) moves += advance_chains(step, threshold, at, g);
      for (std::size_t chain = 0; chain < chains; ++chain) {
        const std::size_t place = chain * chain_length + static_cast<std::size_t>(step);
        level.points[place] = at[chain];
        level.g[place] = g[chain];
      }
    }
    taken = static_cast<double>(moves) / static_cast<double>(chains * (chain_length - 1));
    return level;
  }

  /// Advances every chain by one step and adapts λ. @return the number of accepted moves
  long advance_chains(long step, double threshold, std::vector<NormalPoint>& at,
                      std::vector<double>& g) {
    std::vector<NormalPoint> candidates;
    std::vector<bool> scaled;
    for (std::size_t chain = 0; chain < at.size(); ++chain) {
      Candidate candidate =
          candidate_from(at[chain], stream(static_cast<long>(chain) * chain_length + step));
      candidates.push_back(std::move(candidate.point));
      scaled.push_back(candidate.scaled);
    }
    const std::vector<double> there = evaluate_points(candidates);
    long moves = 0, scaled_moves = 0;
    for (std::size_t chain = 0; chain < at.size(); ++chain) {
      if (!(there[chain] <= threshold)) continue;
      at[chain] = std::move(candidates[chain]);
      g[chain] = there[chain];
      ++moves, scaled_moves += scaled[chain];
    }
    const auto tried = std::ranges::count(scaled, true);
    adapt(scale_, scaled_moves, tried, step);
    adapt(label_share_, moves - scaled_moves, std::ssize(scaled) - tried, step);
    return moves;
  }

  /// Robbins and Monro's step for a value up to 1 that makes fewer moves acceptable the larger it is.
  static void adapt(double& value, long accepted, long tried, long step) {
    if (tried == 0) return;
    const double share = static_cast<double>(accepted) / static_cast<double>(tried);
    value = std::min(1.0, value * std::exp((share - aimed_at) / std::sqrt(step)));
  }

  SubsetEstimate finish_estimate() {
    double square = 0;
    for (const SubsetLevel& level : estimate_.levels) square += level.variation * level.variation;
    estimate_.variation = std::sqrt(square);
    estimate_.probability = estimate_.stuck && !estimate_.reached ? 0 : estimate_.last_level;
    for (std::size_t k = 0; k < level_.g.size(); ++k)
      if (level_.g[k] < 0) estimate_.inside.push_back(std::move(level_.points[k]));
    return std::move(estimate_);
  }

  const LimitStateFunction& g_;
  std::size_t dimensions_;
  SubsetOptions options_;
  SubsetEstimate estimate_;
  Level level_;
  double scale_ = first_scale;       ///< λ
  double label_share_ = first_scale; ///< q
  double copies_ = 1;                ///< chains of the level that start from one point
};

/// The relative standard error of the mean.
double relative_spread(std::span<const double> values, double mean) {
  if (values.size() < 2) return undefined;
  return moments(values).std / (mean * std::sqrt(static_cast<double>(values.size())));
}

bool ends_at_first(const SubsetEstimate& estimate) { return estimate.levels.size() == 1; }

/// Whether the event is not rare: the first levels alone estimate it.
bool is_plain(std::span<const SubsetEstimate> estimates) {
  return std::ranges::all_of(estimates, ends_at_first) ||
         std::ranges::any_of(estimates, [](const SubsetEstimate& estimate) {
           return ends_at_first(estimate) && !estimate.stuck;
         });
}

/// Estimates by the share of the pooled first levels.
void estimate_plainly(double confidence, RareEstimate& all) {
  all.bias = 0;
  all.plain = all.reached = true;
  all.probability = static_cast<double>(all.hits) / static_cast<double>(all.draws);
  all.interval = clopper_pearson(all.hits, all.draws, confidence);
  all.plain_runs = static_cast<double>(all.draws);
  all.from_spread = undefined;
  all.variation = all.from_chains =
      std::sqrt((1 - all.probability) / (all.probability * all.plain_runs));
}

/// The probabilities of the repetitions: the last levels' if none reached the event.
std::vector<double> probabilities_of(std::span<const SubsetEstimate> estimates) {
  const bool none = std::ranges::none_of(estimates, &SubsetEstimate::reached);
  std::vector<double> probabilities;
  for (const SubsetEstimate& estimate : estimates)
    probabilities.push_back(none ? estimate.last_level : estimate.probability);
  return probabilities;
}

/// Estimates by the mean of the repetitions.
void estimate_by_levels(std::span<const SubsetEstimate> estimates, double confidence,
                        RareEstimate& all) {
  const std::vector<double> probabilities = probabilities_of(estimates);
  const double count = static_cast<double>(estimates.size());
  double square = 0, bias = 0;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const double variation = estimates[k].variation;
    square += std::pow(probabilities[k] * variation, 2);
    if (!ends_at_first(estimates[k])) bias += bias_of_square * variation * variation;
  }
  all.probability = moments(probabilities).mean;
  all.bias = bias / count;
  all.from_chains = std::sqrt(square) / (count * all.probability);
  all.from_spread = relative_spread(probabilities, all.probability);
  all.variation = std::fmax(all.from_chains, all.from_spread);
  double reach = two_sided_normal(confidence) * all.from_chains;
  if (estimates.size() > 1)
    reach = std::max(reach, two_sided_student(std::ssize(probabilities) - 1, confidence) *
                                all.from_spread);
  // The bias does not shrink with more repetitions, as the reach does: without it, 10 % of lower bounds at 95 % would be
  // above P with 20 of them. The upper bound keeps it, on the safe side.
  all.interval = {all.reached ? all.probability * std::exp(-reach - all.bias) : 0,
                  std::min(1.0, all.probability * std::exp(reach))};
  all.plain_runs = (1 - all.probability) / (all.probability * all.variation * all.variation);
}

/// Widens the interval if some repetition was stuck at an atom (subset_simulation.hpp).
void widen_for_atom(double confidence, RareEstimate& all) {
  const Interval counted =
      clopper_pearson_of_share(all.probability, std::max(1.0, all.plain_runs), confidence);
  all.interval = {std::min(all.interval.lower, counted.lower),
                  std::max(all.interval.upper, counted.upper)};
}

} // namespace

SubsetEstimate subset_simulation(const LimitStateFunction& g, std::size_t dimensions,
                                 const SubsetOptions& options) {
  return SubsetSimulation(g, dimensions, options).run();
}

bool repetitions_disagree(std::span<const SubsetEstimate> estimates) {
  if (estimates.size() < 2 || is_plain(estimates)) return false;
  const auto reached = std::ranges::count_if(estimates, &SubsetEstimate::reached);
  if (reached == 0) return false;
  if (reached < std::ssize(estimates)) return true;
  RareEstimate all;
  estimate_by_levels(estimates, 0.95, all);
  if (all.from_spread > 2 * all.from_chains) return true;
  const auto [least, most] = std::ranges::minmax(
      estimates, {}, [](const SubsetEstimate& each) { return each.probability; });
  return std::log(most.probability / least.probability) >
         far_apart * std::hypot(least.variation, most.variation);
}

long most_evaluations(const SubsetOptions& options) {
  const auto levels = static_cast<long>(std::ceil(-std::log10(options.smallest))); // each a tenth
  return options.samples + levels * (options.samples - options.samples / chain_length);
}

RareEstimate combined(std::span<const SubsetEstimate> estimates, double confidence) {
  assert(!estimates.empty());
  RareEstimate all;
  all.reached = std::ranges::any_of(estimates, &SubsetEstimate::reached) &&
                std::ranges::all_of(estimates, [](const SubsetEstimate& estimate) {
                  return estimate.reached || estimate.stuck;
                });
  for (const SubsetEstimate& estimate : estimates) {
    all.evaluations += estimate.evaluations;
    all.hits += estimate.first_hits;
    all.draws += estimate.first_points;
  }
  if (is_plain(estimates)) {
    estimate_plainly(confidence, all);
  } else {
    estimate_by_levels(estimates, confidence, all);
    if (all.reached && std::ranges::any_of(estimates, &SubsetEstimate::stuck))
      widen_for_atom(confidence, all);
    const bool none = std::ranges::none_of(estimates, &SubsetEstimate::reached);
    if (none && clopper_pearson(0, all.draws, confidence).upper < all.interval.upper)
      estimate_plainly(confidence, all);
  }
  return all;
}

} // namespace wingspread
