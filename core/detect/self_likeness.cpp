#include "core/detect/self_likeness.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/fast_transform.hpp"

namespace pliant {

namespace {

constexpr std::size_t kSurface = 608;  // points that stand for the surface, as where poses are judged
constexpr float kAlike = 0.5F;         // cosine of normals that agree, as where poses are judged

}  // namespace

double self_likeness(const ModelView& model, const RigidTransform& motion, std::size_t count,
                     double tolerance) noexcept {
  const FastTransform moved(motion), still;
  const auto most = static_cast<float>(tolerance);
  count = std::min(count, model.size());
  const std::size_t surface = std::min(kSurface, model.size());
  std::size_t alike = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Point3f p = moved.point(model.positions()[i]), n = moved.direction(model.normals()[i]);
    std::size_t nearest = 0;
    float least = 1e30F;
    for (std::size_t k = 0; k < surface; ++k) {
      const Point3f& q = model.positions()[k];
      const Point3f gap = {q.x - p.x, q.y - p.y, q.z - p.z};
      const float square = dot(gap, gap);
      if (square < least) {
        least = square;
        nearest = k;
      }
    }
    const Point3f& q = model.positions()[nearest];
    const Point3f normal = still.direction(model.normals()[nearest]);
    const float off = std::fabs(dot(normal, {p.x - q.x, p.y - q.y, p.z - q.z}));
    alike += off <= most && dot(normal, n) > kAlike ? 1U : 0U;
  }
  return count > 0 ? static_cast<double>(alike) / static_cast<double>(count) : 0;
}

}  // namespace pliant
