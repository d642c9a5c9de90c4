#!/usr/bin/env bash
# Installs what is missing and makes the Debian packages taut, libtaut and libtaut-dev in out/.
#   tools/package.sh --test     also installs them on a fresh Debian 12, in a folder of its own that
#                               goes away again, and builds a program there (as root; some minutes)
set -euo pipefail
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$taut_root"

test=
case "$*" in
  "") ;;
  --test) test=1 ;;
  *) fail "usage: tools/package.sh [--test]" ;;
esac
[[ -z $test ]] || ((EUID == 0)) || fail "--test needs root, to set up a fresh system"
taut_setup build package

say "configure build/package"
cmake --preset package >/dev/null

say "build"
cmake --build --preset package

say "make the packages"
rm -f build/package/*.deb
cpack --preset package >build/package/cpack.log 2>&1 || {
  cat build/package/cpack.log >&2
  fail "the packages cannot be made"
}
mkdir -p out
rm -f out/*taut*.deb
cp build/package/*.deb out/
packages=(out/*taut*.deb)
say "made ${packages[*]}"
[[ -n $test ]] || exit 0

taut_setup fresh
fresh=$(mktemp -d)
chmod 755 "$fresh"
trap 'rm -rf --one-file-system "$fresh"' EXIT

# inside COMMAND...: in the fresh system, with a /proc that no one else sees and nothing of this
# environment but the way out.
inside() {
  # shellcheck disable=SC2016
  unshare --mount sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$fresh" \
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive ${http_proxy:+"http_proxy=$http_proxy"} "$@"
}
install_inside() {
  inside apt-get install -y -qq --no-install-recommends "$@" >"$fresh/apt.log" 2>&1 || {
    cat "$fresh/apt.log" >&2
    fail "not installable on a fresh system: $*"
  }
}

# From where this machine gets its packages, in the way that it does.
# shellcheck disable=SC2016
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' | head -n 1)
[[ -n $mirror ]] || fail "apt has no source of Debian 12 (bookworm) to make a fresh system from"
say "a fresh Debian 12"
debootstrap --variant=minbase bookworm "$fresh" "$mirror" >build/package/debootstrap.log ||
  fail "debootstrap failed; see build/package/debootstrap.log"
cp -rL /etc/apt/apt.conf.d /etc/apt/trusted.gpg.d "$fresh/etc/apt/"
cp -L /etc/resolv.conf "$fresh/etc/"
# Manual pages are what minimal systems leave out.
rm -f "$fresh"/etc/dpkg/dpkg.cfg.d/*
inside apt-get update -qq

mkdir "$fresh/taut"
cp -r tests/consumer data "${packages[@]}" "$fresh/taut/"
version=$(dpkg-deb -f "${packages[0]}" Version)_$(dpkg-deb -f "${packages[0]}" Architecture)

say "the command alone"
install_inside "/taut/taut_$version.deb" "/taut/libtaut_$version.deb"
inside taut --version
say "the rest"
install_inside "/taut/libtaut-dev_$version.deb" g++ make cmake pkg-config man-db
inside man --pager=cat taut >/dev/null
say "is it complete?"
inside /taut/consumer/check.sh /usr /taut/build /taut/data
say "the packages are good"
