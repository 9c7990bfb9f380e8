#include "core/packs/pack_engine.hpp"

namespace wingspread {

std::unique_ptr<PackEngine> make_engine(InstructionSet set, const Wing<double>& wing,
                                        const PackShape& shape) {
  switch (set) {
  case InstructionSet::neon:
    return make_neon_engine(wing, shape);
  case InstructionSet::avx2:
    return make_avx2_engine(wing, shape);
  case InstructionSet::avx512:
    return make_avx512_engine(wing, shape);
  case InstructionSet::scalar:
    break;
  }
  return {};
}

// ---- instruction sets of other processors

#ifndef __x86_64__
std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>&, const PackShape&) { return {}; }
std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>&, const PackShape&) { return {}; }
#endif
#ifndef __aarch64__
std::unique_ptr<PackEngine> make_neon_engine(const Wing<double>&, const PackShape&) { return {}; }
#endif

} // namespace wingspread
