#include "core/packs/pack_stepper.hpp"

namespace wingspread {

std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>& wing, const PackShape& shape) {
  return make_pack_stepper<8>(wing, shape);
}

} // namespace wingspread
