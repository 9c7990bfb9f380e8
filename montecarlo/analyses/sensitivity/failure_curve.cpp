#include "montecarlo/analyses/sensitivity/failure_curve.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <numeric>

namespace wingspread {

FailureCurve::FailureCurve(std::span<const double> index, std::span<const double> failed) {
  assert(!index.empty() && index.size() == failed.size());
  std::vector<std::size_t> order(index.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return index[i]; });
  for (std::size_t k = 0; k < order.size();) {
    Step step{index[order[k]], 0, 0};
    for (; k < order.size() && index[order[k]] == step.last; ++k)
      step.failed += failed[order[k]], step.runs += 1;
    while (!steps_.empty() && steps_.back().share() >= step.share()) {
      step.failed += steps_.back().failed, step.runs += steps_.back().runs;
      steps_.pop_back();
    }
    steps_.push_back(step);
  }
}

double FailureCurve::at(double index) const {
  const auto step = std::ranges::lower_bound(steps_, index, {}, &Step::last);
  return step == steps_.end() ? steps_.back().share() : step->share();
}

} // namespace wingspread
