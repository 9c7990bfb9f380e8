#include "core/packs/pack_engine.hpp"

// Engines that this build is without.

namespace wingspread {

#ifndef __x86_64__
std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>&, const PackShape&) { return {}; }
std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>&, const PackShape&) { return {}; }
#endif
#ifndef __aarch64__
std::unique_ptr<PackEngine> make_neon_engine(const Wing<double>&, const PackShape&) { return {}; }
#endif

} // namespace wingspread
