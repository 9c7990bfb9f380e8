# shellcheck shell=bash disable=SC2034,SC2154 # variables are those of the scripts that source this
# The steps that tests/run and tests/nightly are made of. Sourced by both, from the repository's root.

tests_from=() # the build whose test objects the sanitizers' builds link

# known_words KNOWN -- WORDS…: refuses all words but KNOWN
known_words() {
  local known=$1 word
  shift 2
  for word in "$@"; do
    [ "$word" = "$known" ] || { echo "$0: found $word, expected $known or nothing" >&2; exit 2; }
  done
}

# build PRESET TARGETS
build() {
  local preset=$1 targets=$2
  echo "== $preset"
  cmake --preset "$preset" "${tests_from[@]}" "${cmake_options[@]}" >/dev/null
  # shellcheck disable=SC2086 # the targets are words
  cmake --build --preset "$preset" --target $targets
}

# test_preset PRESET [ctest's options …]
test_preset() {
  local preset=$1
  shift
  # one more than there are processors: some tests wait, for a browser, for ranks, for an interruption
  ctest --test-dir "build/$preset" --no-tests=error --output-on-failure --parallel "$(($(nproc) + 1))" "$@"
}

# build_and_test PRESET TARGETS [ctest's options …]
build_and_test() {
  build "$1" "$2"
  test_preset "$1" "${@:3}"
}

check_rooms() {
  echo "== rooms"
  /usr/bin/python3 tests/rooms.py
}

check_format() {
  echo "== clang-format"
  git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format --dry-run --Werror
}

# check_tidy [clang-tidy's options …]: the checks of .clang-tidy on the product's files
check_tidy() {
  echo "== clang-tidy"
  # GCC's precompiled headers, warning names, unique symbols and parameters mean nothing to clang
  cmake --preset release -B build/lint -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DWINGSPREAD_TESTS=OFF >/dev/null
  cmake --build build/lint --target wingspread_build_stamp >/dev/null
  sed -i 's/ -fno-gnu-unique//; s/ --param=[a-z-]*=[0-9]*//' build/lint/compile_commands.json
  # Files as they are compiled, several at once: GCC reports what shadows. Left out: files that montecarlo/CMakeLists.txt
  # excuses, and the report's page, which the build writes.
  python3 -c 'import json, sys; print(*sorted({unit["file"] for unit in json.load(open(sys.argv[1]))}), sep="\0", end="\0")' \
    build/lint/compile_commands.json | grep -zE '/(core|distributions|montecarlo)/' |
    grep -zvE '(unity_not_for_clang_cxx\.cxx|montecarlo/page_files\.cpp)$' |
    xargs -0 -P "$(nproc)" -n 1 clang-tidy -p build/lint --quiet --warnings-as-errors='*' \
      --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-shadow "$@"
}

fuzz_replays='fuzz_scene_replay fuzz_campaign_replay fuzz_rows_replay fuzz_command_replay'
