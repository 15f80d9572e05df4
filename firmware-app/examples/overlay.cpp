// Drives an overlay: draws the tracked points over a camera's picture, into an image file that is replaced
// with each frame. overlay OUT.ppm WIDTH HEIGHT FX FY CX CY [URL] [PREFIX]; the camera as `pliant record`
// writes it. Compiled like follow_pose.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <string>
#include <vector>

#include "pliant/deformed_t.hpp"
#include "pliant/model_t.hpp"
#include "pliant/regions_t.hpp"

namespace {

using Point = std::array<double, 3>;

/// R(quat) * p + trans.
Point move(const pliant::region_t& region, const Point& p) {
  const double w = region.quat[0], x = region.quat[1], y = region.quat[2], z = region.quat[3];
  return {(1 - 2 * (y * y + z * z)) * p[0] + 2 * (x * y - w * z) * p[1] + 2 * (x * z + w * y) * p[2] +
              region.trans[0],
          2 * (x * y + w * z) * p[0] + (1 - 2 * (x * x + z * z)) * p[1] + 2 * (y * z - w * x) * p[2] +
              region.trans[1],
          2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] + (1 - 2 * (x * x + y * y)) * p[2] +
              region.trans[2]};
}

class Overlay {
 public:
  Overlay(std::string file, int width, int height, const std::array<double, 4>& camera)
      : file_(std::move(file)), width_(width), height_(height), camera_(camera) {}

  /// The model comes in parts, again and again: each is kept.
  void model(const lcm::ReceiveBuffer*, const std::string&, const pliant::model_t* m) {
    rest_.resize(static_cast<std::size_t>(m->model_points));
    for (std::size_t i = 0; i < m->position.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        rest_[static_cast<std::size_t>(m->first_point) + i][k] =
            static_cast<double>(m->origin[k]) + static_cast<double>(m->step) * m->position[i][k];
  }

  /// Points of rigid regions lie where their region carries them.
  void regions(const lcm::ReceiveBuffer*, const std::string&, const pliant::regions_t* m) {
    if (m->first_point == 0) show();
    std::map<int, const pliant::region_t*> by_id;
    for (const pliant::region_t& region : m->regions) by_id[region.id] = &region;
    for (std::size_t i = 0; i < m->labels.size(); ++i) {
      const auto region = by_id.find(m->labels[i]);
      const std::size_t point = static_cast<std::size_t>(m->first_point) + i;
      if (region != by_id.end() && point < rest_.size())
        draw(move(*region->second, rest_[point]), region->first == 0 ? kBlue : kYellow);
    }
  }

  /// Deformed ones are sent with their positions.
  void deformed(const lcm::ReceiveBuffer*, const std::string&, const pliant::deformed_t* m) {
    for (const auto& p : m->position)
      draw({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}, kRed);
  }

 private:
  using Colour = std::array<unsigned char, 3>;
  static constexpr Colour kBlue = {0, 114, 178}, kYellow = {240, 228, 66}, kRed = {213, 94, 0};

  void draw(const Point& p, const Colour& colour) {
    if (!(p[2] > 0)) return;
    const int u = static_cast<int>(std::lround(camera_[0] * p[0] / p[2] + camera_[2]));
    const int v = static_cast<int>(std::lround(camera_[1] * p[1] / p[2] + camera_[3]));
    if (u < 0 || v < 0 || u >= width_ || v >= height_) return;
    const auto at =
        3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u));
    for (std::size_t k = 0; k < 3; ++k) picture_[at + k] = colour[k];
  }

  /// The frame that is done; the file is never seen half written.
  void show() {
    const std::string part = file_ + ".part";
    if (std::FILE* const out = std::fopen(part.c_str(), "wb"); out != nullptr) {
      std::fprintf(out, "P6 %d %d 255\n", width_, height_);
      std::fwrite(picture_.data(), 1, picture_.size(), out);
      if (std::fclose(out) == 0) std::rename(part.c_str(), file_.c_str());
    }
    std::fill(picture_.begin(), picture_.end(), static_cast<unsigned char>(0));
  }

  std::string file_;
  int width_, height_;
  std::array<double, 4> camera_;  // fx, fy, cx, cy
  std::vector<Point> rest_;
  std::vector<unsigned char> picture_ =
      std::vector<unsigned char>(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
};

int run(int argc, char** argv) {
  lcm::LCM bus(argc > 8 ? argv[8] : "");
  if (!bus.good()) return 3;
  const std::string prefix = argc > 9 ? argv[9] : "PLIANT";
  std::array<double, 4> camera{};
  for (std::size_t i = 0; i < 4; ++i) camera[i] = std::strtod(argv[4 + i], nullptr);
  Overlay overlay(argv[1], std::atoi(argv[2]), std::atoi(argv[3]), camera);
  bus.subscribe(prefix + "_MODEL", &Overlay::model, &overlay);
  bus.subscribe(prefix + "_REGIONS", &Overlay::regions, &overlay);
  bus.subscribe(prefix + "_DEFORMED", &Overlay::deformed, &overlay);
  while (bus.handle() == 0) {
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 8) {
    std::fprintf(stderr, "overlay OUT.ppm WIDTH HEIGHT FX FY CX CY [URL] [PREFIX]\n");
    return 2;
  }
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "overlay: %s\n", error.what());
    return 3;
  }
}
