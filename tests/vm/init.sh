#!/bin/busybox sh
# The guest's first and only program: makes a system of what guest_root.sh put together, runs the tests, ends.
/bin/busybox --install -s /bin
export PATH=/bin:/sbin HOME=/tmp
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
mount -t tmpfs tmp /tmp
mkdir -p /run/udev /dev/shm
echo "guest: kernel $(uname -r) on $(uname -m), up after $(cut -d' ' -f1 /proc/uptime) s"
# LCM stays inside.
ip link set lo up
ip link set lo multicast on
ip route add 224.0.0.0/4 dev lo
udevd --daemon
for module in "uvcvideo" "vhci-hcd" "v4l2loopback devices=1 video_nr=7"; do
  modprobe $module || echo "guest: the module ${module%% *} cannot be loaded"
done
@TESTS@ --gtest_color=no $(sed -n 's/.*tests=\([^ ]*\).*/--gtest_filter=\1/p' /proc/cmdline)
echo "guest: the tests ended with $? after $(cut -d' ' -f1 /proc/uptime) s"
dmesg | grep -iE 'usb|uvc|oops|bug:|segfault' | tail -40
poweroff -f
