#!/bin/bash
# toolchains/packaging/package.sh [amd64|arm64|armhf] [OUTPUT]
# Builds the Debian packages pliant, pliant-viewer, libpliant-dev and pliant-lcmtypes into OUTPUT (build/packages/ARCH),
# the same bytes every time from the same sources. Without an architecture, for this machine. Needs three.js in
# firmware-app/viewer/node_modules (npm ci there).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export LC_ALL=C.UTF-8 TZ=UTC
umask 022

say() { printf '\n== %s\n' "$*"; }
die() { printf 'package: %s\n' "$*" >&2; exit 2; }
own=$(dpkg --print-architecture)
arch=${1:-$own}
case $arch in
  amd64) triplet=x86_64-linux-gnu preset=release ;;
  arm64) triplet=aarch64-linux-gnu preset=rpi-arm64 ;;
  armhf) triplet=arm-linux-gnueabihf preset=rpi-armhf ;;
  *) die "unknown architecture '$arch'; amd64, arm64 and armhf are known" ;;
esac
options=()
sysroot=
if [ "$arch" = "$own" ]; then
  preset=release
elif [ "$preset" = release ]; then
  die "$arch packages are built on an $arch machine"
else
  sysroot=$PWD/build/sysroot/$arch
  toolchains/make_sysroot.sh "$arch" "$sysroot"
  options+=("-DPLIANT_SYSROOT=$sysroot")
fi
output=${2:-build/packages/$arch}
mkdir -p build "$output"
output=$(cd "$output" && pwd)
# Every time stamp in the packages is that of the change log's newest entry.
SOURCE_DATE_EPOCH=$(dpkg-parsechangelog -l toolchains/packaging/debian/changelog -S Timestamp)
export SOURCE_DATE_EPOCH
[ "$(dpkg-parsechangelog -l toolchains/packaging/debian/changelog -S Version)" = \
  "$(sed -n 's/^project(Pliant VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)" ] ||
  die "toolchains/packaging/debian/changelog and CMakeLists.txt name different versions"

[ -f firmware-app/viewer/node_modules/three/LICENSE ] || die "no three.js for the viewer; npm ci --omit=dev in firmware-app/viewer"
command -v ccache >/dev/null && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
options+=(-DCMAKE_INSTALL_PREFIX=/usr "-DCMAKE_INSTALL_LIBDIR=lib/$triplet" "-DPLIANT_DEB_ARCHITECTURE=$arch"
  -DPLIANT_BUILD_BENCHMARKS=OFF)
configure() {
  cmake --preset "$preset" "${options[@]}" "$@" >"build/$preset.log" 2>&1 ||
    { cat "build/$preset.log" >&2; die "cmake --preset $preset failed"; }
}
configure
say "building $preset"
targets=(pliant pliant-view pliant_lcm_package)
grep -q '^PLIANT_LCM_JAR:.*=/' "build/$preset/CMakeCache.txt" && targets+=(pliant_lcm_jar)
cmake --build "build/$preset" -j "$(nproc)" --target "${targets[@]}"
depends() { toolchains/packaging/dependencies.sh "build/$preset/firmware-app/$1" ${sysroot:+"$sysroot"}; }
program_depends=$(depends pliant) viewer_depends=$(depends pliant-view)
configure "-DPLIANT_DEB_DEPENDS=$program_depends" "-DPLIANT_DEB_VIEWER_DEPENDS=$viewer_depends"

say "packing for $arch"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cpack --config "build/$preset/CPackConfig.cmake" -B "$scratch/packed" >"$scratch/log" 2>&1 ||
  { cat "$scratch/log" >&2; die "cpack failed"; }
rm -f "$output"/*.deb
for package in "$scratch"/packed/*.deb; do
  # CPack keeps the build's time stamps and order; packing anew with one stamp gives the same bytes every time.
  tree=$scratch/tree
  rm -rf "$tree"
  dpkg-deb -R "$package" "$tree"
  find "$tree" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
  (cd "$tree" && find . -path ./DEBIAN -prune -o -type f -printf '%P\n' | LC_ALL=C sort | xargs md5sum >DEBIAN/md5sums)
  touch -d "@$SOURCE_DATE_EPOCH" "$tree"/DEBIAN/md5sums "$tree/DEBIAN"
  dpkg-deb --root-owner-group -Zxz --uniform-compression --build "$tree" "$output/$(basename "$package")" >/dev/null
done
(cd "$output" && sha256sum -- *.deb)
