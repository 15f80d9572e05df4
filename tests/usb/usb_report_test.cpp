// What is said of devices on the bus.
#include "drivers/usb/usb_report.hpp"
#include "drivers/usb/usb_place.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

namespace pliant {
namespace {

UsbDevice device(std::uint16_t vendor, std::uint16_t product, int megabits = 5000) {
  UsbDevice d;
  d.vendor = vendor;
  d.product = product;
  d.bus = 1;
  d.address = 5;
  d.port = "1-2";
  d.megabits = megabits;
  d.accessible = true;
  return d;
}

UsbFinding judge(const UsbDevice& device, const UsbServed& served = {}) {
  const auto findings = judge_usb_devices({&device, 1}, served);
  EXPECT_EQ(findings.size(), 1U);
  return findings.empty() ? UsbFinding{} : findings.front();
}

/// With one of its lists set.
template <typename List>
UsbServed served(List UsbServed::*list, List value) {
  UsbServed all;
  all.*list = std::move(value);
  return all;
}
UsbServed on_video(const char* bus) {
  return served(&UsbServed::video_buses, {bus});
}
UsbServed by_openni2() {
  return served(&UsbServed::by_openni2, {{0x1d27, 0x0600}});
}

TEST(UsbTable, HoldsEachDeviceOnceWithADescriptionThatExists) {
  std::set<std::pair<int, int>> seen;
  for (const UsbDeviceKind& kind : usb_device_kinds()) {
    EXPECT_TRUE(seen.emplace(kind.vendor, kind.product).second) << kind.name;
    EXPECT_FALSE(kind.name.empty());
    EXPECT_TRUE(kind.access != UsbAccess::unsupported || !kind.remark.empty()) << kind.name;
    const std::filesystem::path sensor =
        std::filesystem::path(PLIANT_CONFIG_FOLDER) / "sensors" / kind.sensor;
    EXPECT_TRUE(std::filesystem::exists(sensor)) << sensor;
  }
  EXPECT_EQ(find_usb_device_kind(0x1d27, 0x0600)->access, UsbAccess::openni2);
  EXPECT_EQ(find_usb_device_kind(0x1d6b, 0x0002), nullptr);
}

TEST(UdevRules, GiveEveryUsableDeviceToWhoSitsThereAndNothingElse) {
  std::ifstream file(std::filesystem::path(PLIANT_CONFIG_FOLDER) / "60-pliant.rules");
  ASSERT_TRUE(file);
  // A line of matches and assignments, as udev(7) says.
  const std::regex rule(R"re((([A-Z]+(\{[A-Za-z]+\})?(==|!=|\+=|=)"[^"]*")(, )?)+)re");
  std::set<std::string> given;
  bool labelled = false;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    EXPECT_TRUE(std::regex_match(line, rule)) << line;
    labelled = labelled || line == R"(LABEL="pliant_end")";
    if (line.find("uaccess") != std::string::npos) given.insert(line);
  }
  EXPECT_TRUE(labelled);
  std::set<std::string> wanted;
  for (const UsbDeviceKind& kind : usb_device_kinds())
    if (kind.access != UsbAccess::unsupported) wanted.insert(udev_rule(kind.vendor, kind.product));
  EXPECT_EQ(given, wanted);
}

TEST(UsbPlace, OfADeviceIsToldByBothDrivers) {
  UsbDevice sensor = device(0x1d27, 0x0600);
  EXPECT_TRUE(is_at_place(sensor, "1d27/0600@1/5"));
  EXPECT_FALSE(is_at_place(sensor, "1d27/0600@1/55"));
  EXPECT_FALSE(is_at_place(sensor, "1d27/0601@1/5"));
  EXPECT_FALSE(is_at_place(sensor, ""));
  UsbDevice camera = device(0x8086, 0x0b07);
  EXPECT_TRUE(is_at_place(camera, "usb-0000:00:14.0-2"));
  EXPECT_FALSE(is_at_place(camera, "usb-0000:00:14.0-1.2"));
  camera.port = "3-1.2";
  EXPECT_TRUE(is_at_place(camera, "usb-0000:00:14.0-1.2"));
  EXPECT_FALSE(is_at_place(camera, "usb-0000:00:14.0-2"));
  camera.classes = {3};  // a mouse
  EXPECT_FALSE(is_at_place(camera, "usb-0000:00:14.0-1.2"));
}

TEST(UsbPlace, IsOneDeviceOrNone) {
  std::vector<UsbDevice> devices(2, device(0x1d27, 0x0600));
  devices[1].address = 9;
  EXPECT_EQ(find_at_place(devices, "1d27/0600@1/9"), &devices[1]);
  EXPECT_EQ(find_at_place(devices, "1d27/0600@1/7"), nullptr) << "either may be meant";
  EXPECT_EQ(find_at_place(std::span(devices).first(1), "1d27/0600@1/7"), devices.data()) << "a new address";
  EXPECT_EQ(find_at_place(devices, "usb-0000:00:14.0-2"), nullptr) << "at two controllers";
  EXPECT_EQ(find_at_place(devices, ""), nullptr);
  EXPECT_EQ(find_at_place({}, "1d27/0600@1/9"), nullptr);
}

