#!/bin/bash
# tests/package/install_test.sh ARCH PACKAGES
# Uses what ./dev package made, from the installed files only: the program's version, check and run on the simulated
# source, the service's unit, and a CMake project of its own that finds Pliant and tracks a frame.
#
# Packages of this machine's architecture are installed by apt into a fresh Debian root (debootstrap, as root); where
# that cannot be had, and for other architectures, they are unpacked and run beside the libraries of build/sysroot.
# PLIANT_TEST_ROOT=unpacked asks for the latter.
set -euo pipefail
export LC_ALL=C.UTF-8
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

die() { printf 'install_test: %s\n' "$*" >&2; exit 1; }
passed() { printf '  ok    %s\n' "$*"; }
[ $# -eq 2 ] || die "usage: tests/package/install_test.sh ARCH PACKAGES"
arch=$1
packages=$(cd "$2" && pwd)
own=$(dpkg --print-architecture)
sysroot=$here/build/sysroot/$arch
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
root=$scratch/root
program_package=$(echo "$packages"/pliant_*_"$arch".deb)
development_package=$(echo "$packages"/libpliant-dev_*_"$arch".deb)

# The same name and version everywhere, and nothing of the machine that built it.
version=$(dpkg-deb -f "$program_package" Version)
dpkg-deb -x "$program_package" "$scratch/look"
dpkg-deb -x "$development_package" "$scratch/look"
! grep -rlF "$here" "$scratch/look" || die "the packages tell where they were built"
passed "no path of the building machine is inside"
case $(dpkg-deb -f "$program_package" Depends) in
  *liblcm1*libstdc++6*) ;;
  *) die "the program's dependencies are not told" ;;
esac
for script in "$here"/toolchains/packaging/debian/{postinst,prerm,postrm}; do
  sh -n "$script" || die "$script is no shell script"
done

run() { # run COMMAND...: in the installed root
  if [ "$mode" = chroot ]; then
    chroot "$root" "$@"
  else
    local program=$1
    shift
    "${emulator[@]}" "$root$program" "$@"
  fi
}

mode=unpacked
emulator=()
if [ "$arch" = "$own" ] && [ "${PLIANT_TEST_ROOT:-}" != unpacked ] && [ "$(id -u)" -eq 0 ] && command -v debootstrap >/dev/null; then
  mode=chroot
fi
prefix=$root
if [ $mode = chroot ]; then
  site=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
  debootstrap --variant=minbase bookworm "$root" "$site" >"$scratch/log" 2>&1 || { tail -5 "$scratch/log" >&2; die "no Debian root"; }
  cp "$packages"/*.deb "$root/tmp/"
  # shellcheck disable=SC2016
  chroot "$root" sh -c 'DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install /tmp/pliant_*.deb /tmp/pliant-lcmtypes_*.deb' \
    >"$scratch/log" 2>&1 || { tail -20 "$scratch/log" >&2; die "apt could not install the packages"; }
  passed "apt installs pliant and pliant-lcmtypes with what they depend on"
  prefix=
else
  for package in "$packages"/*.deb; do dpkg-deb -x "$package" "$root"; done
  case $arch in
    "$own") ;;
    arm64) emulator=(qemu-aarch64 -L "$sysroot") ;;
    armhf) emulator=(qemu-arm -L "$sysroot") ;;
  esac
fi

[ "$(run /usr/bin/pliant --version)" = "pliant $version" ] || die "pliant --version tells another version"
passed "pliant --version"
run /usr/bin/pliant check --config "$prefix/etc/pliant/pliant.toml" >"$scratch/check" || die "the installed config is not valid"
grep -q '^memory, MB: ' "$scratch/check" || die "pliant check tells no memory"
passed "pliant check of the installed config"
run /usr/bin/pliant run --config "$prefix/etc/pliant/pliant.toml" --lcm-url none --frames 10 >"$scratch/run" || die "pliant run did not track"
grep -q 'tracked [1-9]' "$scratch/run" || die "pliant run tracked nothing"
passed "pliant run on the simulated source: $(head -1 "$scratch/run" | tr -s ' ')"
run /usr/bin/pliant model build simulated:box -o "$([ $mode = chroot ] && echo /tmp || echo "$scratch")/box.model" >/dev/null
[ $mode = unpacked ] || cp "$root/tmp/box.model" "$scratch/"

# The unit, with the program where the unit looks for it.
if command -v systemd-analyze >/dev/null; then
  unit=$scratch/pliant.service
  sed "s,^ExecStart=/usr/bin/pliant,ExecStart=$root/usr/bin/pliant," "$root/lib/systemd/system/pliant.service" >"$unit"
  systemd-analyze verify --man=no "$unit" || die "systemd-analyze verify has something to say"
  systemd-analyze security --offline=yes --threshold=30 "$unit" >"$scratch/security" || die "the service is too exposed: $(tail -1 "$scratch/security")"
  passed "the unit verifies; $(tail -1 "$scratch/security" | sed 's/^[^O]*//')"
fi

# A project of one's own.
[ -d "$root/usr/include/pliant" ] || dpkg-deb -x "$development_package" "$root"
options=()
case $arch in
  "$own") ;;
  arm64) options=("-DCMAKE_TOOLCHAIN_FILE=$here/toolchains/aarch64-linux-gnu.cmake" "-DPLIANT_SYSROOT=$sysroot" "-DPliant_DIR=$root/usr/lib/aarch64-linux-gnu/cmake/Pliant") ;;
  armhf) options=("-DCMAKE_TOOLCHAIN_FILE=$here/toolchains/arm-linux-gnueabihf.cmake" "-DPLIANT_SYSROOT=$sysroot" "-DPliant_DIR=$root/usr/lib/arm-linux-gnueabihf/cmake/Pliant") ;;
esac
cp -r "$root/usr/share/doc/libpliant-dev/examples" "$scratch/example"
cmake -S "$scratch/example" -B "$scratch/build" -G Ninja "-DCMAKE_PREFIX_PATH=$root/usr" -DCMAKE_BUILD_TYPE=Release "${options[@]}" >"$scratch/log" 2>&1 &&
  cmake --build "$scratch/build" >>"$scratch/log" 2>&1 || { tail -20 "$scratch/log" >&2; die "the example does not build"; }
found=$("${emulator[@]}" "$scratch/build/track_frame" "$scratch/box.model") || die "the example tracks nothing"
passed "a CMake project finds Pliant: $found"
if [ "$arch" = "$own" ]; then
  libraries=$(PKG_CONFIG_PATH=$(echo "$root"/usr/lib/*/pkgconfig) PKG_CONFIG_SYSROOT_DIR=$root pkg-config --cflags --libs pliant | sed "s,$root/usr/include/eigen3,/usr/include/eigen3,g")
  # shellcheck disable=SC2086
  c++ -std=c++20 -O2 "$scratch/example/track_frame.cpp" $libraries -o "$scratch/by_pkg_config"
  [ "$("$scratch/by_pkg_config" "$scratch/box.model")" = "$found" ] || die "the example by pkg-config says something else"
  passed "and so does pkg-config"
fi

if [ $mode = chroot ]; then
  echo '# mine' >>"$root/etc/pliant/pliant.toml"
  chroot "$root" dpkg -r pliant >/dev/null
  grep -q '^# mine' "$root/etc/pliant/pliant.toml" || die "removing the package took the user's config"
  chroot "$root" dpkg -P pliant >/dev/null 2>&1
  [ ! -e "$root/etc/pliant" ] && [ ! -e "$root/usr/bin/pliant" ] || die "purging the package leaves files behind"
  passed "a changed config outlives removal, and nothing outlives purging"
fi
