#!/bin/bash
# in_own_network.sh COMMAND...: runs it in a network of its own whose loopback carries multicast; exit code 77 where
# none is permitted. Nothing that runs there can reach any other machine.
set -e
if [ "${PLIANT_TEST_NETWORK:-}" = own ]; then
  ip link set lo up
  ip link set lo multicast on
  ip route add 224.0.0.0/4 dev lo
  exec "$@"
fi
options=(--net)
[ "$(id -u)" -eq 0 ] || options=(--user --map-root-user --net)
unshare "${options[@]}" ip link set lo up 2>/dev/null || { echo "no network of its own is permitted here"; exit 77; }
PLIANT_TEST_NETWORK=own exec unshare "${options[@]}" "$0" "$@"
