#!/bin/bash
# tests/service/verify_unit.sh SYSTEMD_ANALYZE UNIT PROGRAM
# systemd must have nothing to say of the unit, with PROGRAM where the unit names the installed one.
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
unit=$scratch/$(basename "$2")
sed "s,^ExecStart=/usr/bin/pliant,ExecStart=$3," "$2" >"$unit"
said=$("$1" verify --man=no "$unit" 2>&1) && [ -z "$said" ] || { printf 'verify: %s\n' "$said" >&2; exit 1; }
