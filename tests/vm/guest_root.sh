#!/bin/bash
# tests/vm/guest_root.sh ARCH KERNEL BUILD SYSTEM ROOT ARCHIVE
#
# The guest's file system, in memory: busybox, udev, OpenNI2 with its drivers, the modules the tests need, and from the
# build folder BUILD the program and guest_tests at the very paths that they have here. KERNEL is kernel.sh's folder;
# SYSTEM is the root of a system of the architecture ARCH, "/" for this machine's. ROOT is filled anew, ARCHIVE is what
# the kernel unpacks.
set -euo pipefail
arch=$1 kernel=$2 build=$3 system=${4%/} root=$5 archive=$6
here=$(dirname "${BASH_SOURCE[0]}")
version=$(cat "$kernel/version")
programs=("$build/firmware-app/pliant" "$build/tests/vm/guest_tests")
modules=(uvcvideo vhci-hcd v4l2loopback)
case $arch in
  amd64) triplet=x86_64-linux-gnu launch=() ;;
  arm64) triplet=aarch64-linux-gnu launch=(qemu-aarch64 -L "$system") ;;
esac

rm -rf "$root"
mkdir -p "$root"/{dev,etc,guest,proc,run,sys,tmp,usr/bin,usr/sbin,usr/lib,usr/lib64}
for folder in bin sbin lib lib64; do ln -s "usr/$folder" "$root/$folder"; done
mkdir -p "$root/lib/udev/rules.d"

# needs FILE: the libraries and the loader that it names, where SYSTEM has them.
needs() {
  local name folder
  { readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'
    readelf -l "$1" | sed -n 's/.*interpreter: \(.*\)\]/\1/p'; } 2>/dev/null | while read -r name; do
    for folder in "" "/lib/$triplet/" "/usr/lib/$triplet/"; do
      if [ -f "$system$folder$name" ]; then
        echo "$folder$name"
        break
      fi
    done
  done
}
# copy FROM FILE...: each FROM/FILE to ROOT/FILE, and what it needs from SYSTEM.
copy() {
  local from=$1 file needed
  shift
  for file in "$@"; do
    [ ! -e "$root$file" ] || continue
    mkdir -p "$root$(dirname "$file")"
    cp -L "$from$file" "$root$file"
    mapfile -t needed < <(needs "$from$file")
    copy "$system" "${needed[@]}"
  done
}
copy "" "${programs[@]}"
copy "$system" /bin/busybox /bin/udevadm
# OpenNI2 finds its drivers beside itself, and libusb's and others' files are loaded by name.
mapfile -t openni2 < <(cd "${system:-/}" && find "usr/lib/$triplet/OpenNI2/Drivers" etc/openni2 -type f -printf '/%p\n')
copy "$system" "${openni2[@]}"
ln -s udevadm "$root/bin/udevd"
cp "$here/../../config/60-pliant.rules" "$root/lib/udev/rules.d"
cp /etc/passwd /etc/group "$root/etc"
cp "$here/init.sh" "$root/init"
chmod +x "$root/init"

mkdir -p "$root/lib/modules/$version"
cp "$kernel/lib/modules/$version"/modules.{builtin,builtin.modinfo,order} "$root/lib/modules/$version"
for module in "${modules[@]}"; do modprobe -d "$kernel" -S "$version" --show-depends "$module"; done |
  sed -n 's/^insmod \([^ ]*\).*/\1/p' | sort -u | while read -r file; do
  mkdir -p "$root$(dirname "${file#"$kernel"}")"
  cp "$file" "$root${file#"$kernel"}"
done
depmod -b "$root" "$version"

# What the tests play: made here, where it takes no time.
"${launch[@]}" "$build/firmware-app/pliant" record --source 'simulated:box?width=320&height=240&frames=60' -o "$root/guest/box" >/dev/null
"${launch[@]}" "$build/firmware-app/pliant" model build simulated:box -o "$root/guest/box.model" >/dev/null
sed "s|@TESTS@|$build/tests/vm/guest_tests|" -i "$root/init"
(cd "$root" && find . -print0 | cpio --null --create --format=newc --quiet) >"$archive"
