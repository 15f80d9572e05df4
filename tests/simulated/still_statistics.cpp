#include "tests/simulated/still_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

namespace pliant {

namespace {

constexpr double kEighths = 8 * 42750.0;  ///< disparity in eighths is this by millimetres

struct Pixel {
  double mean = 0;    ///< millimetres, over the frames with a reading
  double share = 0;   ///< of frames with a reading
  double spread = 0;  ///< eighths
};

class Analysis {
 public:
  explicit Analysis(const StillScene& scene) : scene_(scene), pixels_(scene.frames[0].size()) {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      double sum = 0, count = 0, disparity = 0, squares = 0;
      for (const auto& frame : scene.frames) {
        if (frame[i] == 0) continue;
        const double e = kEighths / frame[i];
        sum += frame[i];
        disparity += e;
        squares += e * e;
        count += 1;
      }
      pixels_[i].share = count / static_cast<double>(scene.frames.size());
      if (count == 0) continue;
      pixels_[i].mean = sum / count;
      if (count > 1)
        pixels_[i].spread = std::sqrt(std::max(squares - disparity * disparity / count, 0.0) / (count - 1));
    }
  }

  /// Whether all of the pixels within `reach` have always a reading and lie within `range` millimetres.
  [[nodiscard]] bool smooth(int u, int v, int reach, double range) const {
    double low = 1e9;
    double high = 0;
    for (int y = v - reach; y <= v + reach; ++y)
      for (int x = u - reach; x <= u + reach; ++x) {
        if (!inside(x, y) || at(x, y).share < 1) return false;
        low = std::min(low, at(x, y).mean);
        high = std::max(high, at(x, y).mean);
      }
    return high - low < range;
  }
  /// Whether a jump of 40 mm or a pixel that never reads lies within `reach`.
  [[nodiscard]] bool edge(int u, int v, int reach) const {
    double low = 1e9;
    double high = 0;
    for (int y = v - reach; y <= v + reach; ++y)
      for (int x = u - reach; x <= u + reach; ++x) {
        if (!inside(x, y)) continue;
        if (at(x, y).share < 0.05) return true;
        low = std::min(low, at(x, y).mean);
        high = std::max(high, at(x, y).mean);
      }
    return high - low > 40;
  }
  [[nodiscard]] bool inside(int u, int v) const {
    return u >= 0 && v >= 0 && u < scene_.width && v < scene_.height;
  }
  [[nodiscard]] std::size_t place(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(scene_.width) + static_cast<std::size_t>(u);
  }
  [[nodiscard]] const Pixel& at(int u, int v) const { return pixels_[place(u, v)]; }
  /// Disparity of a reading off the pixel's mean, eighths.
  [[nodiscard]] double off(const std::vector<std::uint16_t>& frame, int u, int v) const {
    return kEighths / frame[place(u, v)] - kEighths / at(u, v).mean;
  }

 private:
  const StillScene& scene_;
  std::vector<Pixel> pixels_;
};

}  // namespace

StillStatistics statistics_of(const StillScene& scene) {
  StillStatistics result;
  std::set<int> values;
  for (const auto& frame : scene.frames)
    for (const std::uint16_t d : frame)
      if (d >= 700 && d < 760) values.insert(d);
  if (values.size() > 1)
    result.step =
        static_cast<double>(*values.rbegin() - *values.begin()) / static_cast<double>(values.size() - 1);

  const Analysis analysis(scene);
  std::vector<double> spreads;
  double own = 0, shared = 0, inside = 0, inside_read = 0, edges = 0, edges_read = 0, flying = 0;
  for (int v = 1; v + 1 < scene.height; ++v)
    for (int u = 1; u + 1 < scene.width; ++u) {
      const Pixel& p = analysis.at(u, v);
      if (p.mean < 400 || p.mean > 800 || p.share < 0.05) continue;
      if (analysis.edge(u, v, 1)) {
        edges += 1;
        edges_read += p.share;
        double far = 0;
        for (const auto& frame : scene.frames) {
          const std::uint16_t d = frame[analysis.place(u, v)];
          far += d > 0 && std::fabs(d - p.mean) > 10 ? 1 : 0;
        }
        flying += far / static_cast<double>(scene.frames.size());
      } else if (!analysis.edge(u, v, 6)) {
        inside += 1;
        inside_read += p.share;
      }
      if (p.mean < 450 || p.mean > 750 || !analysis.smooth(u, v, 4, 30)) continue;
      spreads.push_back(p.spread);
      for (const auto& frame : scene.frames) {
        own += analysis.off(frame, u, v) * analysis.off(frame, u, v);
        shared += analysis.off(frame, u, v) * analysis.off(frame, u + 1, v);
      }
    }
  if (!spreads.empty()) {
    std::nth_element(spreads.begin(), spreads.begin() + std::ssize(spreads) / 2, spreads.end());
    result.flicker = spreads[spreads.size() / 2];
    result.correlation = shared / own;
  }
  if (inside > 0) result.lost_inside = 1 - inside_read / inside;
  if (edges > 0) {
    result.lost_at_edges = 1 - edges_read / edges;
    result.flying_at_edges = flying / edges;
  }
  return result;
}

}  // namespace pliant
