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
/// How many bytes of margins are held at a time: of so many places of the travel as that makes.
constexpr std::size_t most_bytes = std::size_t{1} << 28;

bool is_driven(const Hinge& hinge) {
  const HingeTorque& spring = hinge.spring;
  return hinge.latch || spring.table || spring.torque_stowed != 0 || spring.torque_latched != 0 ||
         spring.offset != 0;
}

/// Margins of every draw, kind by kind, as they come.
class Spreads {
public:
  void add(long run, const Margins& margins) {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const double margin = margins[kind];
      values_[kind].push_back(margin);
      MarginSpread& spread = spreads_[kind];
      if (spread.worst_run < 0 || margin < spread.least)
        spread.least = margin, spread.worst_run = run;
      if (margin < 0) ++short_[kind];
    }
  }

  /// Once, when all are there.
  [[nodiscard]] std::array<MarginSpread, kinds> finished(std::span<const double> probabilities) {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      std::vector<double>& values = values_[kind];
      MarginSpread& spread = spreads_[kind];
      if (values.empty()) spread.least = none;
      spread.share_short = static_cast<double>(short_[kind]) / static_cast<double>(values.size());
      std::ranges::sort(values);
      for (const double p : probabilities) spread.quantiles.push_back(quantile(values, p));
      values = {};
    }
    return spreads_;
  }

private:
  std::array<std::vector<double>, kinds> values_;
  std::array<MarginSpread, kinds> spreads_;
  std::array<long, kinds> short_{};
};

/// One hinge of the wing.
struct HingeStudy {
  const Hinge& nominal;
  const MotorizationTerms& other;
  const MarginSpec& spec;
  std::int64_t runs; ///< of the campaign, ≥ 1

  [[nodiscard]] Margins margins_at(const Hinge& hinge, double x) const {
    return margins_of(terms_at(hinge, x, other), spec);
  }

  /// The least over the travel, and where, kind by kind.
  [[nodiscard]] Margins worst(const Hinge& hinge, Margins& at) const {
    Margins least;
    least.fill(std::numeric_limits<double>::infinity());
    for (const double x : places_of_least(hinge)) {
      const Margins margins = margins_at(hinge, x);
      for (std::size_t kind = 0; kind < kinds; ++kind)
        if (margins[kind] < least[kind]) {
          least[kind] = margins[kind];
          at[kind] = x;
        }
    }
    return least;
  }

  /// Without the draws.
  [[nodiscard]] TravelPoint point(double x) const {
    TravelPoint point;
    point.x = x;
    point.angle = nominal.stowed + (nominal.latched - nominal.stowed) * x;
    point.nominal = terms_at(nominal, x, other);
    point.margins = margins_of(point.nominal, spec);
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

  /// The nominal wing's, and the draws'. What is kept of a draw is a number for each kind and for as many places as
  /// there is room for: the draws are made again for others.
  /// @param for_each_draw hands on the run's number and the hinge that it makes, draw by draw
  template <class ForEachDraw>
  [[nodiscard]] HingeMotorization study(int hinge, std::span<const double> probabilities,
                                        const ForEachDraw& for_each_draw) const {
    HingeMotorization all;
    all.hinge = hinge;
    for (const double x : places()) all.travel.push_back(point(x));
    all.worst = worst(nominal, all.worst_at);
    Spreads least;
    for_each_draw([&](long run, const Hinge& drawn) {
      Margins at{};
      least.add(run, worst(drawn, at));
    });
    all.worst_spread = least.finished(probabilities);
    const std::span<TravelPoint> travel = all.travel;
    const std::size_t at_once = std::max<std::size_t>(1, most_bytes / (kinds * sizeof(double)) /
                                                             static_cast<std::size_t>(runs));
    for (std::size_t first = 0; first < travel.size(); first += at_once)
      add_spreads(travel.subspan(first, std::min(at_once, travel.size() - first)), probabilities,
                  for_each_draw);
    return all;
  }

private:
  template <class ForEachDraw>
  void add_spreads(std::span<TravelPoint> places, std::span<const double> probabilities,
                   const ForEachDraw& for_each_draw) const {
    std::vector<Spreads> spreads(places.size());
    for_each_draw([&](long run, const Hinge& drawn) {
      for (std::size_t k = 0; k < places.size(); ++k)
        spreads[k].add(run, margins_at(drawn, places[k].x));
    });
    for (std::size_t k = 0; k < places.size(); ++k)
      places[k].spread = spreads[k].finished(probabilities);
  }
};

/// Hands on the scenes of the physical draws. @return how many are not
template <class Take> long for_each_scene(const Campaign& campaign, const Take& take) {
  const RunPlan plan(campaign);
  std::vector<double> values(campaign.dispersions.size());
  Scene scene = campaign.scene;
  long invalid = 0;
  for (long run = 0; run < campaign.sampling.runs; ++run) {
    plan.draw(run, values);
    apply(campaign, values, campaign.scene, scene);
    if (unphysical(scene).empty())
      take(run, scene);
    else
      ++invalid;
  }
  return invalid;
}

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
  MotorizationStudy all;
  for (int hinge = 0; hinge < std::ssize(nominal.hinges); ++hinge) {
    if (!is_driven(nominal.hinges[hinge])) continue;
    const HingeStudy study{nominal.hinges[hinge], spec.motorization.torques[hinge], spec,
                           campaign.sampling.runs};
    const auto for_each_draw = [&](const auto& take) {
      all.invalid = for_each_scene(
          campaign, [&](long run, const Scene& scene) { take(run, scene.hinges[hinge]); });
    };
    all.hinges.push_back(study.study(hinge, campaign.statistics.quantiles, for_each_draw));
  }
  if (all.hinges.empty()) all.invalid = for_each_scene(campaign, [](long, const Scene&) {});
  all.draws = campaign.sampling.runs - all.invalid;
  return all;
}

} // namespace wingspread
