#!/bin/bash
# toolchains/make_sysroot.sh ARCH DIR [PACKAGE...]
# Unpacks the Debian packages that Pliant is built against, for another architecture (arm64, armhf), into DIR.
# Needs no root. Done again only when the list of packages has changed.
set -euo pipefail
export LC_ALL=C

die() { printf 'make_sysroot: %s\n' "$*" >&2; exit 1; }
[ $# -ge 2 ] || die "usage: toolchains/make_sysroot.sh arm64|armhf DIR [PACKAGE...]"
arch=$1
dir=$2
shift 2
case $arch in arm64 | armhf) ;; *) die "unknown architecture '$arch'; arm64 and armhf are known" ;; esac

packages=(libc6-dev libstdc++-12-dev libeigen3-dev libnanoflann-dev libfmt-dev libcli11-dev
  libtomlplusplus-dev nlohmann-json3-dev libpng-dev nettle-dev liblcm-dev libopenni2-dev libusb-1.0-0-dev libcivetweb-dev libgtest-dev libbenchmark-dev "$@")
stamp=$dir/.packages
[ -f "$stamp" ] && [ -d "$dir/.shlibs" ] && [ "$(cat "$stamp")" = "${packages[*]}" ] && exit 0

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
toolchains=$(dirname "${BASH_SOURCE[0]}")
"$toolchains/foreign_apt.sh" "$arch" "$scratch" apt-get -qq -y --download-only install "${packages[@]}" \
  >"$scratch/log" 2>&1 || { tail -5 "$scratch/log" >&2; die "the packages could not be fetched"; }

rm -rf "$dir"
mkdir -p "$dir/.shlibs"
for package in "$scratch"/cache/archives/*.deb; do
  dpkg -x "$package" "$dir"
  # Which package to depend on for which library: toolchains/packaging/dependencies.sh reads it.
  dpkg -I "$package" shlibs >"$dir/.shlibs/$(basename "$package").shlibs" 2>/dev/null || true
done
# Links to absolute places would lead out of the sysroot.
find "$dir" -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
  ln -snf "$(realpath -m --relative-to="$(dirname "$link")" "$dir$(readlink "$link")")" "$link"
done
echo "${packages[*]}" >"$stamp"
printf '%s: %s packages, %s\n' "$dir" "$(find "$scratch/cache/archives" -name '*.deb' | wc -l)" "$(du -sh "$dir" | cut -f1)"
