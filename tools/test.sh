#!/usr/bin/env bash
# Installs what is missing, builds the tests and runs them, by tiers (tests/CMakeLists.txt):
#   tools/test.sh               what a change must pass: quick and full
#   tools/test.sh --sweep       all tiers: an hour on two cores
#   tools/test.sh -L quick      arguments of ctest: here the quick ones only
#   tools/test.sh -R Bezier     those whose name matches, of all tiers
# TAUT_WARNINGS_AS_ERRORS=ON in the environment makes compiler warnings errors.
set -euo pipefail
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$taut_root"

run() { ctest --preset test -j "$(nproc)" "$@"; }

# Sets `used` to the seconds of the processor that children of this shell have taken.
count_seconds() {
  times >build/times
  used=$(awk -F '[ms ]+' 'NR == 2 { print int(60 * $1 + $2 + 60 * $3 + $4) }' build/times)
}

# The quick tests are to take a minute of the processor in all; at twice that they fail.
run_quick() {
  local used before status=0
  count_seconds
  before=$used
  run -L quick || status=1
  count_seconds
  say "quick tests: $((used - before)) s of the processor, 60 are aimed at"
  ((used - before <= 120)) || fail "the quick tests take more than 120 s of the processor"
  return $status
}

taut_setup build test

say "configure build/test"
cmake --preset test -DTAUT_WARNINGS_AS_ERRORS="${TAUT_WARNINGS_AS_ERRORS:-OFF}" >/dev/null

timed build cmake --build --preset test

if (($#)) && [[ $1 != --sweep ]]; then
  run "$@"
  exit
fi
status=0
timed "quick tests" run_quick || status=1
timed "full tests" run -L full || status=1
[[ ${1:-} != --sweep ]] || timed "sweep" run -L sweep || status=1
exit $status
