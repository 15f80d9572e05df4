#include "drivers/model_files/neighbour_graph.hpp"

#include "core/model/model_view.hpp"
#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;

TEST(NeighbourGraph, NearestFirstAndNeverItself) {
  const Made made = make(shapes::cushion_with_knob());
  const ModelView& m = made.view();
  for (std::size_t i = 0; i < m.size(); ++i) {
    double before = 0;
    bool ended = false;
    for (const std::uint16_t n : m.neighbours(i)) {
      ended = ended || n == kNoNeighbour;
      EXPECT_EQ(ended, n == kNoNeighbour);
      if (ended) continue;
      EXPECT_NE(n, i);
      const double distance = (to_vector(m.positions()[i]) - to_vector(m.positions()[n])).norm();
      EXPECT_GE(distance, before * (1 - 1e-6));
      before = distance;
    }
    EXPECT_NE(m.neighbours(i)[3], kNoNeighbour);
  }
}

TEST(NeighbourGraph, DoesNotJoinTheSidesOfAThinPlate) {
  const Made made = make(shapes::thin_plate(0.2, 0.001, 60));  // three times thinner than the spacing
  const ModelView& m = made.view();
  for (std::size_t i = 0; i < m.size(); ++i)
    for (const std::uint16_t n : m.neighbours(i))
      if (n != kNoNeighbour) {
        EXPECT_EQ(m.positions()[i].z, m.positions()[n].z);
      }
}

/// Points that can be reached from the first.
std::size_t reached(const ModelView& m) {
  std::vector<bool> seen(m.size(), false);
  std::vector<std::size_t> open = {0};
  seen[0] = true;
  for (std::size_t k = 0; k < open.size(); ++k)
    for (const std::uint16_t n : m.neighbours(open[k]))
      if (n != kNoNeighbour && !seen[n]) {
        seen[n] = true;
        open.push_back(n);
      }
  return open.size();
}

TEST(NeighbourGraph, JoinsASurfaceOverItsEdgesButNotOverGaps) {
  const Made box = make(shapes::box(0.07, 0.09, 0.2));
  EXPECT_EQ(reached(box.view()), box.view().size());
  Geometry other = shapes::sphere(0.1, 50);
  for (Point3f& p : other.vertices) p.x += 0.3F;
  const Made two = make(shapes::joined(shapes::sphere(0.1, 50), other));
  EXPECT_NEAR(static_cast<double>(reached(two.view())), 0.5 * static_cast<double>(two.view().size()), 1);
}

}  // namespace
}  // namespace pliant
