#include "montecarlo/results/streaming/population.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace wingspread {

Population::Population(const Grid& grid)
    : counts_(grid), lowest_(Extremes::End::lowest, kept_extremes),
      highest_(Extremes::End::highest, kept_extremes) {}

void Population::add(const Population& other) {
  count_ += other.count_;
  counts_.add(other.counts_);
  lowest_.add(other.lowest_);
  highest_.add(other.highest_);
}

double Population::min() const { return count_ > 0 ? lowest_.sorted().front().value : undefined; }
double Population::max() const { return count_ > 0 ? highest_.sorted().front().value : undefined; }

void Population::write(StateWriter& to) const {
  to.put(static_cast<std::int64_t>(count_));
  counts_.write(to);
  lowest_.write(to);
  highest_.write(to);
}

void Population::read(StateReader& from) {
  count_ = static_cast<long>(from.get<std::int64_t>());
  counts_.read(from);
  lowest_.read(from);
  highest_.read(from);
}

RankedPopulation::RankedPopulation(const Population& population)
    : count_(population.count()), lowest_(population.lowest().sorted()),
      highest_(population.highest().sorted()), bins_(population.counts().bins()) {}

OrderStatistic RankedPopulation::at(long rank) const {
  assert(1 <= rank && rank <= count_);
  const auto exact = [](double value) { return OrderStatistic{value, value, value, 0}; };
  if (rank <= std::ssize(lowest_)) return exact(lowest_[static_cast<std::size_t>(rank - 1)].value);
  if (count_ - rank < std::ssize(highest_))
    return exact(highest_[static_cast<std::size_t>(count_ - rank)].value);
  const auto holds = std::ranges::partition_point(
      bins_, [&](const ValueCounts::Bin& bin) { return bin.below + bin.count < rank; });
  const double lower = std::max(holds->lower, lowest_.back().value);
  const double upper = std::min(holds->upper, highest_.back().value);
  const double part =
      (static_cast<double>(rank - holds->below) - 0.5) / static_cast<double>(holds->count);
  if (holds->lower == 0 && holds->upper == std::numeric_limits<double>::denorm_min())
    return exact(0); // the bin of zeros
  const double value = std::clamp(std::lerp(holds->lower, holds->upper, part), lower, upper);
  return {value, lower, upper, std::max(rank - holds->below, holds->below + holds->count - rank)};
}

} // namespace wingspread
