#include "montecarlo/analyses/fit/parameter_space.hpp"

#include "distributions/design.hpp"
#include "distributions/prepared_distribution.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"
#include "montecarlo/model/campaign/wanted_correlations.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

using Kind = FitParameter::Kind;

bool is_own(const FitTest& test, std::size_t dispersion) {
  return std::ranges::find(test.own, dispersion) != test.own.end();
}

/// Writes each dispersion as an entry of its own, with its law: other processes rebuild the campaign from this JSON, in which
/// a column of rows and a copy of an `each` have no entry whose law could be changed.
void write_one_by_one(Campaign& campaign) {
  Json list = Json::array();
  for (const Dispersion& dispersion : campaign.dispersions) {
    const Json& entry = campaign.resolved.at("dispersions").at(entry_of(campaign, dispersion));
    const Json& effect =
        entry.contains("rows") ? entry["rows"].at("columns").at(dispersion.name) : entry;
    Json own{{"name", dispersion.name},
             {"distribution", write_distribution(dispersion.distribution)}};
    if (dispersion.through.empty()) {
      own["to"] = paths_of(campaign.scene, dispersion.targets);
      own["apply"] = apply_names[static_cast<std::size_t>(dispersion.apply)];
    } else {
      own["through"] = effect.at("through");
    }
    list.push_back(std::move(own));
  }
  campaign.resolved["dispersions"] = std::move(list);
  if (!campaign.resolved.contains("correlations")) return;
  std::vector<RankCorrelation> coefficients = campaign.wanted_correlations;
  for (RankCorrelation& each : coefficients) each.covariance.reset(); // it was of the laws before
  campaign.resolved["correlations"] = write_wanted_correlations(coefficients, campaign.dispersions);
}

/// Number of tests that have a value of their own.
std::size_t tests_with_own(const FitSpec& spec, std::size_t dispersion) {
  return static_cast<std::size_t>(std::ranges::count_if(
      spec.tests, [&](const FitTest& test) { return is_own(test, dispersion); }));
}

/// The order of the copula's elimination; by name where nothing else decides, as in the campaign.
std::vector<std::size_t> common_first(const Campaign& campaign, const FitSpec& spec) {
  std::vector<std::string> names;
  std::vector<int> places;
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i) {
    names.push_back(campaign.dispersions[i].name);
    const std::size_t own = tests_with_own(spec, i);
    places.push_back(own == 0 ? 0 : own < spec.tests.size() ? 1 : 2);
  }
  std::vector<std::size_t> order = order_by_name(names);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return places[i]; });
  return order;
}

/// The dispersions among `own` that correlations connect with others, directly or through each other.
std::vector<std::size_t> connected(const std::vector<RankCorrelation>& correlations,
                                   const std::vector<std::size_t>& own) {
  const auto is_among = [](const std::vector<std::size_t>& list, std::size_t i) {
    return std::ranges::find(list, i) != list.end();
  };
  std::vector<std::size_t> found;
  for (bool grows = true; grows;) {
    grows = false;
    for (const RankCorrelation& pair : correlations)
      for (const auto& [one, other] :
           {std::pair(pair.first, pair.second), std::pair(pair.second, pair.first)})
        if (is_among(own, one) && !is_among(found, one) &&
            (!is_among(own, other) || is_among(found, other)))
          found.push_back(one), grows = true;
  }
  std::ranges::sort(found);
  return found;
}

} // namespace

