#include "montecarlo/margin/motorization_study.hpp"

#include "montecarlo/runs/run_plan.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace wingspread {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kinds = margin_kind_names.size();

bool is_driven(const Hinge& hinge) {
  return hinge.latch || hinge.spring.torque_stowed != 0 || hinge.spring.torque_latched != 0;
}

/// What a draw makes of the hinges: as much of them as the margins need.
struct Draw {
  long run;
  std::vector<Hinge> hinges; ///< those that are driven
};

Hinge without_names(const Hinge& hinge) {
  Hinge law = hinge;
  law.name.clear();
  return law;
}

/// The physical draws; counts the others.
std::vector<Draw> draws_of(const Campaign& campaign, std::span<const int> driven, long& invalid) {
  const RunPlan plan(campaign);
  std::vector<double> values(campaign.dispersions.size());
  std::vector<Draw> draws;
  Scene scene = campaign.scene;
  for (long run = 0; run < campaign.sampling.runs; ++run) {
    plan.draw(run, values);
    apply(campaign, values, campaign.scene, scene);
    if (!unphysical(scene).empty()) {
      ++invalid;
      continue;
    }
    Draw& draw = draws.emplace_back(Draw{run, {}});
    for (const int hinge : driven) draw.hinges.push_back(without_names(scene.hinges[hinge]));
  }
  return draws;
}

/// Margins of every draw, kind by kind.
class Spreads {
public:
  void add(const Margins& margins) {
    for (std::size_t kind = 0; kind < kinds; ++kind) values_[kind].push_back(margins[kind]);
  }

  [[nodiscard]] std::array<MarginSpread, kinds> of(std::span<const Draw> draws,
                                                   std::span<const double> probabilities) {
    std::array<MarginSpread, kinds> all;
    for (std::size_t kind = 0; kind < kinds; ++kind)
      all[kind] = spread(values_[kind], draws, probabilities);
    return all;
  }

private:
  static MarginSpread spread(std::vector<double>& values, std::span<const Draw> draws,
                             std::span<const double> probabilities) {
    MarginSpread all;
    const auto least = std::ranges::min_element(values);
    all.least = values.empty() ? none : *least;
    if (!values.empty()) all.worst_run = draws[least - values.begin()].run;
    const auto is_short = [](double margin) { return margin < 0; };
    all.share_short = static_cast<double>(std::ranges::count_if(values, is_short)) /
                      static_cast<double>(values.size());
    std::ranges::sort(values);
    for (const double p : probabilities) all.quantiles.push_back(quantile(values, p));
    return all;
  }

  std::array<std::vector<double>, kinds> values_;
};

/// One hinge of the wing and of its draws.
struct HingeStudy {
  const Hinge& nominal;
  std::size_t place; ///< among those of a draw
  const std::vector<Draw>& draws;
  const MotorizationTerms& other;
  const MarginSpec& spec;
  const std::vector<double>& probabilities;

  [[nodiscard]] Margins margins_at(const Hinge& hinge, double x) const {
    return margins_of(terms_at(hinge, x, other), spec);
  }

  /// The least over the travel, and where, kind by kind.
  [[nodiscard]] Margins worst(const Hinge& hinge, Margins& at) const {
    Margins least;
    least.fill(std::numeric_limits<double>::infinity());
    for (const double x : turning_points(hinge)) {
      const Margins margins = margins_at(hinge, x);
      for (std::size_t kind = 0; kind < kinds; ++kind)
        if (margins[kind] < least[kind]) {
          least[kind] = margins[kind];
          at[kind] = x;
        }
    }
    return least;
  }

  [[nodiscard]] TravelPoint point(double x) const {
    TravelPoint point;
    point.x = x;
    point.angle = nominal.stowed + (nominal.latched - nominal.stowed) * x;
    point.nominal = terms_at(nominal, x, other);
    point.margins = margins_of(point.nominal, spec);
    Spreads spreads;
    for (const Draw& draw : draws) spreads.add(margins_at(draw.hinges[place], x));
    point.spread = spreads.of(draws, probabilities);
    return point;
  }

  [[nodiscard]] std::vector<double> places() const {
    std::vector<double> places = turning_points(nominal);
    const double cells = static_cast<double>(spec.motorization.points - 1);
    for (std::int64_t k = 1; k < spec.motorization.points - 1; ++k)
      places.push_back(static_cast<double>(k) / cells);
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
  }

  [[nodiscard]] HingeMotorization study(int hinge) const {
    HingeMotorization all;
    all.hinge = hinge;
    for (const double x : places()) all.travel.push_back(point(x));
    all.worst = worst(nominal, all.worst_at);
    Spreads spreads;
    for (Margins at{}; const Draw& draw : draws) spreads.add(worst(draw.hinges[place], at));
    all.worst_spread = spreads.of(draws, probabilities);
    return all;
  }
};

} // namespace

Margins margins_of(const MotorizationTerms& terms, const MarginSpec& spec) {
  MotorizationTerms weakened = terms;
  const double springs = static_cast<double>(spec.springs_per_hinge);
  weakened.available *= (springs - 1) / springs;
  return {ecss_margin(terms, spec.motorization.ecss),
          nasa_static_margin(terms, spec.motorization.nasa),
          nasa_static_margin(weakened, nasa_one_spring_out())};
}

MotorizationStudy study_motorization(const Campaign& campaign, const Scene& nominal,
                                     const MarginSpec& spec) {
  std::vector<int> driven;
  for (int hinge = 0; hinge < std::ssize(nominal.hinges); ++hinge)
    if (is_driven(nominal.hinges[hinge])) driven.push_back(hinge);
  MotorizationStudy all;
  const std::vector<Draw> draws = draws_of(campaign, driven, all.invalid);
  all.draws = std::ssize(draws);
  for (std::size_t place = 0; place < driven.size(); ++place) {
    const int hinge = driven[place];
    all.hinges.push_back(HingeStudy{nominal.hinges[hinge], place, draws,
                                    spec.motorization.torques[hinge], spec,
                                    campaign.statistics.quantiles}
                             .study(hinge));
  }
  return all;
}

} // namespace wingspread
