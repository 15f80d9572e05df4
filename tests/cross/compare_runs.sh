#!/bin/bash
# tests/cross/compare_runs.sh FRAMES BUILD...
# Runs the program of every build (foreign ones under qemu-user) over the first FRAMES frames of the simulated
# cushion and, where the shared recordings are (PLIANT_SHARED_DATA, else ../shared/data), of the real plush toy, with
# the scalar and the automatic kernels. The output_sha256 of all must be the same, and so must the model files that
# each build makes.
set -euo pipefail
export LC_ALL=C

die() { printf 'compare_runs: %s\n' "$*" >&2; exit 2; }
[ $# -ge 3 ] || die "usage: tests/cross/compare_runs.sh FRAMES BUILD BUILD..."
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/launch.sh"
frames=$1
shift
data=${PLIANT_SHARED_DATA:-$here/../../../shared/data}
toy=$data/real_plush_squirrel
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
sources=(simulated:cushion)
if [ -d "$toy" ]; then sources+=("recording:$toy"); else echo "no recording at $toy: compared on the simulated source only"; fi

failed=0
same() { # same NAME WHAT VALUE FIRST
  local verdict=same
  [ "$3" = "$4" ] || { verdict=DIFFERENT; failed=1; }
  printf '%-40s %-20s %-10s %s\n' "$1" "$2" "$verdict" "$3"
}

for source in "${sources[@]}"; do
  first='' first_model=''
  for build in "$@"; do
    program=$build/firmware-app/pliant
    [ -x "$program" ] || die "$program is not built"
    launch "$program" "$build"
    options=(--source "$source")
    if [ "$source" != "${source#recording:}" ]; then
      "${runner[@]}" "$program" model build "${source#recording:}/model.ply" -o "$scratch/model" >/dev/null
      model=$(sha256sum "$scratch/model" | cut -d' ' -f1)
      first_model=${first_model:-$model}
      same "model of ${source##*/}" "$(basename "$build")" "$model" "$first_model"
      options+=(--model "$scratch/model")
    fi
    for kernel in scalar auto; do
      status=0
      "${runner[@]}" "$program" run "${options[@]}" --frames "$frames" --pace fast --lcm-url none --kernels $kernel \
        --stats "$scratch/stats" >/dev/null 2>"$scratch/errors" || status=$?
      [ $status -le 1 ] || { cat "$scratch/errors" >&2; die "$program failed on $source"; }
      hash=$(sed -n 's/.*"output_sha256": *"\([0-9a-f]*\)".*/\1/p' "$scratch/stats")
      tracked=$(sed -n 's/.*"tracked": *\([0-9]*\).*/\1/p' "$scratch/stats")
      [ ${#hash} -eq 64 ] && [ "$tracked" -gt 0 ] || die "$program tracked nothing on $source"
      first=${first:-$hash}
      same "$source"  "$(basename "$build") $kernel" "$hash" "$first"
    done
  done
done
exit $failed
