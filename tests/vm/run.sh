#!/bin/bash
# tests/vm/run.sh ARCH BUILD [FILTER]: what needs a kernel, in a virtual machine of the architecture ARCH (amd64, arm64).
#
# A guest with Debian's own kernel runs guest_tests of the build folder BUILD (all, or those that GoogleTest's FILTER
# names): depth cameras made of software, plugged into the guest's kernel, through the real uvcvideo, v4l2loopback and
# PS1080 drivers. Needs no hardware, no root and no KVM. Keeps the guest's console in build/vm/ARCH/console.log.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
most_seconds=420
arch=$1 build=$(cd "$2" && pwd) filter=${3:-'*'}
folder=$PWD/build/vm/$arch
console=$folder/console.log

die() { printf 'vm: %s; the console is in %s\n' "$*" "${console#"$PWD"/}" >&2; exit 1; }

mkdir -p "$folder"
begin=$SECONDS
version=$(tests/vm/kernel.sh "$arch" "$folder/kernel")
system=/
if [ "$arch" != "$(dpkg --print-architecture)" ]; then
  system=$folder/system
  toolchains/make_sysroot.sh "$arch" "$system" busybox-static udev
fi
tests/vm/guest_root.sh "$arch" "$folder/kernel" "$build" "$system" "$folder/root" "$folder/root.cpio"
printf 'Linux %s and a root of %d MB made in %d s; booting\n' "$version" \
  $(($(stat -c %s "$folder/root.cpio") / 1000000)) $((SECONDS - begin))

case $arch in
  # A processor without AVX: emulated, its wide instructions take longer than the narrow ones.
  amd64) machine=(qemu-system-x86_64 -cpu Nehalem -accel tcg,thread=multi) line=ttyS0 ;;
  # Its clock counts what its processors execute, 2 ns an instruction, and leaps over idleness: other work on this
  # machine makes the run longer and changes nothing in it. The other's kernel does not boot so.
  arm64) machine=(qemu-system-aarch64 -machine virt -cpu cortex-a72 -icount "shift=1,sleep=off") line=ttyAMA0 ;;
esac
rm -f "$console"
status=0
timeout --kill-after=5 "$most_seconds" "${machine[@]}" -smp 2 -m 1024 \
  -kernel "$folder/kernel/boot/vmlinuz-$version" -initrd "$folder/root.cpio" \
  -append "console=$line quiet loglevel=0 panic=-1 mitigations=off tests=$filter" \
  -display none -monitor none -serial "file:$console" -no-reboot -nic none </dev/null 2>"$folder/qemu.log" || status=$?

grep -aE '^(guest: |\[ +(OK|FAILED|SKIPPED|PASSED|  )* +\])' "$console" | tr -d '\r' || true
if grep -aq '^guest: the tests ended with 0 ' "$console" && ! grep -aq '^guest: the module' "$console"; then
  echo "vm: passed in $((SECONDS - begin)) s"
  exit 0
fi
# The first complaint of the first test that failed, in one line.
complaint=$(tr -d '\r' <"$console" | awk '
  /^guest: the module/ { print; exit }
  /^\[ RUN / { test = $4; text = ""; next }
  /: Failure$/ && text == "" { text = " "; collecting = 1; next }
  /^\[  FAILED  \]/ && test != "" { print test " failed:" text; exit }
  collecting && /^$/ { collecting = 0 }
  collecting { gsub(/^ +/, ""); text = text " " $0 }')
crashed=$(tr -d '\r' <"$console" | awk '/^\[ RUN / { test = $4 } /^guest: the tests ended with 1[0-9][0-9] / { print test }')
[ -n "$complaint" ] || [ -z "$crashed" ] || complaint="$crashed ended the program: $(grep -am1 segfault "$console" | tr -d '\r')"
if [ -n "$complaint" ]; then die "${complaint:0:400}"; fi
if grep -aq 'Kernel panic' "$console"; then die "the guest's kernel panicked: $(grep -am1 'Kernel panic' "$console" | tr -d '\r')"; fi
if [ "$status" -eq 124 ] || [ "$status" -eq 137 ]; then
  last=$(grep -av '^\s*$' "$console" 2>/dev/null | tail -1 | tr -d '\r' || true)
  die "the guest did not end within $most_seconds s; the last that it said: ${last:-nothing}"
fi
[ -s "$console" ] || die "the guest did not start: $(head -1 "$folder/qemu.log")"
die "the guest ended without a result (qemu: $status $(head -1 "$folder/qemu.log"))"
