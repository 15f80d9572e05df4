#!/bin/bash
# tests/proofs/no_float_in_kernels.sh OBJDUMP ARCHIVE SYMBOL...
# Disassembles the functions whose demangled names begin with one of SYMBOL and names every floating-point
# instruction in them. A symbol without a function is a failure, too: a check of nothing proves nothing.
set -euo pipefail
export LC_ALL=C

[ $# -ge 3 ] || { echo "usage: no_float_in_kernels.sh OBJDUMP ARCHIVE SYMBOL..." >&2; exit 2; }
objdump=$1 archive=$2
shift 2
"$objdump" --disassemble --demangle --no-show-raw-insn "$archive" | awk -v wanted="$(printf '%s\n' "$@")" '
  BEGIN {
    count = split(wanted, symbols, "\n")
    # x86: arithmetic, comparison and conversion of single and double precision, scalar and packed, with or
    # without the leading v; and the old x87 unit. Moves and logic on vector registers serve integers as well.
    x86 = "^(v?(add|sub|mul|div|sqrt|min|max|rcp|rsqrt|round|cmp[a-z]*|u?comi|hadd|hsub|addsub|dp)[sp][sd]|v?cvt[a-z0-9]+|vf[n]?m(add|sub)[a-z0-9]+|f(ld|st|add|sub|mul|div|ild|ist|com|ucom|sqrt|xch|chs|abs)[a-z]*)$"
    # ARM: all that begins with f but the fmov of whole registers; scvtf and ucvtf; and the v...f32/f64 of ARMv7.
    arm64 = "^(f[a-z]+|[su]cvtf)$"
    arm32 = "^(v[a-z]+)\\.(f(16|32|64)|[su]32\\.f(32|64))"
  }
  /file format/ { arm = $0 ~ /aarch64|littlearm|elf32-arm/; old = $0 ~ /littlearm|elf32-arm/ }
  /^[0-9a-f]+ <.*>:$/ {
    name = $0
    sub(/^[0-9a-f]+ </, "", name)
    sub(/>:$/, "", name)
    inside = 0
    for (i = 1; i <= count; ++i) if (symbols[i] != "" && index(name, symbols[i]) == 1) { inside = 1; seen[i] = 1 }
    next
  }
  inside && NF >= 2 {
    op = $2
    bad = old ? op ~ arm32 : arm ? (op ~ arm64 && op != "fmov") : op ~ x86
    ++instructions
    if (bad) { print "floating point: " op " in " name; failed = 1 }
  }
  END {
    for (i = 1; i <= count; ++i) if (symbols[i] != "" && !seen[i]) { print "no function " symbols[i]; failed = 1 }
    if (instructions == 0) { print "nothing was looked at"; failed = 1 }
    if (!failed) print instructions " instructions without floating point"
    exit failed
  }'
