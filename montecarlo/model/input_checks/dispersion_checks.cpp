#include "montecarlo/model/input_checks/dispersion_checks.hpp"

#include "core/scene/scene.hpp"
#include "distributions/prepared_distribution.hpp"
#include "distributions/reached_correlation.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/draw_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

namespace wingspread {
namespace {

// Heuristics. Tighter limits warn of good campaigns, and users then ignore warnings; wider limits miss wrong units.
constexpr double tail = 0.025; // on either side of the central 95 %
constexpr double widest_angle =
    0.1;                   // rad: between a hinge's tolerance and a degree taken for a radian
constexpr double far = 30; // of a value set and the nominal value; inches for metres: 39
constexpr double least_probability = 1e-9;
constexpr double most_beyond = 0.05;     // share of the draws beyond the ends of a table
constexpr double most_mean_added = 0.25; // of the nominal value
constexpr double one_cause = 0.8, several_causes = 0.5; // Spearman's coefficients

/// The numbers of a law that the rules compare.
struct Spread {
  explicit Spread(const Distribution& distribution)
      : law(distribution), lower(law.quantile(tail)), median(law.quantile(0.5)),
        upper(law.quantile_complement(tail)),
        mean(distribution.truncate ? median : moments(distribution.law).mean) {}

  PreparedDistribution law;
  double lower, median, upper; ///< of the central 95 %
  double mean;                 ///< for a truncated law the median instead
  [[nodiscard]] double half_width() const { return (upper - lower) / 2; }
  [[nodiscard]] double furthest() const { return std::max(std::abs(lower), std::abs(upper)); }
};

/// One dispersed parameter: path, unit and nominal value.
struct Target {
  Target(const Scene& scene, const SceneParameter& parameter)
      : path(path_of(scene, parameter)), unit(unit_of(parameter)), nominal(parameter.in(scene)) {}

  std::string path;
  std::string_view unit;
  double nominal;
  [[nodiscard]] bool is_angle() const { return unit == "rad"; }
  [[nodiscard]] bool is_spring() const {
    return path.find(".spring.") != std::string::npos && !path.ends_with("offset");
  }
  /// Whether it is the rate that a motor is commanded to, or the scale of that.
  [[nodiscard]] bool is_command() const { return path.find(".motor.rate") != std::string::npos; }
  /// "2 N·m"; a number without a dimension alone.
  [[nodiscard]] std::string text(double value) const {
    return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
  }
};

/// The nominal value's magnitude; for a coordinate of a hinge point, the length of its vector.
double size_of(const Scene& scene, const SceneParameter& parameter, const Target& target) {
  double other = 0;
  const std::string_view path = target.path;
  if (path.ends_with("_point.0") || path.ends_with("_point.1")) {
    const std::string twin =
        std::string(path.substr(0, path.size() - 1)) + (path.ends_with('0') ? '1' : '0');
    const ParameterMatches found = resolve(scene, twin);
    if (!found.matches.empty()) other = found.matches.front().parameter.in(scene);
  }
  return std::hypot(parameter.in(scene), other);
}

/// Checks one dispersion at one of its targets. Each rule returns whether it has warned.
class TargetCheck {
public:
  TargetCheck(const Scene& scene, const SceneParameter& parameter, Apply apply,
              const Spread& spread, std::string place, const std::set<std::string>& found,
              InputWarnings& warnings)
      : scene_(scene), parameter_(parameter), apply_(apply), spread_(spread),
        place_(std::move(place)), target_(scene, parameter), found_(found), warnings_(warnings) {}

  [[nodiscard]] bool warns() const {
    return wide_angle() || far_scale() || large_add() || far_set() || wrong_side();
  }

private:
  bool warn(std::string found, std::string usual) const {
    warnings_.add(place_, std::move(found), std::move(usual));
    return true;
  }

  [[nodiscard]] bool far_scale() const {
    if (apply_ != Apply::scale || (spread_.mean >= 0.5 && spread_.mean <= 2)) return false;
    return warn(
        fmt::format("a factor of {:.4g} on average, for {}", spread_.mean, target_.path),
        "a mean factor from 0.5 to 2 (\"add\" and \"set\" take values in the parameter's unit)");
  }

  [[nodiscard]] bool large_add() const {
    const double size = size_of(scene_, parameter_, target_);
    if (apply_ != Apply::add || size == 0 || target_.is_angle()) return false;
    if (std::abs(spread_.mean) <= most_mean_added * size && spread_.furthest() <= size)
      return false;
    return warn(fmt::format("{} on average, up to {}, added to {}, {}", target_.text(spread_.mean),
                            target_.text(spread_.furthest()), target_.path,
                            target_.text(target_.nominal)),
                "draws about 0, below the scene's value (\"scale\" applies a factor)");
  }

  [[nodiscard]] bool far_set() const {
    const double size = std::abs(target_.nominal);
    if (apply_ != Apply::set || size == 0 || target_.is_angle()) return false;
    const double ratio = spread_.median / target_.nominal;
    if (ratio > 1 / far && ratio < far) return sets_factor();
    return warn(fmt::format("a median of {} for {}, {} in the scene", target_.text(spread_.median),
                            target_.path, target_.text(target_.nominal)),
                fmt::format("a median of 1/{0} to {0} times the scene's value", far));
  }

