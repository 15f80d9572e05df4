#include "core/registration/scene_examination.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

// An object seen from one side or among clutter stays between these; a wrong unit (mm for m) does not.
constexpr double kLeastRatio = 0.1, kMostRatio = 60;

}  // namespace

RegistrationOutcome examine(RegistrationState& s, std::span<const Point3f> scene) noexcept {
  if (scene.size() > s.base.size()) return RegistrationOutcome::too_many_points;
  // Extent: from the 2nd to the 98th hundredth of each coordinate, so that strays do not count.
  double square = 0, flattest = 1e300;
  std::size_t finite = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t count = 0;
    for (const Point3f& p : scene) {
      const float sum = p.x - p.x + (p.y - p.y) + (p.z - p.z);
      if (sum == 0) s.scratch[count++] = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    }
    finite = count;
    if (count == 0) return RegistrationOutcome::no_points;
    float* first = s.scratch.data();
    float* last = first + count;
    float* low = first + count / 50;
    float* high = first + (count - 1 - count / 50);
    std::nth_element(first, low, last);
    const double a = static_cast<double>(*low);
    std::nth_element(first, high, last);
    const double extent = static_cast<double>(*high) - a;
    square += extent * extent;
    flattest = std::min(flattest, extent);
  }
  if (finite < ShotDescriber::kLeastNeighbours) return RegistrationOutcome::too_few_points;
  const ModelHeader& h = s.model.header();
  double model_square = 0;
  for (int axis = 0; axis < 3; ++axis)
    model_square += (h.highest[axis] - h.lowest[axis]) * (h.highest[axis] - h.lowest[axis]);
  s.result.size_ratio = std::sqrt(square / model_square);
  if (square == 0) return RegistrationOutcome::flat;
  if (s.result.size_ratio < kLeastRatio || s.result.size_ratio > kMostRatio)
    return RegistrationOutcome::wrong_size;
  return RegistrationOutcome::found;
}

const char* describe(RegistrationOutcome outcome) noexcept {
  switch (outcome) {
    case RegistrationOutcome::found:
      return "found";
    case RegistrationOutcome::not_found:
      return "the scene does not show the object, or not clearly";
    case RegistrationOutcome::no_points:
      return "the scene has no finite point";
    case RegistrationOutcome::too_few_points:
      return "the scene has too few points to describe any shape";
    case RegistrationOutcome::flat:
      return "the scene is flat: a plane, a line or a single point looks alike everywhere";
    case RegistrationOutcome::wrong_size:
      return "the scene's size does not fit the model's: are both in the same unit?";
    case RegistrationOutcome::too_many_points:
      return "the scene has more points than were planned for";
  }
  return "unknown";
}

}  // namespace pliant
