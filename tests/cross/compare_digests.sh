#!/bin/bash
# tests/cross/compare_digests.sh FRAMES BUILD... -- SOURCE[=MODEL]...
# Tracks the first FRAMES frames of every source in every build (foreign ones run under qemu-user) with every
# kernel of its architecture, and compares the digests of the results, bit for bit. A source is a recording's
# folder with its model file, or simulated:..., whose model each build makes for itself. Behind capture: stands one
# that a model is captured from.
set -euo pipefail
export LC_ALL=C

die() { printf 'compare_digests: %s\n' "$*" >&2; exit 2; }
[ $# -ge 4 ] || die "usage: tests/cross/compare_digests.sh FRAMES BUILD... -- SOURCE[=MODEL]..."
frames=$1
shift
builds=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do builds+=("$1"); shift; done
[ $# -ge 2 ] || die "name a source behind --"
shift

. "$(dirname "${BASH_SOURCE[0]}")/launch.sh"

failed=0
for source in "$@"; do
  model=-
  case $source in *=*.model) model=${source##*=} source=${source%=*} ;; esac
  first=
  for build in "${builds[@]}"; do
    program=$build/tests/cross/replay_frames words=("$model" "$source")
    [ "$source" = "${source#capture:}" ] || program=$build/tests/cross/capture_frames words=("${source#capture:}")
    [ -x "$program" ] || die "$program is not built"
    launch "$program" "$build"
    for kernel in "${kernels[@]}"; do
      line=$("${runner[@]}" "$program" "${words[@]}" --kernels "$kernel" --frames "$frames") || die "$program failed on $source"
      [ -n "$first" ] || first=$line
      verdict=same
      [ "$line" = "$first" ] || { verdict=DIFFERENT; failed=1; }
      printf '%-28s %-20s %-7s %-10s %s\n' "${source##*/}" "$(basename "$build")" "$kernel" "$verdict" "$line"
    done
  done
done
exit $failed
