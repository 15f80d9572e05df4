#include "drivers/usb/usb_devices.hpp"

#include <algorithm>
#include <array>

namespace pliant {

namespace {

using enum UsbAccess;

constexpr std::string_view kCore =
    "the Structure Core, like other cameras with this chip, needs its maker's own library; no free driver "
    "exists";
constexpr std::string_view kKinect =
    "needs the OpenNI2 driver of libfreenect (libFreenectDriver.so) beside the others";
constexpr std::string_view kAstra = "needs the maker's OpenNI2 driver (liborbbec.so) beside the others";

// Where the ids are from:
// - 1d27: OpenNI2, Source/Drivers/PS1080/Sensor/XnDeviceEnumeration.cpp, and Debian's 60-libopenni2-0.rules.
//   The Structure Sensor is sold with 0600, which Carmine 1.08 and Xtion Pro have too.
// - 2959: the maker of the Structure Core's chip (Inuitive NU3000); its product ids are not published.
// - 045e: usb.ids (2025.07.26) for the Kinects 02ae and 02bf; libfreenect2's 90-kinect2.rules for the others.
// - 8086: librealsense, src/ds/d400/d400-private.h and config/99-realsense-libusb.rules.
// - 2bc5: ros_astra_camera, 56-orbbec-usb.rules.
constexpr auto kKinds = std::to_array<UsbDeviceKind>({
    {0x1d27, 0x0600, "Structure Sensor or PrimeSense Carmine/Xtion", openni2, "structure_sensor.toml", ""},
    {0x1d27, 0x0601, "Asus Xtion Pro Live", openni2, "xtion_carmine.toml", ""},
    {0x1d27, 0x0609, "PrimeSense Carmine 1.09", openni2, "xtion_carmine.toml", ""},
    {0x1d27, 0x0500, "PrimeSense sensor (first generation)", openni2, "xtion_carmine.toml", ""},
    {0x1d27, 0xf9db, "PrimeSense sensor in its boot loader", unsupported, "",
     "plug it out and in again; it has not started"},
    {0x2959, kAnyProduct, "Structure Core (Inuitive)", unsupported, "", kCore},
    {0x045e, 0x02ae, "Kinect for Xbox 360 (camera)", openni2, "kinect_v1.toml", kKinect},
    {0x045e, 0x02bf, "Kinect for Windows (camera)", openni2, "kinect_v1.toml", kKinect},
    {0x045e, 0x02c4, "Kinect v2", unsupported, "", "needs libfreenect2, which Debian does not have", true},
    {0x045e, 0x02d8, "Kinect v2", unsupported, "", "needs libfreenect2, which Debian does not have", true},
    {0x8086, 0x0ad1, "RealSense D400", v4l2, "realsense_d415.toml", "", true},
    {0x8086, 0x0ad2, "RealSense D410", v4l2, "realsense_d415.toml", "", true},
    {0x8086, 0x0ad3, "RealSense D415", v4l2, "realsense_d415.toml", "", true},
    {0x8086, 0x0ad4, "RealSense D430", v4l2, "realsense_d435.toml", "", true},
    {0x8086, 0x0b07, "RealSense D435", v4l2, "realsense_d435.toml", "", true},
    {0x8086, 0x0b3a, "RealSense D435i", v4l2, "realsense_d435.toml", "", true},
    {0x8086, 0x0b5b, "RealSense D405", v4l2, "", "", true},
    {0x8086, 0x0b5c, "RealSense D455", v4l2, "realsense_d435.toml", "", true},
    {0x8086, 0x0aa5, "RealSense SR300", v4l2, "", "", true},
    {0x2bc5, 0x0401, "Orbbec Astra", openni2, "orbbec_astra.toml", kAstra},
    {0x2bc5, 0x0402, "Orbbec Astra S", openni2, "orbbec_astra.toml", kAstra},
    {0x2bc5, 0x0403, "Orbbec Astra Pro", openni2, "orbbec_astra.toml", kAstra},
    {0x2bc5, 0x0404, "Orbbec Astra Mini", openni2, "orbbec_astra.toml", kAstra},
    {0x2bc5, 0x0407, "Orbbec Astra Mini S", openni2, "orbbec_astra.toml", kAstra},
});

}  // namespace

std::span<const UsbDeviceKind> usb_device_kinds() {
  return kKinds;
}

const UsbDeviceKind* find_usb_device_kind(std::uint16_t vendor, std::uint16_t product) {
  const auto* found = std::find_if(kKinds.begin(), kKinds.end(), [=](const UsbDeviceKind& kind) {
    return kind.vendor == vendor && (kind.product == product || kind.product == kAnyProduct);
  });
  return found == kKinds.end() ? nullptr : found;
}

}  // namespace pliant
