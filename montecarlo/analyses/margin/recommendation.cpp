#include "montecarlo/analyses/margin/recommendation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace wingspread {
namespace {

/// A scale that may be recommended.
struct Candidate {
  double scale, strain;
};
using Candidates = std::vector<Candidate>; // by scale, upwards

/// A range of neighbouring candidates, by index.
struct Stretch {
  std::size_t first, last;
};

Candidates candidates_in(const Window& window, const MarginSearch& search) {
  Candidates candidates;
  for (const auto& [scale, cases] : search.seen)
    if (window.lower <= scale && scale <= window.upper)
      candidates.push_back({scale, strain(cases)});
  return candidates;
}

std::vector<Stretch> stretches_of_least(const Candidates& candidates) {
  const double least = std::ranges::min_element(candidates, {}, &Candidate::strain)->strain;
  std::vector<Stretch> stretches;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (candidates[k].strain != least) continue;
    if (!stretches.empty() && stretches.back().last + 1 == k)
      stretches.back().last = k;
    else
      stretches.push_back({k, k});
  }
  return stretches;
}

bool holds_present(const Candidates& candidates, const Stretch& stretch) {
  return candidates[stretch.first].scale <= 1 && 1 <= candidates[stretch.last].scale;
}

/// The stretch of least strain that contains the present springs; else the widest one by ratio.
Stretch best_stretch(const Candidates& candidates) {
  const auto stretches = stretches_of_least(candidates);
  const auto present = std::ranges::find_if(
      stretches, [&](const Stretch& each) { return holds_present(candidates, each); });
  if (present != stretches.end()) return *present;
  return *std::ranges::max_element(stretches, {}, [&](const Stretch& each) {
    return candidates[each.last].scale / candidates[each.first].scale;
  });
}

/// Chooses a scale. Evaluates further scales first if the choice depends on them.
class Recommendation {
public:
  Recommendation(const RecommendationCallbacks& means, MarginSearch& search)
      : means_(means), search_(search) {}

  void choose() {
    do {
      const auto windows = windows_of(failing_by_scale(search_));
      const Window* window = widest(windows);
      if (!window) return withhold(Withheld::no_window);
      if (!window->below) return withhold(Withheld::no_lower_edge);
      if (!window->above) return withhold(Withheld::no_upper_edge);
      choose_from(candidates_in(*window, search_));
    } while (ran_);
  }

private:
  void withhold(Withheld why) { search_.withheld = why; }

  /// Recommends the best candidate without a shortfall, or evaluates a scale on which the choice depends.
  void choose_from(const Candidates& all) {
    ran_ = false;
    Candidates advisable;
    std::ranges::copy_if(all, std::back_inserter(advisable),
                         [&](const Candidate& each) { return !means_.shortfall(each.scale); });
    if (!advisable.empty()) choose_best(advisable);
    if (ran_) return;
    note_passed_over(all);
    if (!search_.recommended) withhold(Withheld::short_of_torque);
  }

  void choose_best(const Candidates& candidates) {
    const Stretch best = best_stretch(candidates);
    if (halve(candidates, best.last) || halve_below(candidates, best.first)) return;
    const double middle = middle_of(candidates, best);
    if (!search_.seen.contains(middle)) return run_at(middle);
    search_.recommended = middle;
    search_.as_good = {candidates[best.first].scale, candidates[best.last].scale};
  }

  [[nodiscard]] double middle_of(const Candidates& candidates, const Stretch& best) const {
    if (holds_present(candidates, best) && search_.seen.contains(1)) return 1;
    const double lower = candidates[best.first].scale, upper = candidates[best.last].scale;
    return std::clamp(rounded_scale(std::sqrt(lower * upper), means_.tolerance), lower, upper);
  }

  /// Evaluates the middle of the cell above a candidate if the cell is wide. @return whether it did
  bool halve(const Candidates& candidates, std::size_t below) {
    if (below + 1 >= candidates.size()) return false;
    const double from = candidates[below].scale, to = candidates[below + 1].scale;
    const double middle = rounded_scale(std::sqrt(from * to), means_.tolerance);
    if (to <= from * (1 + means_.tolerance) || middle <= from || to <= middle) return false;
    run_at(middle);
    return true;
  }

  bool halve_below(const Candidates& candidates, std::size_t above) {
    return above > 0 && halve(candidates, above - 1);
  }

  void run_at(double scale) {
    means_.run_at(scale);
    ran_ = true;
  }

  /// Notes the best candidate that a static margin ruled out, if it has less strain than the recommended scale.
  void note_passed_over(const Candidates& all) {
    const auto best = std::ranges::min_element(all, {}, &Candidate::strain);
    const bool better =
        !search_.recommended || best->strain < strain(search_.seen.at(*search_.recommended));
    if (better) search_.passed_over = means_.shortfall(best->scale);
  }

  const RecommendationCallbacks& means_;
  MarginSearch& search_;
  bool ran_ = false;
};

} // namespace

double strain(const Verdict& verdict) {
  const double may = static_cast<double>(verdict.runs) * (1 - verdict.requirement.probability);
  return static_cast<double>(verdict.broken.size()) / may;
}

double strain(const ScaleResult& cases) {
  double worst = 0;
  for (const CaseResult& each : cases)
    for (const Verdict& verdict : each.verdicts) worst = std::max(worst, strain(verdict));
  return worst;
}

void recommend(const RecommendationCallbacks& means, MarginSearch& search) {
  Recommendation(means, search).choose();
}

} // namespace wingspread
