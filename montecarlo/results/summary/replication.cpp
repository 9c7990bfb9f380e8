#include "montecarlo/results/summary/replication.hpp"

#include <algorithm>
#include <cstdint>
#include <map>

namespace wingspread {

Replication replication_of(const Sampling& sampling, const Results& results) {
  if (!has_replicates(sampling)) return {};
  const Design design = design_of(sampling);
  Replication replication;
  std::map<std::uint64_t, int> numbers;
  for (const long run : results.runs) {
    const std::uint64_t replicate = replicate_of(design, static_cast<std::uint64_t>(run));
    replication.of_row.push_back(
        numbers.try_emplace(replicate, static_cast<int>(numbers.size())).first->second);
  }
  results.runs.release();
  replication.replicates = std::max(1, static_cast<int>(numbers.size()));
  return replication;
}

} // namespace wingspread
