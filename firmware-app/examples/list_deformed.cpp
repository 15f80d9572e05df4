// Lists the points that moved more than a threshold: list_deformed MILLIMETRES [URL] [PREFIX]
// Compiled like follow_pose.cpp.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <string>

#include "pliant/deformed_t.hpp"

namespace {

struct Lister {
  double threshold = 0;  // metres

  // Each part of a frame's points can be used by itself.
  void deformed(const lcm::ReceiveBuffer*, const std::string&, const pliant::deformed_t* m) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(m->num_points); ++i) {
      const auto& d = m->displacement[i];
      const double length =
          std::hypot(static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2]));
      if (length <= threshold) continue;
      const auto& p = m->position[i];
      std::printf("%lld %d %.2f  %.6f %.6f %.6f\n", static_cast<long long>(m->frame), m->index[i],
                  1000 * length, static_cast<double>(p[0]), static_cast<double>(p[1]),
                  static_cast<double>(p[2]));
    }
    std::fflush(stdout);
  }
};

int list(double millimetres, const std::string& url, const std::string& prefix) {
  lcm::LCM bus(url);
  if (!bus.good()) return 3;
  Lister lister{millimetres / 1000};
  bus.subscribe(prefix + "_DEFORMED", &Lister::deformed, &lister);
  while (bus.handle() == 0) {
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "list_deformed MILLIMETRES [URL] [PREFIX]\n");
    return 2;
  }
  try {
    return list(std::strtod(argv[1], nullptr), argc > 2 ? argv[2] : "", argc > 3 ? argv[3] : "PLIANT");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "list_deformed: %s\n", error.what());
    return 3;
  }
}
