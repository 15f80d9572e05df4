// Keeps libPS1080 from crashing over a USB device that comes and goes at once.
#pragma once

namespace pliant {

/// OpenNI2's thread that hears of USB devices (XnLinuxUSB.cpp, xnUSBDeviceConnected) asks libudev for four
/// numbers of every device that comes, of whatever kind, and reads them even where there are none, because
/// the device has already gone: a loose cable would end the program. Whoever links this file gives the
/// program a udev_device_get_sysattr_value of its own, which goes before libudev's and says "0" there. To be
/// called before the library starts; does nothing else.
void guard_udev() noexcept;

}  // namespace pliant
