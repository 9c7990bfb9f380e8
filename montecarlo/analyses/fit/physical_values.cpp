#include "montecarlo/analyses/fit/physical_values.hpp"

#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"

#include <algorithm>

namespace wingspread {

PhysicalValues::PhysicalValues(const Campaign& campaign, const FitSpec& spec,
                               const ParameterSpace& space)
    : space_(space), campaign_(without_correlations(fixed_but(campaign, spec.parameters))),
      plan_(campaign_, [this](long, std::span<Tails> u) { space_.place(test_, *at_, u); }) {}

std::vector<double> PhysicalValues::of(const FitPoint& at) {
  std::vector<double> values(space_.size());
  at_ = &at;
  std::vector<double> draws(campaign_.dispersions.size());
  test_.reset();
  plan_.draw(0, draws);
  for (std::size_t k = 0; k < space_.size(); ++k) {
    const FitParameter& parameter = space_.list()[k];
    if (parameter.kind != FitParameter::Kind::dispersion) {
      values[k] = parameter.std * at[static_cast<Eigen::Index>(k)];
      continue;
    }
    if (parameter.test && parameter.test != test_) {
      test_ = parameter.test;
      plan_.draw(0, draws);
    }
    values[k] = draws[parameter.dispersion];
  }
  return values;
}

PosteriorRows posterior_rows(const Campaign& campaign, const ParameterSpace& space,
                             PhysicalValues& values, std::vector<FitPoint> points) {
  PosteriorRows all;
  std::vector<std::size_t> columns; // indices in the space
  for (std::size_t k = 0; k < space.size(); ++k) {
    const FitParameter& parameter = space.list()[k];
    const bool is_new_unit = // its draw takes the place of the first test's own value
        parameter.kind == FitParameter::Kind::dispersion && parameter.test == 0 &&
        std::ranges::find(space.dependent(), parameter.dispersion) != space.dependent().end();
    if (k >= space.common() && !is_new_unit) continue;
    columns.push_back(k);
    all.columns.push_back(parameter.dispersion);
    all.names.push_back(campaign.dispersions[parameter.dispersion].name);
  }
  const PreparedDistribution normal({Normal{}, std::nullopt});
  for (std::size_t n = 0; n < points.size(); ++n) {
    for (std::size_t c = space.common(); c < columns.size(); ++c)
      points[n][static_cast<Eigen::Index>(columns[c])] = normal.quantile(
          uniform(campaign.sampling.seed, n,
                  stream_name("\x7F" + all.names[c]))); // a control character: no draw's stream
    const std::vector<double> at = values.of(points[n]);
    std::vector<double>& row = all.rows.emplace_back();
    for (const std::size_t k : columns) row.push_back(at[k]);
  }
  return all;
}

} // namespace wingspread
