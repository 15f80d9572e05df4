# shellcheck shell=bash
# Sourced by install_test.sh.

# let_kernel_run ARCH: whether the kernel runs programs of this architecture in any root. Where it does not yet, it is
# told how (as root, with Debian's qemu-user-static), until forget_programs is called.
told_kernel=
let_kernel_run() {
  local name folder=/proc/sys/fs/binfmt_misc
  [ "$1" != "$(dpkg --print-architecture)" ] || return 0
  case $1 in arm64) name=qemu-aarch64 ;; armhf) name=qemu-arm ;; *) return 1 ;; esac
  [ "$(id -u)" -eq 0 ] && [ -f "/usr/lib/binfmt.d/$name.conf" ] || return 1
  [ -e $folder/register ] || mount -t binfmt_misc none $folder 2>/dev/null || return 1
  [ ! -e "$folder/$name" ] || return 0
  cat "/usr/lib/binfmt.d/$name.conf" >$folder/register 2>/dev/null || return 1
  told_kernel=$folder/$name
}

forget_programs() { [ -z "$told_kernel" ] || echo -1 >"$told_kernel"; }
