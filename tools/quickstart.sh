#!/usr/bin/env bash
# Installs what is missing, builds the command taut and computes the hull of the teapot.
set -euo pipefail
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$taut_root"

taut_setup build

say "configure build/release"
cmake --preset release >/dev/null

say "build taut"
cmake --build --preset release --target taut

mkdir -p out
command=(build/release/bin/taut hull data/teapot.bpt -o out/teapot.ply)
say "${command[*]}"
"${command[@]}"

say "the hull is in $taut_root/out/teapot.ply"
