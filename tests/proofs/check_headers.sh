#!/bin/bash
# check_headers.sh FOLDER: every header from outside that a source below FOLDER includes must be on the list.
set -euo pipefail
export LC_ALL=C
folder=$1
allowed=' algorithm array bit climits cmath compare concepts cstddef cstdint cstdlib cstring initializer_list limits
  new numbers span tuple type_traits utility
  arm_neon.h immintrin.h smmintrin.h sys/auxv.h
  Eigen/Cholesky Eigen/Core Eigen/Eigenvalues Eigen/Geometry Eigen/LU Eigen/QR Eigen/SVD '
allowed=${allowed//$'\n'/ }

count=$(find "$folder" -name '*.hpp' -o -name '*.cpp' | wc -l)
[ "$count" -gt 0 ] || { echo "no source in $folder"; exit 2; }
status=0
pattern='^(.*):([0-9]+):[[:space:]]*#[[:space:]]*include[[:space:]]*([<"])([^>"]+)[>"]'
while read -r line; do
  if [[ $line =~ $pattern ]]; then
    header=${BASH_REMATCH[4]}
    [[ ${BASH_REMATCH[3]} == '"' && $header == core/* ]] && continue  # its own
    [[ $allowed == *" $header "* ]] && continue
    echo "forbidden: $header in ${BASH_REMATCH[1]}:${BASH_REMATCH[2]}"
  else
    echo "forbidden: what $line includes cannot be read"
  fi
  status=1
done < <(grep -rnE --include='*.hpp' --include='*.cpp' '^[[:space:]]*#[[:space:]]*include' "$folder")
[ $status -ne 0 ] || echo "only allowed headers in $count sources"
exit $status
