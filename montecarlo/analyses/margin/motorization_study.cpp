#include "montecarlo/analyses/margin/motorization_study.hpp"

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

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

/// One drive of the wing.
struct DriveStudy {
  const Scene& nominal;
  const HingeDrive& drive;
  const MotorizationSpec& spec;
  std::int64_t runs; ///< of the campaign, ≥ 1

  [[nodiscard]] Margins margins_at(const Scene& scene, double x) const {
    return margins_of(terms_at(scene, drive, x, spec), spec);
  }

  /// Without the draws.
  [[nodiscard]] TravelPoint point(double x) const {
    const Hinge& leader = nominal.hinges[drive.hinges.front()];
    TravelPoint point;
    point.x = x;
    point.angle = leader.stowed + (leader.latched - leader.stowed) * x;
    point.nominal = terms_at(nominal, drive, x, spec);
    point.margins = margins_of(point.nominal, spec);
    return point;
  }

  [[nodiscard]] std::vector<double> places() const {
    std::vector<double> places = turning_points(nominal, drive);
    const double cells = static_cast<double>(spec.points - 1);
    for (std::int64_t k = 1; k < spec.points - 1; ++k)
      places.push_back(static_cast<double>(k) / cells);
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
  }

  /// The nominal wing's, and the draws'. What is kept of a draw is a number for each kind and for as many places as
  /// there is room for: the draws are made again for others.
  /// @param for_each_draw hands on the run's number and the scene that it makes, draw by draw
  template <class ForEachDraw>
  [[nodiscard]] DriveMotorization study(std::span<const double> probabilities,
                                        const ForEachDraw& for_each_draw) const {
    DriveMotorization all;
    all.drive = drive;
    for (const double x : places()) all.travel.push_back(point(x));
    all.worst = least_margins(nominal, drive, spec, &all.worst_at);
    Spreads least;
    for_each_draw(
        [&](long run, const Scene& drawn) { least.add(run, least_margins(drawn, drive, spec)); });
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
    for_each_draw([&](long run, const Scene& drawn) {
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

MotorizationStudy study_motorization(const Campaign& campaign, const Scene& nominal) {
  MotorizationStudy all;
  const auto for_each_draw = [&](const auto& take) {
    all.invalid = for_each_scene(campaign, take);
  };
  for (const HingeDrive& drive : drives_of(nominal)) {
    const DriveStudy study{nominal, drive, campaign.motorization, campaign.sampling.runs};
    all.drives.push_back(study.study(campaign.statistics.quantiles, for_each_draw));
  }
  if (all.drives.empty()) for_each_draw([](long, const Scene&) {});
  all.draws = campaign.sampling.runs - all.invalid;
  return all;
}

} // namespace wingspread
