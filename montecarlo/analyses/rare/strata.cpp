#include "montecarlo/analyses/rare/strata.hpp"

#include "distributions/copula.hpp"
#include "distributions/step_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace wingspread {
namespace {

// Heuristic. A level starts chains from the tenth of its runs nearest to the event. If a value that is drawn 30 times
// causes the event, about 30 of these chains have it, and its share has a standard error of 1/√30 = 18 %. A smaller
// number leaves rarer values to chance.
constexpr double fewest_draws = 30;
// A value drawn 10 times on average is missed with probability e^−10 = 5e-5.
constexpr double enough_draws = 10;
// Heuristic: a law with more rare values, or with more probability on them, is a sample of a continuous law. Its order
// lets the simulation climb, so it needs no strata.
constexpr std::size_t most_rare_values = 20;
constexpr double most_rare_mass = 0.5;
// Heuristic: so many values may be types or suppliers, in any order. More are a sample: moves of a scale suit it better.
constexpr std::size_t most_label_values = 20;
// Ten releases that may fail have 1 + 10 + 45 strata with at most two failures.
constexpr std::size_t most_strata = 64;
// Heuristic: of 30 parts that fail rarely, 1024 of the other combinations have more than 99 % of their probability. More
// take memory, fewer leave more to the upper bound.
constexpr std::size_t most_others = 1024;
constexpr double right_angle = 1e-12; // |cosine| of orthogonal unit rows, with rounding

struct Value {
  double value;
  TailInterval interval;
  bool rare = false;
};

/// A dispersion whose rare values are drawn by themselves.
struct Split {
  std::string name;
  std::vector<double> direction;
  std::vector<Value> values;
};

double mass_between(const Tails& from, const Tails& to) {
  return to.below <= 0.5 ? to.below - from.below : from.above - to.above;
}

/// The different values of a law with their intervals.
std::vector<Value> values_of(const StepLaw& law) {
  std::vector<Value> values;
  for (std::size_t i = 0; i < law.values.size(); ++i) {
    const Tails to{law.below[i], law.above[i]};
    if (values.empty() || values.back().value != law.values[i]) {
      const Tails from = values.empty() ? Tails{0, 1} : values.back().interval.to;
      values.push_back({law.values[i], {from, to, 0}});
    }
    TailInterval& interval = values.back().interval;
    interval.to = to;
    interval.mass = mass_between(interval.from, to);
  }
  return values;
}

/// The values of a discrete or an empirical law; none of any other law.
std::vector<Value> discrete_values(const Dispersion& dispersion) {
  return std::visit(
      []<class L>(const L& law) -> std::vector<Value> {
        if constexpr (std::is_same_v<L, Discrete> || std::is_same_v<L, Empirical>)
          return values_of(step_law(law));
        else
          return {};
      },
      dispersion.distribution.law);
}

/// The unit rows of the copula's factor, by coordinate.
std::vector<std::vector<double>> directions_of(const Campaign& campaign,
                                               const Coordinates& coordinates) {
  const std::size_t count = coordinates.names.size();
  const std::vector<std::size_t> order = order_by_name(coordinates.names);
  std::vector<std::size_t> place(count);
  for (std::size_t i = 0; i < count; ++i) place[order[i]] = i;
  std::vector<RankCorrelation> ordered = campaign.wanted_correlations;
  for (RankCorrelation& pair : ordered)
    pair.first = place[coordinates.of[pair.first]],
    pair.second = place[coordinates.of[pair.second]];
  const auto factor = cholesky(normal_correlations(count, ordered));
  std::vector<std::vector<double>> rows(count, std::vector<double>(count));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      rows[order[i]][order[j]] =
          (*factor)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return rows;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Marks the rare values. @return their probability, and their number
std::pair<double, std::size_t> mark_rare(std::vector<Value>& values, long samples) {
  double mass = 0;
  std::size_t count = 0;
  for (Value& value : values) {
    value.rare = value.interval.mass * static_cast<double>(samples) < fewest_draws;
    if (!value.rare) continue;
    mass += value.interval.mass;
    ++count;
  }
  return {mass, count};
}

double rarest(const std::vector<Value>& values) {
  double least = 1;
  for (const Value& value : values) least = std::min(least, value.interval.mass);
  return least;
}

/// Notes a dispersion with a value of this probability that the first levels may miss.
void note_unseen(const std::string& name, double probability, const StrataOptions& options,
                 Strata& strata) {
  const double draws = probability * static_cast<double>(options.samples * options.repeats);
  if (draws < enough_draws &&
      std::ranges::none_of(strata.unseen, [&](const auto& each) { return each.first == name; }))
    strata.unseen.emplace_back(name, draws);
}

std::vector<Split> splits_of(const Campaign& campaign, const StrataOptions& options,
                             Strata& strata) {
  const Coordinates coordinates = coordinates_of(campaign.dispersions);
  const std::vector<std::vector<double>> directions = directions_of(campaign, coordinates);
  std::vector<Split> splits;
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i) {
    const Dispersion& dispersion = campaign.dispersions[i];
    if (!dispersion.rows.empty()) { // rows have no order, and all have the same probability
      const auto& law = std::get<Empirical>(dispersion.distribution.law);
      note_unseen(dispersion.rows, 1 / static_cast<double>(law.values.size()), options, strata);
      continue;
    }
    std::vector<Value> values = discrete_values(dispersion);
    const auto [mass, count] = mark_rare(values, options.samples);
    if (count == 0) continue;
    const std::vector<double>& direction = directions[coordinates.of[i]];
    const bool apart = std::ranges::all_of(splits, [&](const Split& split) {
      return std::abs(dot(split.direction, direction)) < right_angle;
    });
    if (apart && count <= most_rare_values && mass <= most_rare_mass)
      splits.push_back({dispersion.name, direction, std::move(values)});
    else
      note_unseen(dispersion.name, rarest(values), options, strata);
  }
  return splits;
}

void restrict_to(const Split& split, std::vector<TailInterval> intervals, Stratum& stratum) {
  double mass = 0;
  for (const TailInterval& interval : intervals) mass += interval.mass;
  stratum.probability *= mass;
  stratum.restricted.push_back({split.direction, std::move(intervals), mass});
}

/// The parts of a stratum by the values of one more dispersion: all common ones, and each rare one.
std::vector<Stratum> parts_of(const Stratum& stratum, const Split& split) {
  std::vector<TailInterval> common;
  for (const Value& value : split.values)
    if (!value.rare) common.push_back(value.interval);
  std::vector<Stratum> parts{stratum};
  restrict_to(split, std::move(common), parts.front());
  for (const Value& value : split.values) {
    if (!value.rare) continue;
    parts.push_back(stratum);
    restrict_to(split, {value.interval}, parts.back());
    parts.back().rare.emplace_back(split.name, value.value);
  }
  return parts;
}

void sort_by_probability(std::vector<Stratum>::iterator first, std::vector<Stratum>& list) {
  std::ranges::stable_sort(first, list.end(), std::ranges::greater{}, &Stratum::probability);
}

/// Moves all but the most_strata most probable strata to the others, of which it keeps most_others. Leaves out the rest,
/// and strata less probable than `smallest`.
void keep_probable(double smallest, Strata& strata, std::vector<Stratum>& others) {
  std::vector<Stratum>& list = strata.list;
  sort_by_probability(list.begin() + 1, list);
  while (list.size() > 1 && (list.size() > most_strata || list.back().probability < smallest)) {
    if (list.back().probability < smallest)
      strata.left_out += list.back().probability;
    else
      others.push_back(std::move(list.back()));
    list.pop_back();
  }
  sort_by_probability(others.begin(), others);
  for (; others.size() > most_others; others.pop_back())
    strata.left_out += others.back().probability;
}

/// Whether a stratum leaves a single value in this direction.
bool is_fixed(const Stratum& stratum, const std::vector<double>& direction) {
  return std::ranges::any_of(stratum.restricted, [&](const RestrictedCoordinate& each) {
    return each.direction == direction && each.intervals.size() == 1;
  });
}

std::vector<std::size_t> labels_of(const Campaign& campaign, const Stratum& stratum) {
  const Coordinates coordinates = coordinates_of(campaign.dispersions);
  const std::vector<std::vector<double>> directions = directions_of(campaign, coordinates);
  std::set<std::size_t> labels;
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i) {
    const std::size_t values = discrete_values(campaign.dispersions[i]).size();
    const bool is_label = campaign.dispersions[i].rows.empty()
                              ? values > 1 && values <= most_label_values
                              : values > 1;
    if (is_label && !is_fixed(stratum, directions[coordinates.of[i]]))
      labels.insert(coordinates.of[i]);
  }
  if (!stratum.others.empty()) labels.insert(coordinates.names.size());
  return {labels.begin(), labels.end()};
}

