#!/bin/bash
# toolchains/cross.sh arm64|armhf [BUILD_FOLDER]
# Cross-compiles Pliant with its tests into build/ARCH (or BUILD_FOLDER). Needs the Debian packages
# g++-aarch64-linux-gnu or g++-arm-linux-gnueabihf, and qemu-user to run what was built; the target's libraries
# are unpacked into build/sysroot/ARCH. Further CMake options go into CROSS_OPTIONS.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

die() { printf 'cross: %s\n' "$*" >&2; exit 1; }
[ $# -ge 1 ] || die "usage: toolchains/cross.sh arm64|armhf [BUILD_FOLDER]"
arch=$1
folder=${2:-build/$arch}
case $arch in
  arm64) triplet=aarch64-linux-gnu emulator=qemu-aarch64 ;;
  armhf) triplet=arm-linux-gnueabihf emulator=qemu-arm ;;
  *) die "unknown architecture '$arch'; arm64 and armhf are known" ;;
esac
command -v "$triplet-g++" >/dev/null || die "no cross compiler; install it: sudo apt install g++-$triplet"
command -v "$emulator" >/dev/null || die "no emulator; install it: sudo apt install qemu-user"

sysroot=$PWD/build/sysroot/$arch
toolchains/make_sysroot.sh "$arch" "$sysroot"
read -r -a options <<<"${CROSS_OPTIONS:-}"
cmake -S . -B "$folder" -G Ninja "-DCMAKE_TOOLCHAIN_FILE=toolchains/$triplet.cmake" "-DPLIANT_SYSROOT=$sysroot" \
  "${options[@]}"
cmake --build "$folder" -j "$(nproc)"
