#!/bin/bash
# tests/package/service_test.sh ROOT
# Boots ROOT, a Debian root in which pliant and systemd are installed, as a container (systemd-nspawn, as root), and
# has in_container.sh use the service there as an administrator does.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
die() { printf 'service_test: %s\n' "$*" >&2; exit 1; }
[ $# -eq 1 ] && [ -x "$1/usr/bin/pliant" ] || die "usage: tests/package/service_test.sh ROOT, with pliant installed in it"
root=$(cd "$1" && pwd)
most_seconds=300

cp "$root/etc/pliant/pliant.toml" "$root/root/pliant.toml"
cp "$here/in_container.sh" "$root/root/in_container.sh"
rm -f "$root/root/result"
cat >"$root/etc/systemd/system/in-container.service" <<'END'
[Unit]
After=multi-user.target
[Service]
Type=oneshot
ExecStart=/bin/bash -c '/bin/bash /root/in_container.sh >/root/result 2>&1; echo "ended with $?" >>/root/result'
ExecStopPost=/bin/systemctl poweroff --no-block
[Install]
WantedBy=multi-user.target
END
mkdir -p "$root/etc/systemd/system/multi-user.target.wants"
ln -sf ../in-container.service "$root/etc/systemd/system/multi-user.target.wants/in-container.service"

# It wants a terminal; the network is one of its own, with a loopback only.
boot="systemd-nspawn --quiet --directory '$root' --boot --register=no --keep-unit --private-network --capability=all"
boot+=" --system-call-filter=@memlock --rlimit=MEMLOCK=infinity --rlimit=RTPRIO=99"
timeout --kill-after=5 "$most_seconds" script -qec "$boot" "$root/root/console" </dev/null >/dev/null 2>&1 || true

rm -f "$root"/etc/systemd/system/{,multi-user.target.wants/}in-container.service
mv "$root/root/pliant.toml" "$root/etc/pliant/pliant.toml"
[ -s "$root/root/result" ] || { tail -5 "$root/root/console" >&2; die "the container did not boot"; }
sed '/^ended with /d' "$root/root/result"
grep -q '^ended with 0$' "$root/root/result" || die "the service does not behave"
