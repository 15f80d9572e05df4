#!/bin/bash
# tests/cross/instructions.sh BUILD FRAMES SOURCE[=MODEL]...
# Counts the instructions of the 64-bit ARM build in folder BUILD under qemu-user and prints a row a source, in
# millions: the median tracked frame and its stages, the costliest tracked and the costliest searching frame, and
# the whole of the first detection. Counts repeat exactly. The sources are those of compare_digests.sh; of
# a capture the first picture stands under detection.
# With LIMITS=FILE it fails when a figure is more than 10 % above the one there ("name median detection"), or when
# a source is missing there.
set -euo pipefail
export LC_ALL=C

die() { printf 'instructions: %s\n' "$*" >&2; exit 2; }
[ $# -ge 3 ] || die "usage: tests/cross/instructions.sh BUILD FRAMES SOURCE[=MODEL]..."
build=$1 frames=$2
shift 2
here=$(dirname "${BASH_SOURCE[0]}")
for program in replay_frames capture_frames; do
  [ -x "$build/tests/cross/$program" ] || die "$build/tests/cross/$program is not built"
done
sysroot=$(sed -n 's/^PLIANT_SYSROOT:[A-Z]*=//p' "$build/CMakeCache.txt")
command -v qemu-aarch64 >/dev/null || die "no qemu-aarch64; install it: sudo apt install qemu-user"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"${CC:-cc}" -O2 -shared -fPIC -o "$scratch/libcount.so" "$here/count_instructions.c"

# figures FILE: median and largest of tracked frames, largest searching frame, first detection, stage medians.
figures() {
  awk '
    function median(values, count,    i, j, t) {
      for (i = 2; i <= count; ++i) for (j = i; j > 1 && values[j - 1] > values[j]; --j) { t = values[j]; values[j] = values[j - 1]; values[j - 1] = t }
      return count ? values[int((count + 1) / 2)] : 0
    }
    /^#/ { next }
    found == 0 { detection += $3; if ($2 == 1) found = 1; if ($3 > search) search = $3; next }
    $2 == 1 && $11 == 0 { ++n; all[n] = $3; for (s = 0; s < 7; ++s) stage[s, n] = $(4 + s); if ($3 > most) most = $3; next }
    { if ($3 > search) search = $3 }
    END {
      printf "%.2f %.2f %.2f %.1f %d", median(all, n) / 1e6, most / 1e6, search / 1e6, found ? detection / 1e6 : 0, n
      for (s = 0; s < 7; ++s) { for (i = 1; i <= n; ++i) one[i] = stage[s, i]; printf " %.2f", median(one, n) / 1e6 }
      print ""
    }' "$1"
}

failed=0
printf '%-24s %7s %8s %8s %8s %9s | %7s %7s %9s %6s %6s %7s %6s\n' "million instructions" frames median most \
  search detection surface predict associate align label regroup deform
for source in "$@"; do
  model=-
  case $source in *=*.model) model=${source##*=} source=${source%=*} ;; esac
  name=${source##*/}
  program=$build/tests/cross/replay_frames words=("$model" "$source")
  [ "$source" = "${source#capture:}" ] || program=$build/tests/cross/capture_frames words=("${source#capture:}")
  env -i PATH="$PATH" qemu-aarch64 -plugin "$scratch/libcount.so,out=$scratch/counts" -L "$sysroot" "$program" \
    "${words[@]}" --frames "$frames" >"$scratch/line" || die "$program failed on $source"
  read -r median most search detection tracked stages <<<"$(figures "$scratch/counts")"
  read -r surface predict associate align label regroup deform <<<"$stages"
  printf '%-24s %7d %8s %8s %8s %9s | %7s %7s %9s %6s %6s %7s %6s\n' "$name" "$tracked" "$median" "$most" "$search" \
    "$detection" "$surface" "$predict" "$associate" "$align" "$label" "$regroup" "$deform"
  if [ -n "${LIMITS:-}" ]; then
    awk -v name="$name" -v median="$median" -v detection="$detection" '
      $1 == name { known = 1; bad = median > 1.1 * $2 || detection > 1.1 * $3 || median == 0 || detection == 0 }
      END {
        if (!known) print "instructions: " name " has no figure to compare with"
        if (bad) print "instructions: " name " costs more than 10 % above what it did, or was not tracked"
        exit !known || bad
      }' "$LIMITS" >&2 || failed=1
  fi
done
exit $failed
