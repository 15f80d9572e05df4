#!/bin/bash
# toolchains/packaging/sizes.sh [ARCH...]
# A table of what the packages in build/packages/ARCH take: the stripped program, the package's files, those of the
# viewer's package, what the program is linked with, and the time from its start to the first published status (median
# of five; a recording and a model file at hand; foreign programs under emulation, which is many times slower than the
# board).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export LC_ALL=C
die() { printf 'sizes: %s\n' "$*" >&2; exit 2; }
architectures=("$@")
[ $# -gt 0 ] || for folder in build/packages/*/; do architectures+=("$(basename "$folder")"); done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# first_status LOG START: milliseconds from START (seconds since the epoch) to the first status in an LCM log.
first_status() {
  python3 -B - "$1" "$2" <<'END'
import sys
sys.path.append("firmware-app/examples")
import lcm_python
print(next(round(utime / 1e3 - float(sys.argv[2]) * 1e3) for utime, channel, _ in lcm_python.read_log(sys.argv[1])
           if channel == "PLIANT_STATUS"))
END
}

printf '%-6s %12s %14s %11s %13s  %s\n' "" "program, kB" "installed, kB" "viewer, kB" "to status, ms" "linked with"
for arch in "${architectures[@]}"; do
  package=$(echo build/packages/"$arch"/pliant_*_"$arch".deb)
  viewer=$(echo build/packages/"$arch"/pliant-viewer_*_"$arch".deb)
  [ -f "$package" ] && [ -f "$viewer" ] || die "no packages for $arch; make them: ./dev package $arch"
  root=$scratch/$arch
  dpkg-deb -x "$package" "$root"
  runner=()
  if [ "$arch" != "$(dpkg --print-architecture)" ]; then
    case $arch in arm64) runner=(qemu-aarch64) ;; armhf) runner=(qemu-arm) ;; esac
    runner+=(-L "build/sysroot/$arch")
  fi
  program=$root/usr/bin/pliant
  if [ ! -d "$scratch/recording" ]; then
    "${runner[@]}" "$program" record --source simulated:cushion --frames 3 -o "$scratch/recording" >/dev/null
    "${runner[@]}" "$program" model build "$scratch/recording/model.ply" -o "$scratch/model" >/dev/null
  fi
  times=()
  for _ in 1 2 3 4 5; do
    start=$(date +%s.%N)
    "${runner[@]}" "$program" run --source "recording:$scratch/recording" --model "$scratch/model" \
      --lcm-url "file://$scratch/log?mode=w" >/dev/null 2>&1 || true
    times+=("$(first_status "$scratch/log" "$start")")
  done
  time=$(printf '%s\n' "${times[@]}" | sort -n | sed -n 3p)
  printf '%-6s %12s %14s %11s %13s  %s\n' "$arch" "$(($(stat -c %s "$program") / 1000))" \
    "$(dpkg-deb -f "$package" Installed-Size)" "$(dpkg-deb -f "$viewer" Installed-Size)" "$time" \
    "$(dpkg-deb -f "$package" Depends | sed 's/ ([^)]*)//g')"
done
