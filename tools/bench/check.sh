#!/usr/bin/env bash
# Guards speed: counts the instructions of counted_runs, by stage, and says which changed by more
# than a tenth since reference.txt was written. About three minutes on two cores, after the build.
#   tools/bench/check.sh              all runs; exits 1 if something got slower
#   tools/bench/check.sh teapot blob  these alone
#   tools/bench/check.sh --update     writes reference.txt anew
# Counts depend on the compiler: where it is not the reference's, nothing is compared.
set -euo pipefail
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"
cd "$taut_root"
reference=tools/bench/reference.txt
program=build/release/bin/counted_runs
counts=build/counts

update=false
if [[ ${1:-} == --update ]]; then
  update=true
  shift
  (($# == 0)) || fail "--update takes all runs"
fi

# count RUN: leaves its stages in RUN.stages, and in RUN.parts what was counted before each of them.
# The C library chooses no code by what the processor can do, and binds functions before all stages.
count() {
  GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-ERMS,-FSRM LD_BIND_NOW=1 \
    valgrind --quiet --tool=callgrind --dump-before='taut_bench::stage_begins*' \
    --combine-dumps=yes --callgrind-out-file="$counts/$1.parts" \
    "$program" "$1" >"$counts/$1.stages"
}
export -f count
export program counts

# table RUN...: lines of run, stage and instructions; a stage that came more than once is summed up.
table() {
  local run
  for run in "$@"; do
    awk -v run="$run" '
      FNR == NR { stage[++stages] = $1; next }
      $1 == "totals:" { part[++parts] = $2 }
      END {
        # Before the first stage and after the last are parts too.
        if (stages == 0 || parts != stages + 1 || stage[stages] != "end") {
          print "taut: " run ": " stages " stages, " parts " parts" >"/dev/stderr"
          exit 1
        }
        for (k = 1; k < stages; ++k) {
          if (!(stage[k] in sum)) order[++count] = stage[k]
          sum[stage[k]] += part[k + 1]
          all += part[k + 1]
        }
        for (k = 1; k <= count; ++k) printf "%-17s %-10s %15.0f\n", run, order[k], sum[order[k]]
        printf "%-17s %-10s %15.0f\n", run, "all", all
      }' "$counts/$run.stages" "$counts/$run.parts" || fail "$run was not counted"
  done
}

# compare REFERENCE NOW: prints both and their ratio; fails if something got slower. Stages of less
# than a hundredth of their run, then and now, and those that are new or gone, tell nothing.
compare() {
  awk '
    /^#/ { next }
    FNR == NR { before[$1, $2] = $3; stages[$1] = stages[$1] " " $2; next }
    { now[$1, $2] = $3; if (!($1 in known)) { known[$1]; runs[++count] = $1 } }
    !(($1, $2) in before) { stages[$1] = stages[$1] " " $2 }
    function told(run, stage) {
      return 100 * now[run, stage] >= now[run, "all"] ||
             100 * before[run, stage] >= before[run, "all"]
    }
    function verdict(run, stage, ratio) {
      if (!((run, stage) in now)) return "gone"
      if (!((run, stage) in before)) return "new"
      ratio = now[run, stage] / before[run, stage]
      if (!told(run, stage) || (ratio <= 1.1 && ratio >= 1 / 1.1)) return ""
      if (ratio < 1) { faster = faster "; " run " " stage; return "faster" }
      slower = slower "; " run " " stage
      return "SLOWER"
    }
    END {
      form = "%-17s %-10s %15s %15s %7s  %s\n"
      printf form, "run", "stage", "reference", "now", "ratio", ""
      for (r = 1; r <= count; ++r) {
        last = split(stages[runs[r]], stage, " ")
        for (k = 1; k <= last; ++k) {
          said = verdict(runs[r], stage[k])
          b = before[runs[r], stage[k]]
          n = now[runs[r], stage[k]]
          printf form, runs[r], stage[k], b, n, b && n ? sprintf("%.3f", n / b) : "", said
        }
      }
      print "== faster by more than a tenth: " (faster ? substr(faster, 3) : "none")
      print "== slower by more than a tenth: " (slower ? substr(slower, 3) : "none")
      exit (slower != "")
    }' "$1" "$2"
}

taut_setup build count

say "build counted_runs"
cmake --preset release -DTAUT_BUILD_BENCHMARKS=ON >/dev/null
cmake --build --preset release --target counted_runs

{
  read -r compiler
  mapfile -t all_runs
} < <("$program")
compared=$(sed -n 's/^# compiler: //p' "$reference" 2>/dev/null) || compared=none
if ! $update && [[ $compiler != "$compared" ]]; then
  say "skipped, not comparable: the compiler is $compiler, that of $reference $compared"
  exit 0
fi

runs=("${all_runs[@]}")
(($# == 0)) || runs=("$@")
say "count instructions: ${runs[*]}"
rm -rf "$counts"
mkdir -p "$counts"
printf '%s\n' "${runs[@]}" | xargs -P "$(nproc)" -I RUN bash -c 'count RUN' ||
  fail "a run failed"
table "${runs[@]}" >"$counts/now.txt"

if $update; then
  {
    echo "# compiler: $compiler"
    echo "# Instructions of counted_runs by stage, which check.sh compares with and --update writes."
    cat "$counts/now.txt"
  } >"$reference"
  say "wrote $reference"
else
  compare "$reference" "$counts/now.txt"
fi
