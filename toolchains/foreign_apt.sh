#!/bin/bash
# toolchains/foreign_apt.sh ARCH FOLDER COMMAND...
# Runs apt-get or apt-cache for another architecture (arm64, armhf), of this machine's release and from its mirror,
# as root or not. Lists, state and fetched packages are in FOLDER; the lists are fetched where a day has passed. The
# machine's own packages are not touched, and it needs no multiarch.
set -euo pipefail
export LC_ALL=C

die() { printf 'foreign_apt: %s\n' "$*" >&2; exit 1; }
[ $# -ge 3 ] || die "usage: toolchains/foreign_apt.sh arm64|armhf FOLDER apt-get|apt-cache ARGUMENT..."
arch=$1 command=$3
case $arch in arm64 | armhf) ;; *) die "unknown architecture '$arch'; arm64 and armhf are known" ;; esac
command -v apt-get >/dev/null || die "needs apt-get, on Debian 12"
mkdir -p "$2/lists/partial" "$2/cache/archives/partial"
folder=$(cd "$2" && pwd)
shift 3
: >>"$folder/status"

site=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
[ -n "$site" ] || die "apt knows no mirror; run apt-get update first"
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-bookworm}")
keys=/usr/share/keyrings/debian-archive-keyring.gpg
printf 'deb [arch=%s signed-by=%s] %s %s main\n' "$arch" "$keys" "$site" "$release" >"$folder/sources.list"
options=(-o "APT::Architecture=$arch" -o "APT::Architectures::=$arch" -o "Dir::State::lists=$folder/lists"
  -o "Dir::State::status=$folder/status" -o "Dir::Etc::sourcelist=$folder/sources.list"
  -o Dir::Etc::sourceparts=/dev/null -o "Dir::Cache=$folder/cache" -o Acquire::Languages=none
  -o APT::Install-Recommends=false -o Debug::NoLocking=1)
[ "$(id -u)" -ne 0 ] || options+=(-o APT::Sandbox::User=root)
if [ -z "$(find "$folder/updated" -mtime -1 2>/dev/null)" ]; then
  apt-get "${options[@]}" -qq update >&2 || die "the mirror $site has no packages for $arch"
  touch "$folder/updated"
fi
exec "$command" "${options[@]}" "$@"
