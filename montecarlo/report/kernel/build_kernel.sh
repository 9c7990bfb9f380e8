#!/usr/bin/env bash
# The kernel in the page: kernel.cpp with core and distributions as WebAssembly, by Debian 12's clang-14, lld-14, wasi-libc,
# libc++-14-dev-wasm32, libc++abi-14-dev-wasm32 and libclang-rt-14-dev-wasm32.
#   build_kernel.sh SOURCES EIGEN OUT [LAUNCHER] COMPILER
set -euo pipefail
sources=$1 eigen=$2 out=$3 compiler=("${@:4}")
work=$out.parts # always the same, so that ccache knows its files again
rm -rf "$work"
mkdir "$work"
trap 'rm -rf "$work"' EXIT
# -Os: a third of the size of -O2, and the modes compile in seconds in place of minutes. Contraction is off as in the program.
flags=(--target=wasm32-wasi -std=c++20 -Os -DNDEBUG -ffp-contract=off -DWINGSPREAD_HAS_FMA -fno-exceptions -DBOOST_NO_EXCEPTIONS -D__riscv -DR123_USE_GNU_UINT128=1
       -DBOOST_MATH_BERNOULLI_UNTHREADED -DBOOST_SMART_PTR_DETAIL_LIGHTWEIGHT_MUTEX_HPP_INCLUDED
       -D_WASI_EMULATED_PROCESS_CLOCKS -include "$sources/montecarlo/report/kernel/older_ranges.hpp"
       -I "$sources" -isystem "$eigen" -idirafter /usr/include)
# Files that compile together in the program do so here.
together() { printf '#include "%s"\n' "${@:2}" > "$work/$1.cpp"; }
cd "$sources"
together scene core/outcome.cpp core/scene/*.cpp montecarlo/report/data/motion.cpp
together proofs core/proofs/{modes,natural_modes,rest_model,rest_model_bounds}.cpp # share decompositions of matrices
together modal core/proofs/modal_*.cpp
together laws distributions/{continuous_law,step_law,truncated_law,prepared_distribution,copula}.cpp
together designs distributions/{random_stream,design,latin_hypercube,owen_scrambling,sobol_sequence}.cpp
printf '%s\n' montecarlo/report/kernel/kernel.cpp "$work"/{proofs,modal,scene,laws,designs}.cpp |
  xargs -P 2 -I{} sh -c 'file=$1; shift; "$@" -c "$file" -o "'"$work"'/$(basename "$file").o"' sh {} "${compiler[@]}" "${flags[@]}"
"${compiler[-1]}" --target=wasm32-wasi -Os -mexec-model=reactor "$work"/*.o -o "$work/kernel.wasm" \
  -Wl,--strip-all -Wl,--gc-sections
gzip -9n < "$work/kernel.wasm" | base64 -w0 > "$work/kernel.base64"
mv "$work/kernel.base64" "$out"
