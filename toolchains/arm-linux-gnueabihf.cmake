# 32-bit ARM with hardware floating point (ARMv7). NEON is asked for at run time.
set(CMAKE_SYSTEM_PROCESSOR arm)
set(PLIANT_TRIPLET arm-linux-gnueabihf)
set(PLIANT_QEMU qemu-arm)
include(${CMAKE_CURRENT_LIST_DIR}/cross_common.cmake)
