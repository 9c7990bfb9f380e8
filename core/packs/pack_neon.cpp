#include "core/packs/pack_stepper.hpp"

namespace wingspread {

std::unique_ptr<PackEngine> make_neon_engine(const Wing<double>& wing, const PackShape& shape) {
  return make_pack_stepper<2>(wing, shape);
}

} // namespace wingspread
