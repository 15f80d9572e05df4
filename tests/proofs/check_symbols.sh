#!/bin/bash
# check_symbols.sh NM ARCHIVE: everything that the archive needs from outside must be on the list below. No heap,
# exception, lock, clock, file or stream is. Prints what is not and fails.
set -euo pipefail
export LC_ALL=C
nm=$1 archive=$2
[ -s "$archive" ] || { echo "no archive $archive"; exit 2; }

allowed='^(
  mem(cpy|move|set|cmp)|                                # plain memory
  _GLOBAL_OFFSET_TABLE_|__stack_chk_(fail|guard)|       # added by the compiler
  __[a-z]+(si|di|ti|sf|df)[a-z0-9]*|__aeabi_[a-z0-9_]+| # its arithmetic on wide or missing types
  __gnu_(thumb1_case|uldivmod|ldivmod)[a-z_]*|
  __cpu_(model|features2|indicator_init)|getauxval|     # which instructions the processor knows
  sqrtf?|floorf?|ceilf?                                 # exact on every platform
)$'
allowed=$(printf '%s\n' "$allowed" | sed 's/#.*//' | tr -d ' \n')

needed() { "$nm" -u --format=posix "$archive" | awk 'NF >= 2 { print $1 }' | sort -u; }
defined() { "$nm" --defined-only --format=posix "$archive" | awk 'NF >= 2 { print $1 }' | sort -u; }

[ "$(defined | wc -l)" -gt 0 ] || { echo "no symbol in $archive"; exit 2; }
forbidden=$(comm -23 <(needed) <(defined) | grep -vE "$allowed" | c++filt || true)
if [ -n "$forbidden" ]; then
  printf 'forbidden: %s\n' $(printf '%s\n' "$forbidden" | tr ' ' '_')
  exit 1
fi
echo "only allowed symbols in $(basename "$archive"), which defines $(defined | wc -l)"