/// The stratum among the others that the coordinate chooses.
const Stratum& chosen(const Stratum& stratum, double coordinate) {
  double below = unit_point(coordinate).below * stratum.probability;
  const auto holds = [&](const Stratum& each) { return (below -= each.probability) < 0; };
  const auto found = std::ranges::find_if(stratum.others, holds);
  return found == stratum.others.end() ? stratum.others.back() : *found;
}

/// The point of the intervals below which lies the share v.below of their mass.
Tails point_of(const RestrictedCoordinate& set, const Tails& v) {
  const bool upwards = v.below <= v.above;
  double rest = (upwards ? v.below : v.above) * set.mass;
  const std::size_t count = set.intervals.size();
  std::size_t k = 0;
  const auto at = [&] { return set.intervals[upwards ? k : count - 1 - k]; };
  for (; k + 1 < count && rest > at().mass; ++k) rest -= at().mass;
  const TailInterval interval = at();
  rest = std::min(rest, interval.mass);
  const double x = upwards ? rest : interval.mass - rest, y = interval.mass - x;
  constexpr double least = std::numeric_limits<double>::min();
  return {std::max(interval.from.below + x, least),
          std::max(interval.to.above + (upwards ? y : rest), least)};
}

bool was_reached(const StratumEstimate& part) {
  return std::ranges::any_of(part.estimates, &SubsetEstimate::reached);
}

