#include "montecarlo/rare/rare_event.hpp"

#include "distributions/continuous_law.hpp"
#include "montecarlo/formats/spec_error.hpp"
#include "montecarlo/machine/team.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

/// Φ(z), and neither 0 nor 1.
double in_unit_interval(double z) {
  constexpr double least = 0x1p-53;
  return std::clamp(tails(Normal{}, z).below, least, 1 - least);
}

/// Runs of the campaign at points of the normal space.
class NormalRuns {
public:
  NormalRuns(const Campaign& campaign, const LimitState& limit_state)
      : campaign_(campaign), limit_state_(limit_state), plan_(campaign) {}

  [[nodiscard]] std::vector<double> draws_at(const NormalPoint& z) const {
    std::vector<double> draws(z.size());
    std::ranges::transform(z, draws.begin(), in_unit_interval);
    plan_.to_draws(draws);
    return draws;
  }

  /// @param scene the campaign's, as it was or as this function left it
  void set_scene(const NormalPoint& z, Scene& scene) const {
    apply(campaign_, draws_at(z), campaign_.scene, scene);
  }

  [[nodiscard]] Outcome run(const NormalPoint& z) const {
    Scene scene = campaign_.scene;
    set_scene(z, scene);
    return Deployment().run(scene, campaign_.integration, limit_state_.goal());
  }

  struct Judged {
    double g;
    Status status;
  };

  /// Makes the runs that are still to be claimed, until asked to stop; one thread's part.
  template <class Claim>
  void judge(std::span<const NormalPoint> points, const Claim& claim,
             std::vector<Judged>& judged) const {
    Scene ended = campaign_.scene; // that of a run which has ended
    const auto next = [&](Scene& scene) -> std::optional<long> {
      const std::optional<std::size_t> k = claim();
      if (!k) return std::nullopt;
      set_scene(points[*k], scene);
      return static_cast<long>(*k);
    };
    const auto done = [&](long k, Outcome&& outcome) {
      set_scene(points[static_cast<std::size_t>(k)], ended);
      judged[static_cast<std::size_t>(k)] = {limit_state_.of(ended, outcome), outcome.status};
    };
    DeploymentPack(instruction_sets().back(), campaign_.integration, limit_state_.goal())
        .run(campaign_.scene, next, done);
  }

private:
  const Campaign& campaign_;
  const LimitState& limit_state_;
  RunPlan plan_;
};

/// All points on all threads, in their order whichever is done first. @throws Stopped
std::vector<NormalRuns::Judged> judge_all(const NormalRuns& runs,
                                          std::span<const NormalPoint> points, int threads,
                                          const std::atomic<bool>& stop) {
  std::vector<NormalRuns::Judged> judged(points.size());
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> broken = false; // by an exception
  const auto claim = [&]() -> std::optional<std::size_t> {
    if (stop || broken) return std::nullopt;
    const std::size_t k = next++;
    return k < points.size() ? std::optional(k) : std::nullopt;
  };
  on_team(
      threads, [&] { runs.judge(points, claim, judged); }, [&] { broken = true; });
  if (stop) throw Stopped{};
  return judged;
}

double distance(const NormalPoint& z) {
  Sum square;
  for (const double coordinate : z) square.add(coordinate * coordinate);
  return std::sqrt(square.value());
}

std::optional<LikeliestRun> likeliest_of(const std::vector<SubsetEstimate>& estimates,
                                         const NormalRuns& runs) {
  const NormalPoint* nearest = nullptr;
  for (const SubsetEstimate& estimate : estimates)
    for (const NormalPoint& point : estimate.inside)
      if (!nearest || distance(point) < distance(*nearest)) nearest = &point;
  if (!nearest) return std::nullopt;
  const Outcome outcome = runs.run(*nearest);
  return LikeliestRun{distance(*nearest), *nearest, runs.draws_at(*nearest), outcome.status,
                      outcome.reason};
}

} // namespace

RareResult estimate_rare_event(const Campaign& campaign, const RareOptions& options,
                               const std::atomic<bool>& stop,
                               const std::function<void(long)>& progress) {
  if (campaign.dispersions.empty())
    throw SpecError({{"", "/dispersions", "none", "at least one: there is nothing to vary"}});
  const LimitState limit_state(campaign, options.event);
  const NormalRuns runs(campaign, limit_state);
  RareResult result;
  long made = 0;
  const LimitStateFunction g = [&](std::span<const NormalPoint> points) {
    std::vector<double> values;
    for (const auto& [value, status] : judge_all(runs, points, options.threads, stop)) {
      values.push_back(value);
      ++result.statuses[static_cast<std::size_t>(status)];
    }
    progress(made += std::ssize(points));
    return values;
  };
  for (long k = 0; k < options.repeats; ++k)
    result.estimates.push_back(
        subset_simulation(g, campaign.dispersions.size(),
                          {options.samples, options.smallest, campaign.sampling.seed,
                           static_cast<std::uint64_t>(k)}));
  result.estimate = combined(result.estimates, options.confidence);
  result.likeliest = likeliest_of(result.estimates, runs);
  for (SubsetEstimate& estimate : result.estimates) estimate.inside.clear();
  return result;
}

} // namespace wingspread
