#!/usr/bin/env bash
# tiers_test.sh TIERS_FILE PROGRAMS_FOLDER: every pattern that puts cases into a tier has a case. The
# lines of the file are PROGRAM PATTERN.
set -euo pipefail
set -f
failed=0
while read -r program pattern; do
  listed=$("$2/$program" --gtest_list_tests --gtest_filter="$pattern")
  grep -q '^  ' <<<"$listed" && continue
  echo "$program: no case is $pattern"
  failed=1
done <"$1"
exit $failed