  /// Warns of draws about 1 that replace a nominal factor other than 1, or a nominal value far from all draws.
  [[nodiscard]] bool sets_factor() const {
    const bool is_factor = target_.path.ends_with(".scale");
    const double from_1 = std::abs(spread_.median - 1);
    const double from_nominal = std::abs(spread_.median - target_.nominal);
    const bool about_1 = from_1 < 0.02 && from_nominal > 3 * spread_.half_width();
    if (is_factor ? from_1 >= from_nominal : !about_1) return false;
    return warn(fmt::format("a median of {:.4g} that replaces {}, {} in the scene", spread_.median,
                            target_.path, target_.text(target_.nominal)),
                "draws about the scene's value (\"scale\" multiplies it by draws about 1)");
  }

  [[nodiscard]] bool wide_angle() const {
    if (!target_.is_angle()) return false;
    const double per_draw = apply_ == Apply::scale ? std::abs(target_.nominal) : 1;
    if (per_draw * spread_.half_width() > widest_angle)
      return warn(fmt::format("±{:.4g} rad of {} (95 % of the draws)",
                              per_draw * spread_.half_width(), target_.path),
                  fmt::format("up to ±{} rad (write degrees as \"0.5 deg\")", widest_angle));
    if (apply_ == Apply::scale || std::abs(spread_.median) <= 2 * std::numbers::pi) return false;
    return warn(fmt::format("a median of {:.4g} rad for {}", spread_.median, target_.path),
                "an angle within a turn, ±6.28 rad (write degrees as \"90 deg\")");
  }

  /// P(the dispersed parameter is < 0), or > 0 for a negative nominal value.
  [[nodiscard]] double probability_of_other_side() const {
    const bool negative = target_.nominal < 0;
    const double zero = apply_ == Apply::add ? -target_.nominal : 0;
    const bool upwards = negative && apply_ != Apply::scale;
    return upwards ? spread_.law.cdf_complement(zero)
                   : spread_.law.cdf(std::nextafter(zero, -1e300));
  }

  /// Whether a negative value of the parameter is unphysical.
  [[nodiscard]] bool is_physical_size() const {
    Scene negative = scene_;
    parameter_.in(negative) = -1;
    return unphysical(negative).size() > unphysical(scene_).size();
  }

  [[nodiscard]] bool wrong_side() const {
    const double probability = probability_of_other_side();
    if (probability < least_probability) return false;
    const bool drives = target_.is_spring() || target_.is_command();
    if (drives ? target_.nominal == 0 : found_.contains(target_.path) || !is_physical_size())
      return false;
    return warn(fmt::format("a draw that {1} {2} with a probability of {0:.3g}", probability,
                            drives ? "changes the sign of" : "makes negative", target_.path),
                fmt::format("a probability below {} (a lognormal law, or \"truncate\")",
                            least_probability));
  }

