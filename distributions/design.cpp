#include "distributions/design.hpp"

#include "distributions/latin_hypercube.hpp"
#include "distributions/owen_scrambling.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace wingspread {

std::vector<std::size_t> order_by_name(const std::vector<std::string>& names) {
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) -> const std::string& { return names[i]; });
  return order;
}

PreparedDesign::PreparedDesign(const Design& design, const std::vector<std::string>& names)
    : design_(design) {
  assert(design.replicates >= 1);
  for (const std::string& name : names) streams_.push_back(stream_name(name));
  if (design.kind != DesignKind::sobol) return;
  const std::vector<SobolDimension> all = sobol_dimensions(names.size());
  dimensions_.resize(names.size());
  for (std::size_t rank = 0; const std::size_t dispersion : order_by_name(names))
    dimensions_[dispersion] = all[rank++];
}

double PreparedDesign::uniform(std::uint64_t run, std::size_t dispersion) const {
  const StreamName name = streams_[dispersion];
  if (design_.kind == DesignKind::random) return wingspread::uniform(design_.seed, run, name);
  const std::uint64_t replicate = replicate_of(design_, run), i = run / design_.replicates;
  const ReplicateStream stream{design_.seed, name, replicate};
  if (design_.kind == DesignKind::sobol)
    return open_uniform(owen_scrambled(sobol_coordinate(dimensions_[dispersion], i), stream));
  const std::uint64_t n =
      design_.runs / design_.replicates + (replicate < design_.runs % design_.replicates ? 1 : 0);
  return latin_coordinate(i, n, stream);
}

} // namespace wingspread
