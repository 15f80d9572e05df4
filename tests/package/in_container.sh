#!/bin/bash
# Run by service_test.sh as root in a booted container with pliant installed: the service under a real service manager.
set -euo pipefail
export LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin
config=/etc/pliant/pliant.toml

passed() { printf '  ok    %s\n' "$*"; }
journal() { journalctl --unit pliant --output cat --no-pager; }
die() {
  printf 'in_container: %s\n' "$*"
  systemctl status --no-pager pliant || true
  journal | tail -30
  exit 1
}
of() { systemctl show --property "$1" --value pliant; }
# within SECONDS COMMAND...: waits until it succeeds.
within() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.2
  done
}
says() { of StatusText | grep -q "$1"; }
told() { journal | grep -q "$1"; }
restarted() { [ "$(of NRestarts)" -ge "$1" ] && [ "$(of ActiveState)" = active ]; }
write_config() { printf '%s\n' "$@" >$config; }

systemctl enable --now --quiet pliant-multicast@lo || die "no way for multicast"
ip route get 239.255.76.67 | grep -q 'dev lo' && ip link show lo | grep -q MULTICAST || die "multicast does not go by lo"
passed "pliant-multicast@lo gives multicast its way"
cushion='source = "simulated:cushion?frames=1000000&width=320&height=240"'
write_config "$cushion" '[track]' 'budget_ms = 200' '[run]' 'priority = 50' 'lock_memory = true'

systemctl start pliant || die "systemctl start fails"
within 60 says tracking || die "no frame is tracked: $(of StatusText)"
pid=$(of MainPID)
passed "started and tracking: $(of StatusText | tr -s ' ')"

status=$(cat "/proc/$pid/status")
[ "$(stat -c %u "/proc/$pid")" -ge 61184 ] || die "its user is not a dynamic one"
grep -q '^CapEff:[[:space:]]*0*$' <<<"$status" && grep -q '^NoNewPrivs:[[:space:]]*1$' <<<"$status" || die "it has privileges"
grep -q "^Groups:.*\b$(getent group video | cut -d: -f3)\b" <<<"$status" || die "it is not in the group video"
passed "a user of its own, without privilege, in the group of the cameras"
if told 'no real-time priority'; then
  passed "real-time priority: this machine forbids it, and the journal says so"
else
  ps -L -o cls=,rtprio= -p "$pid" | grep -q '^ *FF *50$' || die "no thread has the real-time priority: $(ps -L -o cls,rtprio,comm -p "$pid")"
  passed "tracking has its real-time priority"
fi
grep -q '^VmLck:[[:space:]]*[1-9][0-9]\{3,\} kB' <<<"$status" || told 'memlock' || die "its memory is neither locked, nor is it said why not"
passed "memory: $(grep '^VmLck' <<<"$status" | tr -s '\t ' ' ')"

timeout 20 pliant snapshot -o /tmp/now.png >/dev/null || die "a subscriber hears nothing"
passed "a subscriber on the same host hears it"

write_config "$cushion" '[track]' 'budget_ms = 250'
systemctl reload pliant
within 10 told 'config read again: .*track.budget_ms' || die "a reload does not read the config"
write_config "$cushion" '[track]' 'budget = 1'
systemctl reload pliant
within 10 told 'the old config stays: .*pliant.toml:3:1.*budget_ms' || die "a wrong config is not refused by line and column"
within 10 says tracking && [ "$(of MainPID)" = "$pid" ] || die "it does not go on tracking after a reload"
passed "reloads a valid config, refuses a wrong one, and goes on"

write_config "$cushion" '[track]' 'budget_ms = 200'
kill -STOP "$pid"
within 40 restarted 1 || die "the watchdog does not restart a frozen program"
told 'Watchdog timeout' || die "it was not the watchdog"
[ "$(of MainPID)" != "$pid" ] || die "the frozen program is still there"
passed "frozen: restarted by the watchdog"
kill -SEGV "$(of MainPID)"
within 20 restarted 2 || die "a crash is not restarted"
passed "crashed: restarted"

for _ in 1 2 3 4 5 6; do systemctl restart pliant || die "not started again: $(of Result)"; done
passed "started again as often as one likes"

within 60 says tracking || die "no frame is tracked after the restart"
begin=$(date +%s%N)
systemctl stop pliant
took=$((($(date +%s%N) - begin) / 1000000))
# A second, and what the service manager itself takes on a busy machine.
[ "$(of Result)" = success ] && [ $took -lt 4000 ] || die "the end took $took ms: $(of Result)"
passed "stopped in $took ms: $(of Result)"

write_config 'source = "simulated:nothing"'
! systemctl start pliant 2>/dev/null || die "starts from a source that does not exist"
sleep 5
[ "$(of ActiveState)" = failed ] && [ "$(of NRestarts)" = 0 ] && [ "$(of ExecMainStatus)" = 2 ] || die "a wrong config is tried again"
passed "a config that cannot be used is not tried again"

# A camera that is plugged in hours later: tried until then, however often that is.
pliant model build simulated:box -o /etc/pliant/box.model >/dev/null
tries() { [ "$(of NRestarts)" -ge "$1" ]; }
for source in openni2: v4l2:/dev/video77; do
  write_config "source = \"$source\"" 'model = "box.model"' '[sensor]' 'description = "sensors/realsense_d435.toml"'
  systemctl start --no-block pliant
  within 60 tries 6 || die "gives up on $source after $(of NRestarts) restarts: $(of ActiveState) $(of Result)"
  systemctl stop pliant
done
passed "a camera that is not there yet is waited for: $(journal | grep -m1 '^pliant: openni2')"
rm /etc/pliant/box.model