ParameterSpace::ParameterSpace(const Campaign& campaign, const FitSpec& spec)
    : dispersions_(campaign.dispersions.size()),
      copula_(common_first(campaign, spec), campaign.wanted_correlations) {
  const auto name = [&](std::size_t i) { return campaign.dispersions[i].name; };
  std::vector<std::size_t> own; // of every test
  for (const std::size_t i : spec.parameters)
    if (tests_with_own(spec, i) < spec.tests.size())
      list_.push_back({Kind::dispersion, name(i), i, std::nullopt});
    else
      own.push_back(i);
  common_ = list_.size();
  dependent_ = connected(campaign.wanted_correlations, own);
  for (std::size_t t = 0; t < spec.tests.size(); ++t)
    for (const std::size_t i : spec.parameters)
      if (is_own(spec.tests[t], i))
        list_.push_back({Kind::dispersion, name(i) + " of " + spec.tests[t].name, i, t});
  for (std::size_t t = 0; t < spec.tests.size(); ++t) {
    const FitTest& test = spec.tests[t];
    if (test.time_offset_std > 0 && !test.columns.empty())
      list_.push_back(
          {Kind::time_offset, "time offset of " + test.name, 0, t, 0, test.time_offset_std, "s"});
    for (std::size_t c = 0; c < test.columns.size(); ++c)
      if (test.columns[c].offset_std > 0 && !test.columns[c].std)
        list_.push_back({Kind::column_offset,
                         "offset of " + test.columns[c].name + " of " + test.name, 0, t, c,
                         test.columns[c].offset_std, test.columns[c].unit});
  }
}

void ParameterSpace::place(std::optional<std::size_t> test, const FitPoint& at,
                           std::span<Tails> u) const {
  std::ranges::fill(u, Tails{0.5, 0.5});
  for (std::size_t k = 0; k < list_.size(); ++k) {
    const FitParameter& parameter = list_[k];
    if (parameter.kind == Kind::dispersion && (!parameter.test || parameter.test == test))
      u[parameter.dispersion] = unit_point(at[static_cast<Eigen::Index>(k)]);
  }
  if (copula_.is_independent()) return;
  const std::vector<Tails> uncoupled(u.begin(), u.end());
  copula_.couple(uncoupled, u);
}

Eigen::MatrixXd ParameterSpace::coupling() const {
  const auto n = static_cast<Eigen::Index>(list_.size());
  Eigen::MatrixXd coupling = Eigen::MatrixXd::Identity(n, n);
  if (copula_.is_independent()) return coupling;
  std::vector<Tails> u(dispersions_);
  for (Eigen::Index column = 0; column < n; ++column)
    for (Eigen::Index row = 0; row < n; ++row) {
      const FitParameter& parameter = list_[static_cast<std::size_t>(row)];
      if (parameter.kind != Kind::dispersion) continue;
      place(parameter.test, FitPoint::Unit(n, column), u);
      coupling(row, column) = inverse(Normal{}, u[parameter.dispersion]);
    }
  return coupling;
}

double ParameterSpace::time_offset(std::size_t test, const FitPoint& at) const {
  for (std::size_t k = 0; k < list_.size(); ++k)
    if (list_[k].kind == Kind::time_offset && list_[k].test == test)
      return list_[k].std * at[static_cast<Eigen::Index>(k)];
  return 0;
}

double ParameterSpace::column_offset(std::size_t test, std::size_t column,
                                     const FitPoint& at) const {
  for (std::size_t k = 0; k < list_.size(); ++k)
    if (list_[k].kind == Kind::column_offset && list_[k].test == test && list_[k].column == column)
      return list_[k].std * at[static_cast<Eigen::Index>(k)];
  return 0;
}

LawMoments moments_of(const Distribution& distribution) {
  constexpr std::size_t points = 20000; // quantiles of a truncated law
  if (!distribution.truncate) return moments(distribution.law);
  const PreparedDistribution law(distribution);
  std::vector<double> values;
  for (std::size_t k = 0; k < points; ++k)
    values.push_back(law.quantile((static_cast<double>(k) + 0.5) / points));
  const Moments found = moments(values);
  return {found.mean, found.std};
}

Campaign with_normal_laws(Campaign campaign, const std::vector<std::size_t>& held) {
  for (const std::size_t i : held) {
    Dispersion& dispersion = campaign.dispersions[i];
    const double std = moments_of(dispersion.distribution).standard_deviation;
    if (!(std > 0) || !std::isfinite(std)) continue;
    const double median = PreparedDistribution(dispersion.distribution).quantile(0.5);
    dispersion.distribution = {Normal{median, std}, std::nullopt};
  }
  write_one_by_one(campaign);
  for (Dispersion& dispersion : campaign.dispersions) dispersion.rows.clear();
  return campaign;
}

