#!/bin/bash
# toolchains/packaging/dependencies.sh PROGRAM [SYSROOT]
# The packages that PROGRAM's shared libraries come from, as a Depends line, by the same rules as dpkg-shlibdeps
# (which knows only packages that are installed here): every library's package states in its "shlibs" file which
# package to depend on. SYSROOT is one that toolchains/make_sysroot.sh made; without it, this machine's packages.
set -euo pipefail
export LC_ALL=C
die() { printf 'dependencies: %s\n' "$*" >&2; exit 1; }
program=$1
if [ $# -ge 2 ]; then
  tables=("$2"/.shlibs/*.shlibs)
else
  # Those of this very architecture first: cross compilers bring the same names for others.
  tables=(/var/lib/dpkg/info/*:"$(dpkg --print-architecture)".shlibs /var/lib/dpkg/info/*.shlibs)
fi
[ -f "${tables[0]}" ] || die "no shlibs files: ${tables[0]}"
result=()
while read -r library; do
  # libfoo.so.5 or libfoo-5.so
  if [[ $library =~ ^(.+)\.so\.(.+)$ ]]; then
    name=${BASH_REMATCH[1]} version=${BASH_REMATCH[2]}
  elif [[ $library =~ ^(.+)-([0-9.]+)\.so$ ]]; then
    name=${BASH_REMATCH[1]} version=${BASH_REMATCH[2]}
  else
    die "a library with an unknown kind of name: $library"
  fi
  line=$(awk -v name="$name" -v version="$version" '$1 !~ /:$/ && $1 == name && $2 == version {
    $1 = $2 = ""; sub(/^ */, ""); print; exit }' "${tables[@]}")
  [ -n "$line" ] || die "no package tells that it has $library"
  result+=("$line")
done < <(objdump -p "$program" | awk '$1 == "NEEDED" { print $2 }' | grep -v '^ld-linux')
printf '%s\n' "${result[@]}" | sort -u | paste -sd, | sed 's/,/, /g'
