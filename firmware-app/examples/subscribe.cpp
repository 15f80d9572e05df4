// Prints what a tracker publishes: subscribe [URL] [PREFIX]. It uses LCM's own C++ interface and the classes
// that lcm-gen makes of drivers/lcm/types, as any program outside this repository would. Compiled like
// follow_pose.cpp.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "bot_core/rigid_transform_t.hpp"
#include "pliant/deformed_t.hpp"
#include "pliant/regions_t.hpp"
#include "pliant/status_t.hpp"

namespace {

class Printer {
 public:
  void pose(const lcm::ReceiveBuffer*, const std::string&, const bot_core::rigid_transform_t* m) {
    std::printf("pose      x %+.4f  y %+.4f  z %+.4f m   quaternion %+.4f %+.4f %+.4f %+.4f\n", m->trans[0],
                m->trans[1], m->trans[2], m->quat[0], m->quat[1], m->quat[2], m->quat[3]);
  }
  void regions(const lcm::ReceiveBuffer*, const std::string&, const pliant::regions_t* m) {
    const char* state = m->state == pliant::regions_t::TRACKING ? "tracking"
                        : m->state == pliant::regions_t::LOST   ? "lost"
                                                                : "searching";
    std::printf("regions   frame %lld %s\n", static_cast<long long>(m->frame), state);
    for (const pliant::region_t& region : m->regions) {
      std::printf("            region %d: %d points, rms %.2f mm", int{region.id}, region.points,
                  1000.0 * static_cast<double>(region.rms));
      // Not a number for the base and where a region does not touch its parent.
      if (!std::isnan(region.joint[0])) {
        std::printf(", at %+.3f %+.3f %+.3f m", static_cast<double>(region.joint[0]),
                    static_cast<double>(region.joint[1]), static_cast<double>(region.joint[2]));
      }
      std::printf("\n");
    }
  }
  void deformed(const lcm::ReceiveBuffer*, const std::string&, const pliant::deformed_t* m) {
    const float most = m->strain.empty() ? 0 : *std::max_element(m->strain.begin(), m->strain.end());
    std::printf("deformed  %d of %d points, strained up to %.1f %%\n", m->num_points, m->num_deformed,
                100 * static_cast<double>(most));
  }
  void status(const lcm::ReceiveBuffer*, const std::string&, const pliant::status_t* m) {
    std::printf(
        "status    %.1f frames/s, latency %.1f ms, %lld tracked, %lld lost, %lld dropped, "
        "strain energy %.3f %s\n",
        static_cast<double>(m->rate), m->latency_median / 1000.0, static_cast<long long>(m->tracked),
        static_cast<long long>(m->lost), static_cast<long long>(m->dropped),
        static_cast<double>(m->strain_energy), m->last_error.c_str());
  }
};

int listen(const std::string& url, const std::string& prefix) {
  lcm::LCM bus(url);
  if (!bus.good()) return 3;
  Printer printer;
  bus.subscribe(prefix + "_POSE", &Printer::pose, &printer);
  bus.subscribe(prefix + "_REGIONS", &Printer::regions, &printer);
  bus.subscribe(prefix + "_DEFORMED", &Printer::deformed, &printer);
  bus.subscribe(prefix + "_STATUS", &Printer::status, &printer);
  while (bus.handle() == 0) std::fflush(stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // An empty URL: LCM_DEFAULT_URL, else traffic of this host.
    return listen(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : "PLIANT");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "subscribe: %s\n", error.what());
    return 3;
  }
}
