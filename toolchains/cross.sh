#!/bin/bash
# toolchains/cross.sh arm64|armhf|jetson [--sysroot DIR] [--build-only|--quick|--count|--guest] [-- CTEST OPTION...]
#
# Cross-compiles Pliant into build/PRESET (rpi-arm64, rpi-armhf, jetson), runs the tests of the core and of what
# brings the outside in and out under qemu-user, and compares the results of whole runs, byte for byte, with those
# of the host's build.
#   --sysroot DIR   the board's own root of headers and libraries; else Debian's packages are unpacked into
#                   build/sysroot/ARCH
#   --build-only    no test
#   --quick         only the core, its tests and the comparison
#   --guest         only what runs in a virtual machine (tests/vm): built, not run
#   --count         only the instructions of a frame (64 bit), against tests/cross/instruction_limits.txt
# Needs the Debian packages g++-aarch64-linux-gnu or g++-arm-linux-gnueabihf, and qemu-user (./dev cross installs
# them). Further CMake options go into CROSS_OPTIONS.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '\n== %s\n' "$*"; }
die() { printf 'cross: %s\n' "$*" >&2; exit 2; }
usage="usage: ./dev cross arm64|armhf|jetson [--sysroot DIR] [--build-only|--quick|--count|--guest] [-- CTEST OPTION...]"
[ $# -ge 1 ] || die "$usage"
case $1 in
  arm64) arch=arm64 preset=rpi-arm64 ;;
  jetson) arch=arm64 preset=jetson ;;
  armhf) arch=armhf preset=rpi-armhf ;;
  *) die "unknown target '$1'; $usage" ;;
esac
shift
case $arch in
  arm64) triplet=aarch64-linux-gnu emulator=qemu-aarch64 ;;
  armhf) triplet=arm-linux-gnueabihf emulator=qemu-arm ;;
esac
sysroot='' part=all
while [ $# -gt 0 ]; do
  case $1 in
    --sysroot)
      [ -d "${2:-}/usr/include" ] || die "no headers in '${2:-}/usr/include': --sysroot wants the root of a system"
      sysroot=$(cd "$2" && pwd)
      shift
      ;;
    --build-only) part=build ;;
    --quick) part=quick ;;
    --guest) part=guest ;;
    --count)
      [ "$arch" = arm64 ] || die "instructions are counted on 64-bit ARM"
      part=count
      ;;
    --) shift && break ;;
    *) die "unknown option '$1'; $usage" ;;
  esac
  shift
done
command -v "$triplet-g++" >/dev/null || die "no cross compiler; install it: sudo apt install g++-$triplet"
[ $part = build ] || command -v "$emulator" >/dev/null || die "no emulator; install it: sudo apt install qemu-user"

if [ -z "$sysroot" ]; then
  sysroot=$PWD/build/sysroot/$arch
  toolchains/make_sysroot.sh "$arch" "$sysroot"
fi
folder=build/$preset
folders="core;cross;geometry_files;images;lcm;model_files;recording;simulated"
targets=()
case $part in
  quick) folders="core;cross" targets=(core_tests replay_frames capture_frames) ;;
  count) folders="core;cross" targets=(replay_frames capture_frames) ;;
  guest) folders="commands;vm" targets=(pliant guest_tests) ;;
esac
read -r -a options <<<"${CROSS_OPTIONS:-}"
command -v ccache >/dev/null && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
options+=("-DPLIANT_PRECOMPILE=${PLIANT_PRECOMPILE:-OFF}")
mkdir -p build
cmake --preset "$preset" "-DPLIANT_SYSROOT=$sysroot" "-DPLIANT_BUILD_TESTS=$([ $part = build ] && echo OFF || echo ON)" \
  "-DPLIANT_TEST_FOLDERS=$folders" "${options[@]}" >"build/$preset.log" 2>&1 ||
  { cat "build/$preset.log" >&2; die "cmake --preset $preset failed"; }
say "building $preset"
cmake --build "$folder" -j "$(nproc)" ${targets[@]+--target "${targets[@]}"}
[ $part != build ] && [ $part != guest ] || exit 0
if [ $part = count ]; then
  say "counting instructions, 30 frames"
  sources=(simulated:cushion simulated:figure simulated:box "capture:simulated:figure?motion=turned")
  toy=${PLIANT_SHARED_DATA:-../shared/data}/real_plush_squirrel
  if [ -d "$toy" ]; then
    mkdir -p build/bench
    cmake --build build/release -j "$(nproc)" --target pliant >/dev/null
    build/release/firmware-app/pliant model build "$toy/model.ply" -o build/bench/real_plush_squirrel.model >/dev/null
    sources+=("$toy=build/bench/real_plush_squirrel.model")
  fi
  LIMITS=tests/cross/instruction_limits.txt tests/cross/instructions.sh "$folder" 30 "${sources[@]}"
  exit
fi

say "testing under $emulator"
# What compares the kernels of one build runs below, over both builds.
ctest --test-dir "$folder" -j "$(nproc)" --output-on-failure --exclude-regex '^cross\.' "$@"

say "comparing with this machine's build"
host=(pliant replay_frames capture_frames)
[ $part = quick ] && host=(replay_frames capture_frames)
[ -f build/release/CMakeCache.txt ] && grep -q '^PLIANT_BUILD_TESTS:BOOL=ON' build/release/CMakeCache.txt ||
  cmake --preset release -DPLIANT_BUILD_TESTS=ON "${options[@]}" >build/release.log 2>&1 ||
  { cat build/release.log >&2; die "cmake --preset release failed"; }
cmake --build build/release -j "$(nproc)" --target "${host[@]}" >/dev/null
tests/cross/compare_digests.sh 12 build/release "$folder" -- simulated:cushion \
  "capture:simulated:figure?motion=turned&frames=60&width=320&height=240"
[ $part = quick ] || tests/cross/compare_runs.sh 60 build/release "$folder"
