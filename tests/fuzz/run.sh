#!/bin/bash
# tests/fuzz/run.sh SECONDS [SEED]: runs every fuzz target of build/asan-ubsan for its share of SECONDS, beginning with
# the corpus in the repository. New inputs go to build/fuzz-corpus, findings to build/fuzz-crashes. Fails on the first
# finding. With a SEED each target gets a thousand inputs for every second of its share, the same in every run and on
# every machine; without one they are new each time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=${1:?usage: tests/fuzz/run.sh SECONDS [SEED]}
seed=${2:-0}
build=build/asan-ubsan
mapfile -t programs < <(find "$build/tests/fuzz" -maxdepth 1 -type f -executable -name '*_fuzz' | sort)
[ ${#programs[@]} -gt 0 ] || { echo "no fuzz target in $build: cmake --preset asan-ubsan && cmake --build $build --target fuzzers" >&2; exit 1; }
share=$((seconds / ${#programs[@]} > 0 ? seconds / ${#programs[@]} : 1))
limit="-max_total_time=$share"
[ "$seed" = 0 ] || limit="-runs=$((share * 1000))"
mkdir -p build/fuzz-crashes
for program in "${programs[@]}"; do
  name=$(basename "$program" _fuzz)
  mkdir -p "build/fuzz-corpus/$name"
  echo "== $name, $limit"
  "$program" -seed="$seed" "$limit" -timeout=20 -rss_limit_mb=2048 -verbosity=0 -print_final_stats=1 \
    -artifact_prefix="build/fuzz-crashes/$name-" "build/fuzz-corpus/$name" "tests/fuzz/corpus/$name" ||
    { echo "$name: the input is in build/fuzz-crashes" >&2; exit 1; }
done
echo "no finding in ${#programs[@]} targets"
