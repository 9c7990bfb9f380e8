#include "montecarlo/model/static_margins/static_margin_study.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t kinds = margin_kind_names.size();
/// Most bytes of margins held at once. If the margins at all places of the travel need more, the draws are visited
/// several times.
constexpr std::size_t most_bytes = std::size_t{1} << 28;

/// Collects the margins of all draws at one place.
class SpreadCollector {
public:
  /// @param margins NaN where a margin does not apply: not collected
  void add(long run, const Margins& margins) {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const double margin = margins[kind];
      if (std::isnan(margin)) continue;
      values_[kind].push_back(margin);
      MarginSpread& spread = spreads_[kind];
      if (spread.worst_run < 0 || margin < spread.least)
        spread.least = margin, spread.worst_run = run;
      if (margin < 0) ++short_[kind];
    }
  }

  /// Sorts and frees the values. @pre called once, after the last draw
  [[nodiscard]] MarginSpreads finish(std::span<const double> probabilities) {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      std::vector<double>& values = values_[kind];
      MarginSpread& spread = spreads_[kind];
      if (values.empty()) spread.least = undefined;
      spread.share_short = static_cast<double>(short_[kind]) / static_cast<double>(values.size());
      std::ranges::sort(values);
      for (const double p : probabilities) spread.quantiles.push_back(quantile(values, p));
      values = {};
    }
    return spreads_;
  }

private:
  std::array<std::vector<double>, kinds> values_;
  MarginSpreads spreads_;
  std::array<long, kinds> short_{};
};

/// Studies one drive of the wing.
struct DriveStudy {
  const Scene& nominal;
  const HingeDrive& drive;
  const StaticMarginSpec& spec;
  const DrawnScenes& draws;
  std::span<const double> probabilities;

  [[nodiscard]] double angle_at(double x) const {
    const Hinge& leader = nominal.hinges[drive.hinges.front()];
    return leader.stowed + (leader.latched - leader.stowed) * x;
  }

  /// The margins, NaN where they do not apply. The nominal wing decides: draws do not change what a hinge has.
  [[nodiscard]] Margins applicable(Margins margins) const {
    for (std::size_t kind = 0; kind < kinds; ++kind)
      if (!applies(static_cast<MarginKind>(kind), nominal, drive)) margins[kind] = undefined;
    return margins;
  }

  /// The nominal wing's terms and margins; the draws' are added later.
  [[nodiscard]] TravelPoint point(double x) const {
    TravelPoint point;
    point.x = x;
    point.angle = angle_at(x);
    point.nominal = terms_at(nominal, drive, x, spec);
    point.margins = applicable(margins_at(nominal, drive, x, spec));
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

  /// Returns the number of unphysical draws.
  long add_worst(DriveMargins& all) const {
    Margins at{};
    all.worst = applicable(least_margins(nominal, drive, spec, &at));
    at = applicable(at);
    std::ranges::transform(at, all.worst_angle.begin(), [&](double x) { return angle_at(x); });
    SpreadCollector least;
    const long invalid = draws.visit([&](long run, const Scene& drawn) {
      least.add(run, applicable(least_margins(drawn, drive, spec)));
    });
    all.worst_spread = least.finish(probabilities);
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const long run = all.worst_spread[kind].worst_run;
      all.worst_draw[kind] = run < 0 ? Json::object() : draws.values(run);
    }
    return invalid;
  }

  void add_spreads(std::span<TravelPoint> points) const {
    std::vector<SpreadCollector> spreads(points.size());
    draws.visit([&](long run, const Scene& drawn) {
      for (std::size_t k = 0; k < points.size(); ++k)
        spreads[k].add(run, applicable(margins_at(drawn, drive, points[k].x, spec)));
    });
    for (std::size_t k = 0; k < points.size(); ++k)
      points[k].spread = spreads[k].finish(probabilities);
  }

  [[nodiscard]] DriveMargins study(long& invalid) const {
    DriveMargins all;
    all.hinge = name_of(drive, nominal);
    for (const double x : places()) all.travel.push_back(point(x));
    invalid = add_worst(all);
    const std::span<TravelPoint> travel = all.travel;
    const std::size_t at_once = std::max<std::size_t>(1, most_bytes / (kinds * sizeof(double)) /
                                                             static_cast<std::size_t>(draws.runs));
    for (std::size_t first = 0; first < travel.size(); first += at_once)
      add_spreads(travel.subspan(first, std::min(at_once, travel.size() - first)));
    return all;
  }
};

} // namespace

StaticMarginStudy study_static_margins(const Scene& nominal, const StaticMarginSpec& spec,
                                       const DrawnScenes& draws,
                                       std::span<const double> probabilities) {
  StaticMarginStudy all;
  for (const HingeDrive& drive : drives_of(nominal))
    all.drives.push_back(DriveStudy{nominal, drive, spec, draws, probabilities}.study(all.invalid));
  if (all.drives.empty()) all.invalid = draws.visit([](long, const Scene&) {});
  all.draws = draws.runs - all.invalid;
  return all;
}

} // namespace wingspread
