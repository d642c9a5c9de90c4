#!/usr/bin/env bash
# check.sh PREFIX WORK DATA: is the Taut that is installed in PREFIX complete? Builds a program
# against it, by CMake and by pkg-config, in the folder WORK, which it empties first; reads the
# models of DATA. Uses nothing of the build or the sources but this folder.
set -euo pipefail
prefix=$(cd "$1" && pwd)
data=$(cd "$3" && pwd)
consumer=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$2"
mkdir -p "$2"
cd "$2"

say() { echo "== $*"; }
fail() {
  echo "check.sh: $*" >&2
  exit 1
}
# only FILE...: the one of the files that is there.
only() {
  local file found=()
  for file in "$@"; do
    [[ ! -e $file ]] || found+=("$file")
  done
  ((${#found[@]} == 1)) || fail "not one file: $*"
  echo "${found[0]}"
}
pc=$(only "$prefix"/lib/{,*/}pkgconfig/taut.pc)
libraries=$(dirname "$(dirname "$pc")")
teapot=("$data/teapot.bpt" 32.504)

say "the command"
taut=$prefix/bin/taut
"$taut" hull "${teapot[0]}" -o teapot.ply --relative 1e-3
"$taut" verify teapot.ply "${teapot[0]}" --relative 1e-3

# Each command and option of the help, by the help's own words.
say "manual page and completion"
# shellcheck source=tools/taut/completion.bash
. "$prefix/share/bash-completion/completions/taut"
# complete_line WORD...: what completion offers for the last word.
complete_line() {
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  _taut "$taut" "${*: -1}" "${*: -2:1}"
  printf ' %s ' "${COMPREPLY[@]}"
}
page=$(gzip -dc "$(only "$prefix"/share/man/man1/taut.1*)" | sed 's/\\f[BRI]//g; s/\\//g')
commands=$("$taut" --help | sed -n '/^Commands:/,$ s/^  \([a-z]*\) .*/\1/p')
[[ $commands == *hull*verify* ]] || fail "the help names no commands"
options=0
for command in $commands; do
  [[ $(complete_line taut "${command:0:2}") == *" $command "* ]] || fail "no completion: $command"
  section=$(sed -n "/^\.SS taut $command\$/,/^\.S[SH]/p; /^\.SH OPTIONS\$/,/^\.SH EXIT/p" <<<"$page")
  offered=$(complete_line taut "$command" -)
  for option in $("$taut" "$command" --help | grep '^  -' | grep -oE '^  [^ ]+' | tr , ' '); do
    grep -qE -e "(^|, )$option( |,|\$)" <<<"$section" || fail "no manual: $command $option"
    [[ $offered == *" $option "* ]] || fail "no completion: $command $option"
    options=$((options + 1))
  done
done
((options > 20)) || fail "the help names only $options options"

say "CMake"
warnings=(-Wall -Wextra -Werror)
cmake -S "$consumer" -B cmake -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_FLAGS="${warnings[*]}" \
  >cmake.log
grep -q '^taut_DIR:PATH='"$libraries" cmake/CMakeCache.txt || fail "another Taut was found"
cmake --build cmake >>cmake.log
cmake/consumer "${teapot[@]}"

say "CMake, a component that there is not"
cmake -S "$consumer" -B cmake -DTAUT_COMPONENTS="hull;kitchen" >unknown.log 2>&1 &&
  fail "it was found"
grep -q 'no component "kitchen"; its components are: core surface' unknown.log ||
  fail "it is not named: $(<unknown.log)"

say "pkg-config"
export PKG_CONFIG_PATH=${pc%/*}
static=(--static)
[[ ! -e $libraries/libtaut_core.so ]] || static=()
read -ra flags <<<"$(pkg-config --cflags --libs "${static[@]}" taut)"
"${CXX:-c++}" -std=c++20 "${warnings[@]}" "$consumer/main.cpp" "${flags[@]}" -o pc_consumer
LD_LIBRARY_PATH=$libraries ./pc_consumer "${teapot[@]}"

say "complete"
