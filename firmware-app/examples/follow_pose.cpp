// Follows the object: prints where it is in each frame. follow_pose [URL] [PREFIX]
// Only LCM and the class that lcm-gen makes of rigid_transform_t.lcm are needed.
// Packages: g++, liblcm-dev, liblcm-bin.
//   lcm-gen --cpp --cpp-hpath out/cpp drivers/lcm/types/*.lcm
//   g++ -O2 -Iout/cpp firmware-app/examples/follow_pose.cpp -llcm -o out/follow_pose
#include <cstdio>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "bot_core/rigid_transform_t.hpp"

namespace {

struct Follower {
  void pose(const lcm::ReceiveBuffer*, const std::string&, const bot_core::rigid_transform_t* m) {
    // A point of the model is in the camera's frame at R(quat) * point + trans; metres.
    std::printf("%lld %.6f %.6f %.6f  %.6f %.6f %.6f %.6f\n", static_cast<long long>(m->utime), m->trans[0],
                m->trans[1], m->trans[2], m->quat[0], m->quat[1], m->quat[2], m->quat[3]);
    std::fflush(stdout);
  }
};

int follow(const std::string& url, const std::string& prefix) {
  lcm::LCM bus(url);
  if (!bus.good()) return 3;
  Follower follower;
  bus.subscribe(prefix + "_POSE", &Follower::pose, &follower);
  while (bus.handle() == 0) {
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return follow(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : "PLIANT");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "follow_pose: %s\n", error.what());
    return 3;
  }
}
