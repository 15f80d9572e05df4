#!/bin/bash
# tests/package/install_test.sh ARCH PACKAGES
# Uses what ./dev package made, from the installed files only: the program's version, check and run on the simulated
# source, the viewer's page, the service (booted, where the packages are this machine's), and a CMake project of its
# own that finds Pliant and tracks a frame.
#
# The packages are installed by apt into a fresh Debian root of their architecture (debootstrap, as root; foreign
# programs run there under qemu-user-static); where that cannot be had, they are unpacked and run beside the libraries
# of build/sysroot. PLIANT_TEST_ROOT=unpacked asks for the latter.
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
. "$here/tests/package/foreign_programs.sh"
scratch=$(mktemp -d)
viewer=
trap '[ -z "$viewer" ] || kill "$viewer" 2>/dev/null; forget_programs; rm -rf "$scratch"' EXIT
root=$scratch/root
program_package=$(echo "$packages"/pliant_*_"$arch".deb)
viewer_package=$(echo "$packages"/pliant-viewer_*_"$arch".deb)
development_package=$(echo "$packages"/libpliant-dev_*_"$arch".deb)

# The same name and version everywhere, and nothing of the machine that built it.
version=$(dpkg-deb -f "$program_package" Version)
for package in "$program_package" "$viewer_package" "$development_package"; do dpkg-deb -x "$package" "$scratch/look"; done
! grep -rlF "$here" "$scratch/look" || die "the packages tell where they were built"
passed "no path of the building machine is inside"
case $(dpkg-deb -f "$program_package" Depends) in
  *civetweb*) die "the tracker depends on the viewer's web server" ;;
  *liblcm1*libstdc++6*) ;;
  *) die "the program's dependencies are not told" ;;
esac
case $(dpkg-deb -f "$viewer_package" Depends) in
  "pliant (= $version),"*libcivetweb1*) ;;
  *) die "the viewer's dependencies are not told" ;;
esac
cmp "$scratch/look/lib/udev/rules.d/60-pliant.rules" "$here/config/60-pliant.rules" || die "the rules for devices are others"
for script in "$here"/toolchains/packaging/debian/{postinst,prerm,postrm}; do
  sh -n "$script" || die "$script is no shell script"
done

in_root() { # in_root COMMAND...: sets `words`, which run it from the installed files
  if [ "$mode" = chroot ]; then
    # shellcheck disable=SC2016
    words=(unshare --mount sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$root" "$@")
  else
    words=("${emulator[@]}" "$root$1" "${@:2}")
  fi
}
run() { in_root "$@" && "${words[@]}"; }

mode=unpacked
emulator=()
case $arch in
  "$own") ;;
  arm64) emulator=(qemu-aarch64 -L "$sysroot") ;;
  armhf) emulator=(qemu-arm -L "$sysroot") ;;
esac
if [ "${PLIANT_TEST_ROOT:-}" != unpacked ] && [ "$(id -u)" -eq 0 ] && command -v debootstrap >/dev/null && let_kernel_run "$arch"; then
  mode=chroot