Eigen::MatrixXd correlations_in_rows(const Campaign& campaign,
                                     const std::vector<std::size_t>& dispersions) {
  const auto n = static_cast<Eigen::Index>(dispersions.size());
  Eigen::MatrixXd correlations = Eigen::MatrixXd::Identity(n, n);
  const auto column = [&](Eigen::Index i) -> const Dispersion& {
    return campaign.dispersions[dispersions[static_cast<std::size_t>(i)]];
  };
  const auto centred = [](const Dispersion& dispersion) {
    const std::vector<double>& values = std::get<Empirical>(dispersion.distribution.law).values;
    const auto mapped =
        Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    return Eigen::VectorXd(mapped - mapped.mean());
  };
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      if (column(i).rows.empty() || column(i).rows != column(j).rows) continue;
      const Eigen::VectorXd a = centred(column(i)), b = centred(column(j));
      const double scale = a.norm() * b.norm();
      correlations(i, j) = correlations(j, i) = scale > 0 ? a.dot(b) / scale : 0;
    }
  return correlations;
}

Campaign without_correlations(Campaign campaign) {
  campaign.wanted_correlations.clear();
  campaign.resolved.erase("correlations");
  return campaign;
}

ParameterPrior prior_of(const FitParameter& parameter, const Campaign& campaign,
                        double confidence) {
  if (parameter.kind != Kind::dispersion) {
    const double reach = two_sided_normal(confidence) * parameter.std;
    return {0, parameter.std, -reach, reach, parameter.unit};
  }
  const Dispersion& dispersion = campaign.dispersions[parameter.dispersion];
  const double tail = (1 - confidence) / 2;
  const PreparedDistribution law(dispersion.distribution);
  const auto [mean, std] = moments_of(dispersion.distribution);
  return {mean, std, law.quantile(tail), law.quantile_complement(tail), unit_of_draw(dispersion)};
}

Campaign fixed_but(Campaign campaign, const std::vector<std::size_t>& fitted) {
  const auto is_fixed = [&](std::size_t i) { return std::ranges::find(fitted, i) == fitted.end(); };
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i) {
    Distribution& law = campaign.dispersions[i].distribution;
    if (is_fixed(i)) law = {Constant{PreparedDistribution(law).quantile(0.5)}, std::nullopt};
  }
  write_one_by_one(campaign);
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i)
    if (is_fixed(i)) campaign.dispersions[i].rows.clear(); // a dispersion that does not vary
  return campaign;
}

struct PhysicalValues::Laws {
  Laws(const Campaign& given, const std::vector<std::size_t>& fitted, const UnitPoints& points)
      : campaign(without_correlations(fixed_but(given, fitted))), plan(campaign, points) {}
  Campaign campaign;
  RunPlan plan;
};

PhysicalValues::PhysicalValues(const Campaign& campaign, const FitSpec& spec,
                               const ParameterSpace& space)
    : space_(space) {
  const auto place = [this](long, std::span<Tails> u) { space_.place(test_, *at_, u); };
  laws_.push_back(std::make_unique<Laws>(campaign, spec.parameters, place));
  for (const FitTest& test : spec.tests)
    laws_.push_back(
        test.own.empty() ? nullptr : std::make_unique<Laws>(test.campaign, spec.parameters, place));
}

PhysicalValues::~PhysicalValues() = default;

std::vector<double> PhysicalValues::of(const FitPoint& at) { return values(at, true); }
std::vector<double> PhysicalValues::of_new_unit(const FitPoint& at) { return values(at, false); }

std::vector<double> PhysicalValues::values(const FitPoint& at, bool by_tests) {
  std::vector<double> values(space_.size());
  at_ = &at;
  std::vector<double> draws(laws_.front()->campaign.dispersions.size());
  test_.reset();
  laws_.front()->plan.draw(0, draws);
  for (std::size_t k = 0; k < space_.size(); ++k) {
    const FitParameter& parameter = space_.list()[k];
    if (parameter.kind != FitParameter::Kind::dispersion) {
      values[k] = parameter.std * at[static_cast<Eigen::Index>(k)];
      continue;
    }
    if (parameter.test && parameter.test != test_) {
      test_ = parameter.test;
      laws_[by_tests ? *test_ + 1 : 0]->plan.draw(0, draws);
    }
    values[k] = draws[parameter.dispersion];
  }
  return values;
}

} // namespace wingspread
