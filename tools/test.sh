#!/usr/bin/env bash
# Installs what is missing, builds the tests and runs them. Arguments go to ctest:
#   tools/test.sh -L quick      only the quick ones
#   tools/test.sh -R Bezier     only those whose name matches
# TAUT_WARNINGS_AS_ERRORS=ON in the environment makes compiler warnings errors.
set -euo pipefail
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$taut_root"

taut_setup build test

say "configure build/test"
cmake --preset test -DTAUT_WARNINGS_AS_ERRORS="${TAUT_WARNINGS_AS_ERRORS:-OFF}" >/dev/null

say "build the tests"
cmake --build --preset test

say "run the tests"
ctest --preset test -j "$(nproc)" "$@"
