#include "montecarlo/engine/accuracy/drawn_runs.hpp"

#include "distributions/random_stream.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {

std::vector<std::size_t> drawn_rows(const Results& results, std::uint64_t seed, std::size_t count) {
  std::vector<std::pair<std::uint64_t, std::size_t>> least; // ranks and rows; the largest in front
  for (std::size_t row = 0; row < results.size() && count > 0; ++row) {
    const Status status = results.status[row];
    if (status == Status::failed || status == Status::invalid) continue;
    const std::pair ranked(choice_rank(seed, static_cast<std::uint64_t>(results.runs[row])), row);
    if (least.size() == count) {
      if (!(ranked < least.front())) continue;
      std::ranges::pop_heap(least);
      least.pop_back();
    }
    least.push_back(ranked);
    std::ranges::push_heap(least);
  }
  std::vector<std::size_t> rows;
  for (const auto& [rank, row] : least) rows.push_back(row);
  std::ranges::sort(rows);
  return rows;
}

} // namespace wingspread
