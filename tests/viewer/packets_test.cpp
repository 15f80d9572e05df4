// What browsers are told of a frame and of a status.
#include "firmware-app/viewer/packets.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

namespace pliant::viewer {
namespace {

nlohmann::json header_of(const Bytes& packet) {
  std::uint32_t length = 0;
  if (packet.size() < 8) return {};
  std::memcpy(&length, packet.data() + 4, sizeof(length));
  if (packet.size() - 8 < length) return {};
  return nlohmann::json::parse(packet.begin() + 8, packet.begin() + 8 + length);
}

TEST(ViewerPackets, TellWhereARegionHangsAndNothingOfTheBase) {
  ReceivedFrame frame;
  frame.state = TrackState::tracking;
  frame.regions.resize(2);
  frame.regions[1].id = 1;
  frame.regions[1].parent = 0;
  frame.regions[1].joint = Point3f{0.5F, -0.25F, 0.75F};
  const nlohmann::json header = header_of(frame_packet(frame));
  ASSERT_EQ(header["regions"].size(), 2U);
  EXPECT_TRUE(header["regions"][0].contains("joint"));
  EXPECT_TRUE(header["regions"][0]["joint"].is_null());
  EXPECT_EQ(header["regions"][1]["joint"], nlohmann::json({0.5, -0.25, 0.75}));
}

TEST(ViewerPackets, TellTheStrainEnergy) {
  StatusMessage status;
  status.strain_energy = 0.375F;
  EXPECT_EQ(header_of(status_packet(status))["strain_energy"], 0.375);
}

}  // namespace
}  // namespace pliant::viewer
