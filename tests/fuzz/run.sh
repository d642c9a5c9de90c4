#!/usr/bin/env bash
# Installs what is missing, builds the fuzz targets and runs them one after another:
#   tests/fuzz/run.sh                      each for a minute
#   tests/fuzz/run.sh 600 obj_model        one of them for ten
# A target stops at its first finding, whose input is then in build/fuzz/findings; inputs that reach
# new code gather in build/fuzz/corpus. Exits 0 if nothing was found.
set -euo pipefail
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/../../tools/setup.sh"
cd "$taut_root"

seconds=${1:-60}
targets=("${@:2}")

taut_setup build fuzz
say "build the fuzz targets"
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
if ((${#targets[@]} == 0)); then
  for file in build/fuzz/tests/fuzz/fuzz_*; do targets+=("${file##*/fuzz_}"); done
fi

found=()
for target in "${targets[@]}"; do
  case $target in
    directions) seeds=directions ;;
    taut_* | hull_*) seeds=${target%_*} seeds=${seeds/_/.} ;;
    *) seeds=${target%_*} ;;
  esac
  corpus=build/fuzz/corpus/$target
  findings=build/fuzz/findings/$target
  mkdir -p "$corpus" "$findings"
  say "$target for $seconds seconds"
  UBSAN_OPTIONS=print_stacktrace=1 "build/fuzz/tests/fuzz/fuzz_$target" \
    -max_total_time="$seconds" -max_len=65536 -timeout=10 -rss_limit_mb=2048 -verbosity=0 -dict=tests/fuzz/words.dict \
    -print_final_stats=1 -artifact_prefix="$findings/" "$corpus" "tests/fuzz/corpus/$seeds" ||
    found+=("$target")
done
((${#found[@]} == 0)) || fail "findings in: ${found[*]}"
