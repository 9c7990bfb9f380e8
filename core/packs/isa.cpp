#include "core/packs/pack_engine.hpp"

namespace wingspread {

bool has_avx2() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

bool has_neon() {
#ifdef __aarch64__
  return true;
#else
  return false;
#endif
}

bool has_avx512() {
#ifdef __x86_64__
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd");
#else
  return false;
#endif
}

// ---- those that this build is without

#ifndef __x86_64__
std::unique_ptr<PackEngine> make_avx2_engine(const Wing<double>&, const PackShape&) { return {}; }
std::unique_ptr<PackEngine> make_avx512_engine(const Wing<double>&, const PackShape&) { return {}; }
#endif
#ifndef __aarch64__
std::unique_ptr<PackEngine> make_neon_engine(const Wing<double>&, const PackShape&) { return {}; }
#endif

} // namespace wingspread
