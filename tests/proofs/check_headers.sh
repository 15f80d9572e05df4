#!/bin/bash
# check_headers.sh FOLDER: every header from outside that a source below FOLDER includes must be on the list.
set -euo pipefail
export LC_ALL=C
folder=$1
allowed='algorithm array bit climits cmath compare concepts cstddef cstdint cstdlib cstring initializer_list limits
  new numbers span tuple type_traits utility
  arm_neon.h immintrin.h smmintrin.h sys/auxv.h
  Eigen/Cholesky Eigen/Core Eigen/Eigenvalues Eigen/Geometry Eigen/LU Eigen/QR Eigen/SVD'

sources=$(find "$folder" -name '*.hpp' -o -name '*.cpp' | sort)
[ -n "$sources" ] || { echo "no source in $folder"; exit 2; }
status=0
while IFS=: read -r file line text; do
  header=$(sed -E 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]([^>"]+)[>"].*/\1/' <<<"$text")
  case $text in
    *'"'*) [[ $header == core/* ]] && continue ;;  # its own
    *) for word in $allowed; do [ "$word" = "$header" ] && continue 2; done ;;
  esac
  echo "forbidden: $header in $file:$line"
  status=1
done < <(grep -nE '^[[:space:]]*#[[:space:]]*include' $sources /dev/null)
[ $status -ne 0 ] || echo "only allowed headers in $(wc -w <<<"$sources") sources"
exit $status
