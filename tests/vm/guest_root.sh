#!/bin/bash
# tests/vm/guest_root.sh KERNEL BUILD ROOT ARCHIVE
#
# The guest's file system, in memory: busybox, udev, OpenNI2 with its drivers, the modules the tests need, and from the
# build folder BUILD the program and guest_tests at the very paths that they have here. KERNEL is kernel.sh's folder.
# ROOT is filled anew, ARCHIVE is what the kernel unpacks.
set -euo pipefail
kernel=$1 build=$2 root=$3 archive=$4
here=$(dirname "${BASH_SOURCE[0]}")
version=$(cat "$kernel/version")
programs=("$build/firmware-app/pliant" "$build/tests/vm/guest_tests")
modules=(uvcvideo vhci-hcd v4l2loopback)

rm -rf "$root"
mkdir -p "$root"/{dev,etc,guest,proc,run,sys,tmp,usr/bin,usr/sbin,usr/lib,usr/lib64}
for folder in bin sbin lib lib64; do ln -s "usr/$folder" "$root/$folder"; done
mkdir -p "$root/lib/udev/rules.d"

# copy FILE...: each to the same path, with the libraries that it needs.
copy() {
  local file
  for file in "$@"; do
    mkdir -p "$root$(dirname "$file")"
    cp -L "$file" "$root$file"
    ldd "$file" 2>/dev/null | grep -o '/[^ ]*' || true
  done | sort -u | while read -r file; do
    mkdir -p "$root$(dirname "$file")"
    cp -nL "$file" "$root$file"
  done
}
# OpenNI2 finds its drivers beside itself, and libusb's and others' files are loaded by name.
mapfile -t openni2 < <(dpkg -L libopenni2-0 | grep -E '/OpenNI2/Drivers/.*\.so|/OpenNI2/Drivers/.*\.ini|/etc/openni2/')
files=()
for file in "${openni2[@]}"; do [ ! -f "$file" ] || files+=("$file"); done
copy "${programs[@]}" "${files[@]}" /bin/busybox /bin/udevadm
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
"$build/firmware-app/pliant" record --source 'simulated:box?width=320&height=240&frames=60' -o "$root/guest/box" >/dev/null
"$build/firmware-app/pliant" model build simulated:box -o "$root/guest/box.model" >/dev/null
sed "s|@TESTS@|$build/tests/vm/guest_tests|" -i "$root/init"
(cd "$root" && find . -print0 | cpio --null --create --format=newc --quiet) >"$archive"
