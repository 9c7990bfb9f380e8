#include "montecarlo/results/streaming/extremes.hpp"

namespace wingspread {

void Extremes::put(const RunValue& mine) {
  if (heap_.size() == most_) {
    std::ranges::pop_heap(heap_, is_before);
    heap_.back() = mine;
  } else {
    heap_.push_back(mine);
  }
  std::ranges::push_heap(heap_, is_before);
}

std::vector<RunValue> Extremes::sorted() const {
  std::vector<RunValue> values = heap_;
  std::ranges::sort(values, is_before);
  for (RunValue& each : values) each.value *= sign_;
  return values;
}

void Extremes::write(StateWriter& to) const {
  const std::vector<RunValue> values = sorted();
  to.put(std::uint64_t{values.size()});
  for (const auto& [value, run] : values) {
    to.put(value);
    to.put(static_cast<std::int64_t>(run));
  }
}

void Extremes::read(StateReader& from) {
  heap_.clear();
  for (std::size_t left = from.get_count(sizeof(double) + sizeof(std::int64_t)); left > 0; --left) {
    const double value = from.get<double>();
    add(value, static_cast<long>(from.get<std::int64_t>()));
  }
}

} // namespace wingspread
