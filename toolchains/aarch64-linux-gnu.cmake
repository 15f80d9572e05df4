# 64-bit ARM: Raspberry Pi 3 and later, Jetson.
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(PLIANT_TRIPLET aarch64-linux-gnu)
set(PLIANT_QEMU qemu-aarch64)
include(${CMAKE_CURRENT_LIST_DIR}/cross_common.cmake)
