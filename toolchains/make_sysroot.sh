#!/bin/bash
# toolchains/make_sysroot.sh ARCH DIR [PACKAGE...]
# Unpacks the Debian packages that Pliant is built against, for another architecture (arm64, armhf), into DIR.
# The host needs no multiarch and no root; its own packages are not touched. Done again only when the list of
# packages has changed.
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

command -v apt-get >/dev/null || die "needs apt-get, on Debian 12"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch/lists/partial" "$scratch/cache/archives/partial"
: >"$scratch/status"

# The mirror that this machine uses already, of its own release.
site=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
[ -n "$site" ] || die "apt knows no mirror; run apt-get update first"
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-bookworm}")
keys=/usr/share/keyrings/debian-archive-keyring.gpg
printf 'deb [arch=%s signed-by=%s] %s %s main\n' "$arch" "$keys" "$site" "$release" >"$scratch/sources.list"
options=(-o "APT::Architecture=$arch" -o "APT::Architectures::=$arch" -o "Dir::State::lists=$scratch/lists"
  -o "Dir::State::status=$scratch/status" -o "Dir::Etc::sourcelist=$scratch/sources.list"
  -o Dir::Etc::sourceparts=/dev/null -o "Dir::Cache=$scratch/cache" -o Acquire::Languages=none
  -o APT::Install-Recommends=false -o Debug::NoLocking=1 -o APT::Sandbox::User=root)
apt-get "${options[@]}" -qq update || die "the mirror $site has no packages for $arch"
apt-get "${options[@]}" -qq -y --download-only install "${packages[@]}" >"$scratch/log" 2>&1 ||
  { tail -5 "$scratch/log" >&2; die "the packages could not be fetched"; }

rm -rf "$dir"
mkdir -p "$dir"
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