fi
prefix=$root
if [ $mode = chroot ]; then
  site=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
  debootstrap --arch="$arch" --variant=minbase bookworm "$root" "$site" >"$scratch/log" 2>&1 || { tail -5 "$scratch/log" >&2; die "no Debian root"; }
  cp "$packages"/*.deb "$root/tmp/"
  install() {
    # shellcheck disable=SC2016
    chroot "$root" sh -c 'cd /tmp && DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install "$@"' sh "$@" \
      >"$scratch/log" 2>&1 || { tail -20 "$scratch/log" >&2; die "apt could not install $*"; }
  }
  (cd "$packages" && printf './%s\n' pliant_*.deb pliant-lcmtypes_*.deb) >"$scratch/first"
  mapfile -t first <"$scratch/first"
  install "${first[@]}"
  [ "$(chroot "$root" dpkg --print-architecture)" = "$arch" ] || die "the root is not $arch"
  ! chroot "$root" dpkg -s libcivetweb1 >/dev/null 2>&1 || die "the tracker brought a web server along"
  passed "apt installs pliant and pliant-lcmtypes with what they depend on, into a fresh $arch root"
  message=$(run /usr/bin/pliant view 2>&1) && die "pliant view runs without its package"
  case $message in *pliant-viewer*) ;; *) die "pliant view does not name its package: $message" ;; esac
  install "./$(basename "$viewer_package")"
  passed "and pliant-viewer, which pliant view asks for"
  prefix=
else
  for package in "$packages"/*.deb; do dpkg-deb -x "$package" "$root"; done
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

# The page, as a browser fetches it: every file that it names, and three.js whole.
view=(/usr/bin/pliant view)
# An emulator that runs one program does not run those that it starts.
[ $mode = chroot ] || [ "$arch" = "$own" ] || view=(/usr/libexec/pliant/pliant-view)
in_root "${view[@]}" --port 0 --lcm-url 'udpm://239.255.76.67:7667?ttl=0'
"${words[@]}" >"$scratch/view" 2>"$scratch/view.errors" &
viewer=$!
port=
for _ in $(seq 200); do
  port=$(sed -n 's,^open http://127\.0\.0\.1:\([0-9]*\)/$,\1,p' "$scratch/view")
  [ -n "$port" ] && break
  sleep 0.1
done
[ -n "$port" ] || die "pliant view tells no address: $(cat "$scratch/view" "$scratch/view.errors")"
fetch() { # fetch PATH: the body, unpacked
  exec 9<>"/dev/tcp/127.0.0.1/$port"
  printf 'GET %s HTTP/1.0\r\nHost: 127.0.0.1:%s\r\n\r\n' "$1" "$port" >&9
  LC_ALL=C sed -e '1,/^\r$/d' <&9 | gunzip -c
  exec 9<&-
}
fetch / >"$scratch/page" || die "pliant view serves no page"
mapfile -t named < <(grep -o '\(src\|href\)="[a-z.]*"' "$scratch/page" | cut -d'"' -f2 | grep -v '^data')
[ ${#named[@]} -ge 2 ] || die "the page names no files"
for file in "${named[@]}" three.module.js three.core.js; do fetch "/$file" >"$scratch/file" && [ -s "$scratch/file" ] || die "the page's $file is missing"; done
kill "$viewer"
wait "$viewer" || die "the viewer did not end well"
viewer=
passed "pliant view serves its page, $(stat -c %s "$scratch/file") bytes of three.js in it"

# The unit, with the program where the unit looks for it.
if command -v systemd-analyze >/dev/null; then
  unit=$scratch/pliant.service
  sed "s,^ExecStart=/usr/bin/pliant,ExecStart=$root/usr/bin/pliant," "$root/lib/systemd/system/pliant.service" >"$unit"
  systemd-analyze verify --man=no "$unit" || die "systemd-analyze verify has something to say"
  systemd-analyze security --offline=yes --threshold=30 "$unit" >"$scratch/security" || die "the service is too exposed: $(tail -1 "$scratch/security")"
  passed "the unit verifies; $(tail -1 "$scratch/security" | sed 's/^[^O]*//')"
fi

# And under a service manager of its own; a foreign one would run at an emulator's pace.
if [ $mode = chroot ] && [ "$arch" = "$own" ] && command -v systemd-nspawn >/dev/null; then
  install systemd-sysv iproute2 procps
  "$here/tests/package/service_test.sh" "$root"
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
  chroot "$root" dpkg -r pliant-viewer pliant >/dev/null
  grep -q '^# mine' "$root/etc/pliant/pliant.toml" || die "removing the package took the user's config"
  chroot "$root" dpkg -P pliant-viewer pliant >/dev/null 2>&1
  [ ! -e "$root/etc/pliant" ] && [ ! -e "$root/usr/bin/pliant" ] || die "purging the package leaves files behind"
  passed "a changed config outlives removal, and nothing outlives purging"
fi