/// Sums over strata; each with its stratum's probability.
struct Parts {
  double below = 0, above = 0; ///< squares of the distances to the bounds
  double unreached = 0;        ///< upper bounds of strata whose event was not reached
  double variation = 0, chains = 0, spread = 0; ///< squares of the standard errors
  double bias = 0;                              ///< of the sum
};

double square(double x) { return x * x; }

void add_part(const StratumEstimate& part, bool none_reached, RareEstimate& all, Parts& parts) {
  const double w = part.stratum.probability;
  const RareEstimate& one = part.estimate;
  all.evaluations += one.evaluations;
  all.hits += one.hits;
  all.draws += one.draws;
  const double p = was_reached(part) || none_reached ? one.probability : 0;
  all.probability += w * p;
  if (one.reached) {
    parts.below += square(w * (p - one.interval.lower));
    parts.above += square(w * (one.interval.upper - p));
  } else {
    parts.below += square(w * p);
    parts.unreached += w * (one.interval.upper - p);
  }
  if (!(p > 0)) return;
  parts.variation += square(w * p * one.variation);
  parts.chains += square(w * p * one.from_chains);
  parts.spread += square(w * p * (one.plain ? one.from_chains : one.from_spread));
  parts.bias += w * p * one.bias;
}

} // namespace

std::string describe(const Stratum& stratum) {
  if (!stratum.others.empty()) return "others with rare values";
  std::string text;
  for (const auto& [name, value] : stratum.rare)
    text += fmt::format("{}{} = {:.6g}", text.empty() ? "" : ", ", name, value);
  return text.empty() ? "no rare value" : text;
}

Strata strata_of(const Campaign& campaign, const StrataOptions& options) {
  Strata strata{{Stratum{}}, 0, {}};
  std::vector<Stratum> others;
  for (const Split& split : splits_of(campaign, options, strata)) {
    std::vector<Stratum> finer;
    for (const Stratum& stratum : strata.list)
      std::ranges::move(parts_of(stratum, split), std::back_inserter(finer));
    strata.list = std::move(finer);
    keep_probable(options.smallest, strata, others);
  }
  if (!others.empty()) {
    Stratum together{0, {}, {}, std::move(others)};
    for (const Stratum& each : together.others) together.probability += each.probability;
    strata.list.push_back(std::move(together));
  }
  for (Stratum& stratum : strata.list) stratum.labels = labels_of(campaign, stratum);
  return strata;
}

std::size_t coordinates_in(const Stratum& stratum, std::size_t own) {
  return stratum.others.empty() ? own : own + 1;
}

NormalPoint within(const Stratum& stratum, NormalPoint z) {
  if (!stratum.others.empty()) {
    const Stratum& one = chosen(stratum, z.back());
    z.pop_back();
    return within(one, std::move(z));
  }
  for (const RestrictedCoordinate& coordinate : stratum.restricted) {
    const double y = dot(coordinate.direction, z);
    const double moved = inverse(Normal{}, point_of(coordinate, unit_point(y))) - y;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += moved * coordinate.direction[i];
  }
  return z;
}

RareEstimate sum_of(const std::vector<StratumEstimate>& strata, double left_out) {
  if (strata.size() == 1 && left_out == 0) return strata.front().estimate;
  const bool none = std::ranges::none_of(strata, was_reached);
  RareEstimate all;
  Parts parts;
  for (const StratumEstimate& part : strata) add_part(part, none, all, parts);
  parts.unreached += left_out;
  const double p = all.probability;
  if (!(p > 0)) {
    all.interval = {0, std::min(1.0, std::sqrt(parts.above) + parts.unreached)};
    return all;
  }
  all.variation = std::sqrt(parts.variation) / p;
  all.from_chains = std::sqrt(parts.chains) / p;
  all.from_spread = std::sqrt(parts.spread) / p;
  all.bias = parts.bias / p;
  all.interval = {none ? 0 : std::max(0.0, p - std::sqrt(parts.below)),
                  std::min(1.0, p + std::sqrt(parts.above) + parts.unreached)};
  all.reached = !none && parts.unreached <= 0.01 * p;
  all.plain_runs = (1 - p) / (p * square(all.variation));
  return all;
}

} // namespace wingspread