TEST(UsbPlace, WhatAProgramHasIsNotResetInTheNameOfAnother) {
  std::vector<UsbDevice> devices(2, device(0x1d27, 0x0600));
  devices[1].address = 9;
  devices[1].in_use = true;  // another tracker's
  EXPECT_EQ(find_idle_at_place(devices, "1d27/0600@1/5"), devices.data());
  const auto left = std::span(devices).last(1);  // ours was pulled out
  ASSERT_EQ(find_at_place(left, "1d27/0600@1/5"), &devices[1]);
  EXPECT_EQ(find_idle_at_place(left, "1d27/0600@1/5"), nullptr);
  devices[1].in_use = false;
  EXPECT_EQ(find_idle_at_place(left, "1d27/0600@1/5"), &devices[1]) << "ours, with a new address";
}

TEST(UsbReport, OtherDevicesAreNoConcernOfOurs) {
  const std::vector<UsbDevice> devices = {device(0x1d6b, 2), device(0x046d, 0xc52b)};
  EXPECT_TRUE(judge_usb_devices(devices, {}).empty());
}

TEST(UsbReport, AUsableDeviceHasNoTrouble) {
  EXPECT_EQ(judge(device(0x1d27, 0x0600, 480), by_openni2()).trouble, UsbTrouble::none);
  EXPECT_EQ(judge(device(0x8086, 0x0b07), on_video("usb-0000:00:14.0-2")).trouble, UsbTrouble::none);
  // Another program's use of the colour node is no hindrance; another camera's neither.
  UsbServed both = on_video("usb-0000:00:14.0-2");
  both.busy_buses = {"usb-0000:00:14.0-3"};
  EXPECT_EQ(judge(device(0x8086, 0x0b07), both).trouble, UsbTrouble::none);
}

TEST(UsbReport, WhatOpenNi2ListsMayStillBeOutOfReach) {
  UsbDevice sensor = device(0x1d27, 0x0600, 480);
  EXPECT_EQ(hindrance_of(sensor).trouble, UsbTrouble::none);
  EXPECT_EQ(hindrance_of(sensor).reason, "");
  sensor.accessible = false;
  EXPECT_EQ(hindrance_of(sensor).trouble, UsbTrouble::no_permission);
  EXPECT_NE(hindrance_of(sensor).reason.find("/dev/bus/usb/001/005"), std::string::npos);
  sensor.accessible = true;
  sensor.in_use = true;
  EXPECT_EQ(hindrance_of(sensor).trouble, UsbTrouble::busy);
  EXPECT_NE(hindrance_of(sensor).reason.find("fuser /dev/bus/usb/001/005"), std::string::npos);
}

TEST(UsbReport, EachTroubleIsToldWithItsMend) {
  UsbDevice sensor = device(0x1d27, 0x0600, 480);
  sensor.accessible = false;
  UsbFinding finding = judge(sensor);
  EXPECT_EQ(finding.trouble, UsbTrouble::no_permission);
  EXPECT_NE(finding.reason.find("/dev/bus/usb/001/005"), std::string::npos);
  // Who comes over ssh sits nowhere: the group counts for him.
  EXPECT_NE(
      finding.reason.find(
          R"(ATTR{idVendor}=="1d27", ATTR{idProduct}=="0600", TAG+="uaccess", GROUP="video", MODE="0660")"),
      std::string::npos)
      << finding.reason;
  EXPECT_NE(finding.reason.find("adduser $USER video"), std::string::npos) << finding.reason;

  finding = judge(device(0x1d27, 0x0600, 480));
  EXPECT_EQ(finding.trouble, UsbTrouble::no_driver);
  EXPECT_NE(finding.reason.find("libopenni2-0"), std::string::npos);

  finding = judge(device(0x045e, 0x02ae, 480));
  EXPECT_EQ(finding.trouble, UsbTrouble::no_driver);
  EXPECT_NE(finding.reason.find("libfreenect"), std::string::npos);

  finding = judge(device(0x8086, 0x0b07, 480));
  EXPECT_EQ(finding.trouble, UsbTrouble::wrong_mode);
  EXPECT_NE(finding.reason.find("USB 3"), std::string::npos);

  finding = judge(device(0x8086, 0x0b07), on_video("usb-0000:00:14.0-3"));
  EXPECT_EQ(finding.trouble, UsbTrouble::no_driver);
  EXPECT_NE(finding.reason.find("uvcvideo"), std::string::npos);

  finding = judge(device(0x8086, 0x0b07), served(&UsbServed::busy_buses, {"usb-0000:00:14.0-2"}));
  EXPECT_EQ(finding.trouble, UsbTrouble::busy);

  // A node that this user may not open is no proof that there is none.
  finding = judge(device(0x8086, 0x0b07),
                  served(&UsbServed::hidden_node, std::string("/dev/video0: Permission denied")));
  EXPECT_EQ(finding.trouble, UsbTrouble::no_permission);
  EXPECT_NE(finding.reason.find("/dev/video0: Permission denied"), std::string::npos);

  sensor = device(0x1d27, 0x0600, 480);
  sensor.in_use = true;
  finding = judge(sensor, by_openni2());
  EXPECT_EQ(finding.trouble, UsbTrouble::busy);
  EXPECT_NE(finding.reason.find("fuser /dev/bus/usb/001/005"), std::string::npos) << finding.reason;

  finding = judge(device(0x2959, 0x1234));
  EXPECT_EQ(finding.trouble, UsbTrouble::unsupported);
  EXPECT_NE(finding.reason.find("Structure Core"), std::string::npos);
}

}  // namespace
}  // namespace pliant
