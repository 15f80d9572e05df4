#!/bin/bash
# tests/vm/kernel.sh ARCH FOLDER
#
# Debian's newest kernel for this release with its modules (amd64, arm64), and v4l2loopback built for it, unpacked into
# FOLDER; nothing is installed. Prints the kernel's version. What is there already is kept.
set -euo pipefail
die() { printf 'vm: %s\n' "$*" >&2; exit 1; }
arch=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
toolchains=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../toolchains" && pwd)

# The modules are built by this machine's programs (kbuild) with the other's headers.
ours=$(dpkg --print-architecture) compiler=()
apt=()
if [ "$arch" != "$ours" ]; then
  apt=("$toolchains/foreign_apt.sh" "$arch" "$(dirname "$folder")/apt")
  compiler=(ARCH="$arch" CROSS_COMPILE=aarch64-linux-gnu-)
fi

# The package linux-image-ARCH names the present kernel's.
newest=$("${apt[@]}" apt-cache depends "linux-image-$arch" 2>/dev/null |
  sed -n 's/^ *Depends: linux-image-\([0-9].*\)/\1/p' | head -1)
version=${newest:-$(cat "$folder/version" 2>/dev/null || true)}
[ -n "$version" ] || die "apt knows no kernel package; run 'apt-get update' as root"
if [ ! -f "$folder/done" ] || [ "$(cat "$folder/version")" != "$version" ]; then
  rm -rf "$folder"
  mkdir -p "$folder/packages" "$folder/loopback"
  echo "$version" >"$folder/version"
  headers=$folder/usr/src/linux-headers-$version
  (cd "$folder/packages" &&
    "${apt[@]}" apt-get -qq download "linux-image-$version" "linux-headers-$version" \
      "linux-headers-${version%-*}-common" v4l2loopback-dkms &&
    apt-get -qq download "linux-kbuild-${version%.*-*-*}") >"$folder/apt.log" 2>&1 ||
    { cat "$folder/apt.log" >&2; die "the kernel's packages cannot be downloaded"; }
  for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$folder"; done
  rm -rf "$folder/packages"

  # The headers' makefile names the place where they are usually installed.
  sed -i "s|^include /usr/src|include $folder/usr/src|" "$headers/Makefile"
  cp "$folder"/usr/src/v4l2loopback-*/*.[ch] "$folder/loopback"
  echo 'obj-m := v4l2loopback.o' >"$folder/loopback/Kbuild"
  make -C "$headers" M="$folder/loopback" "${compiler[@]}" modules >"$folder/loopback/build.log" 2>&1 ||
    { tail -20 "$folder/loopback/build.log" >&2; die "v4l2loopback does not build for $version"; }
  mkdir -p "$folder/lib/modules/$version/extra"
  cp "$folder/loopback/v4l2loopback.ko" "$folder/lib/modules/$version/extra"
  depmod -b "$folder" "$version"
  touch "$folder/done"
fi
echo "$version"
