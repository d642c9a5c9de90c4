# shellcheck shell=bash
# Shared by the scripts; sourced, not run. Installs the Debian packages of tools/packages.txt.

taut_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# say TEXT: one line on what is being done. fail TEXT: one line on what went wrong, and exit.
say() { echo "== $*"; }
fail() {
  echo "taut: $*" >&2
  exit 1
}

# timed WHAT COMMAND...: runs it and says how long that took; its exit status.
timed() {
  local what=$1 begin=$SECONDS status=0
  shift
  say "$what"
  "$@" || status=$?
  say "$what: $( ((status == 0)) && echo passed || echo FAILED) in $((SECONDS - begin)) s"
  return $status
}

# taut_setup GROUP...: installs those packages of the groups that are missing.
taut_setup() {
  local group package purpose wanted missing=()
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian system; the libraries of tools/packages.txt ($*) must be there"
    return
  fi
  while read -r group package purpose; do
    for wanted in "$@"; do
      [[ $group == "$wanted" ]] || continue
      taut_installed "$package" && continue
      ((${#missing[@]})) || say "packages to install ($*):"
      printf '     %-20s %s\n' "$package" "$purpose"
      missing+=("$package")
    done
  done <"$taut_root/tools/packages.txt"
  ((${#missing[@]})) || return 0

  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      fail "cannot install packages: neither root nor sudo; as root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  say "apt-get update"
  "${as_root[@]}" apt-get update -qq || fail "apt-get update failed"
  say "apt-get install (this can take some minutes)"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null ||
    fail "apt-get install failed: ${missing[*]}"
}

taut_installed() {
  [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed* ]]
}
