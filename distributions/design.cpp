#include "distributions/design.hpp"

#include <stdexcept>

namespace wingspread {

double uniform(const Design& design, std::uint64_t run, StreamName dispersion) {
  if (!is_available(design.kind)) throw std::logic_error("this design is not available");
  return uniform(design.seed, run, dispersion);
}

} // namespace wingspread
