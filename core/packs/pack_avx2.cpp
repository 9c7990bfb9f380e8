#include "core/packs/pack_stepper.hpp"

namespace wingspread {

std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>& wing, const PackShape& shape) {
  return make_pack_stepper<4>(wing, shape);
}

} // namespace wingspread
