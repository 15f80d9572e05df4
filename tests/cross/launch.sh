# Sourced by the scripts beside it.

# launch PROGRAM BUILD: sets `runner`, which runs a program of that build's architecture here (foreign ones under
# qemu-user), and `kernels`, the names of its kernels.
launch() {
  local sysroot machine
  machine=$(od -An -tu2 -j18 -N2 "$1" | tr -d ' ')
  sysroot=$(sed -n 's/^PLIANT_SYSROOT:[A-Z]*=//p' "$2/CMakeCache.txt")
  case $machine in
    62) runner=(env) kernels=(scalar sse avx2 auto) ;;
    183) runner=(qemu-aarch64 -L "$sysroot") kernels=(scalar neon auto) ;;
    40) runner=(qemu-arm -L "$sysroot") kernels=(scalar neon auto) ;;
    *) die "$1 is of an unknown architecture" ;;
  esac
}
