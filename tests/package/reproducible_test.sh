#!/bin/bash
# tests/package/reproducible_test.sh ARCH PACKAGES
# Builds the packages of the committed sources once more, elsewhere and without a compiler cache, and demands the same
# bytes.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[ $# -eq 2 ] || { echo "usage: tests/package/reproducible_test.sh ARCH PACKAGES" >&2; exit 2; }
packages=$(cd "$2" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
git clone -q "$here" "$scratch/another/place"
cd "$scratch/another/place"
(cd firmware-app/viewer && npm ci --omit=dev) >"$scratch/log" 2>&1 || { tail -5 "$scratch/log" >&2; exit 1; }
CCACHE_DISABLE=1 toolchains/packaging/package.sh "$1" "$scratch/packages" >"$scratch/log" 2>&1 || { tail -20 "$scratch/log" >&2; exit 1; }
failed=0
for package in "$packages"/*.deb; do
  if cmp "$package" "$scratch/packages/$(basename "$package")"; then echo "  ok    $(basename "$package")"; else failed=1; fi
done
exit $failed