  const Scene& scene_;
  const SceneParameter& parameter_;
  Apply apply_;
  const Spread& spread_;
  std::string place_;
  Target target_;
  const std::set<std::string>& found_; ///< paths of which drawing has found negative values
  InputWarnings& warnings_;
};

/// A `through` table with draws beyond its ends.
struct ShortTable {
  std::size_t index = 0;
  double beyond = 0; ///< share of the draws
};

/// The tables with too many draws beyond their ends.
std::vector<ShortTable> short_tables(const Dispersion& dispersion, const Spread& spread) {
  std::vector<ShortTable> found;
  for (std::size_t k = 0; k < dispersion.through.size(); ++k) {
    const std::vector<double>& at = dispersion.through[k].table.knots();
    const double below = spread.law.cdf(std::nextafter(at.front(), -HUGE_VAL));
    const double beyond = below + spread.law.cdf_complement(at.back());
    if (beyond > most_beyond) found.push_back({k, beyond});
  }
  return found;
}

/// Warns of tables with many draws beyond their ends: these all get the value at an end.
/// @param place of the tables
/// @param law   place of a case's law: one warning, of its worst table; empty: a warning at each table
void check_through(const Dispersion& dispersion, const Spread& spread, const std::string& place,
                   const std::string& law, InputWarnings& warnings) {
  std::vector<ShortTable> tables = short_tables(dispersion, spread);
  std::string others;
  if (!law.empty() && tables.size() > 1) {
    others = fmt::format("; {} of its tables are too short", tables.size());
    tables = {*std::ranges::max_element(tables, {}, &ShortTable::beyond)};
  }
  for (const auto& [k, beyond] : tables) {
    const std::vector<double>& at = dispersion.through[k].table.knots();
    warnings.add(
        law.empty() ? fmt::format("{}/through/{}/table/at", place, k) : law,
        fmt::format("{:.3g} % of the draws beyond {}'s table from {:.4g} to {:.4g}, with the "
                    "median {:.4g}{}",
                    100 * beyond, dispersion.name, at.front(), at.back(), spread.median, others),
        fmt::format("a table that covers the draws: it is constant beyond its ends, and at most "
                    "{:g} % of the draws get the value at an end",
                    100 * most_beyond));
  }
}

/// Checks the tables of the laws that a case gives to dispersions.
void check_case(const Campaign& campaign, std::size_t k, InputWarnings& warnings) {
  for (const auto& [name, distribution] : campaign.cases[k].distributions)
    for (const Dispersion& dispersion : campaign.dispersions)
      if (is_drawn_by(campaign, name, dispersion))
        check_through(dispersion, Spread(distribution), "",
                      fmt::format("/cases/{}/distributions{}", k, pointer_token(name)), warnings);
}

bool are_named(const std::vector<RankCorrelation>& all, std::size_t a, std::size_t b) {
  return std::ranges::any_of(all, [&](const RankCorrelation& each) {
    return (each.first == a && each.second == b) || (each.first == b && each.second == a);
  });
}

/// Three dispersions that are correlated pairwise; nothing if there are none.
std::optional<std::array<std::size_t, 3>> common_cause(std::vector<RankCorrelation> all) {
  std::erase_if(all, [](const auto& each) {
    return each.covariance || std::abs(each.spearman) < several_causes;
  });
  for (const RankCorrelation& pair : all)
    for (const RankCorrelation& other : all)
      if (other.first == pair.first && other.second != pair.second &&
          are_named(all, pair.second, other.second))
        return std::array{pair.first, pair.second, other.second};
  return std::nullopt;
}

constexpr const char* usual_cause =
    "one draw for a common cause, with \"through\" (a temperature, a lot); correlations are for "
    "what is measured together";

} // namespace

void check_dispersions(const Campaign& campaign, InputWarnings& warnings,
                       const std::set<std::string>& found) {
  for (const Dispersion& dispersion : campaign.dispersions) {
    const Spread spread(dispersion.distribution);
    const std::string place = place_of(campaign, dispersion);
    for (const SceneParameter& target : dispersion.targets)
      if (TargetCheck(campaign.scene, target, dispersion.apply, spread, place, found, warnings)
              .warns())
        break;
    check_through(dispersion, spread, place, "", warnings);
  }
  for (std::size_t k = 0; k < campaign.cases.size(); ++k) check_case(campaign, k, warnings);
}

void check_spread(const Campaign& campaign, InputWarnings& warnings) {
  if (campaign.sampling.replicates > 1 && !has_replicates(campaign.sampling))
    warnings.add("/sampling/replicates",
                 fmt::format("{} with independent draws", campaign.sampling.replicates),
                 "1: a random design has no replicates and needs none for its bounds; only "
                 "\"sobol\" and \"latin_hypercube\" have them");
  if (campaign.sampling.runs < 2) return;
  if (const std::string where = where_nothing_varies(campaign); !where.empty())
    warnings.add("/dispersions", where,
                 fmt::format("a parameter that varies: all {} runs are the same run, and show no "
                             "probability",
                             campaign.sampling.runs));
}

void check_correlations(const Campaign& campaign, InputWarnings& warnings) {
  constexpr double least_left = 0.9; // heuristic: rank correlations are rarely known better
  const auto& all = campaign.wanted_correlations;
  const auto name = [&](std::size_t which) { return campaign.dispersions[which].name; };
  for (std::size_t k = 0; k < all.size(); ++k)
    if (!all[k].covariance && std::abs(all[k].spearman) >= one_cause)
      warnings.add(
          fmt::format("/correlations/{}", k),
          fmt::format("{} of {} and {}", all[k].spearman, name(all[k].first), name(all[k].second)),
          usual_cause);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto law = [&](std::size_t which) { return campaign.dispersions[which].distribution; };
    const double left = reached_correlation(law(all[k].first), law(all[k].second), all[k].spearman);
    if (left != 0 && std::abs(left) < least_left * std::abs(all[k].spearman))
      warnings.add(
          fmt::format("/correlations/{}/spearman", k),
          fmt::format("{} of {} and {}, of which ties leave {:.2g}", all[k].spearman,
                      name(all[k].first), name(all[k].second), left),
          "laws without values that many draws share: the correlation is that before ties");
  }
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const std::size_t which : {all[k].first, all[k].second})
      if (!varies(campaign.dispersions[which].distribution))
        warnings.add(fmt::format("/correlations/{}", k),
                     fmt::format("a correlation of {}, whose law has a single value", name(which)),
                     "a law that varies: the correlation has no effect");
  if (const auto three = common_cause(all))
    warnings.add("/correlations",
                 fmt::format("{}, {} and {}, each correlated with the others", name((*three)[0]),
                             name((*three)[1]), name((*three)[2])),
                 usual_cause);
}

void check_outputs(const Campaign& campaign, InputWarnings& warnings) {
  const std::size_t always = output_columns(campaign.scene, {}).size();
  for (const OutputFamily family : campaign.outputs)
    if (!about(family).wings.empty() && output_columns(campaign.scene, {family}).size() == always)
      warnings.add("/outputs",
                   fmt::format("\"{}\", of which this wing has no column", about(family).name),
                   std::string(about(family).wings));
}

} // namespace wingspread
