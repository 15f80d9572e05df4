// Scenes in which a piece of an object lies where matter cannot have taken it: torn off, repeated, mirrored.
// Whatever a chain of regions makes of such a piece is false.
#pragma once

#include <random>

#include "tests/accuracy/registration_runs.hpp"
#include "tests/accuracy/view_maker.hpp"

namespace pliant {

enum class TornKind { torn, repeated, mirrored };
inline constexpr const char* kTornNames[] = {"torn off", "repeated", "mirrored"};

/// Scene `seed` of an object: the object at a random pose without a limb, and the limb elsewhere.
inline std::vector<Point3f> torn_scene(const ModelView& model, TornKind kind, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto at = [&](std::size_t i) {
    const Point3f& p = model.positions()[i];
    return to_vector(p);
  };
  std::size_t tip = 0;
  do tip = random() % model.size();
  while ((at(tip) - model.centre()).norm() < 0.65 * model.radius());
  RigidTransform pose;
  pose.rotation = random_rotation(random);
  pose.translation = Vector3(0.2 * unit(random), 0.2 * unit(random), 0.9) - pose.rotation * model.centre();
  const Vector3 out = (at(tip) - model.centre()).normalized();
  // Elsewhere: turned by up to 50° about its tip and moved by a fifth to half of the radius.
  const auto elsewhere = [&] {
    RigidTransform moved;
    moved.rotation =
        rotation_from_small_vector(0.8 * Vector3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5));
    const Vector3 aside = Vector3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5).normalized();
    moved.translation = at(tip) - moved.rotation * at(tip) +
                        model.radius() * ((0.2 + 0.3 * unit(random)) * out + 0.15 * aside);
    return moved;
  };
  const RigidTransform one = elsewhere(), other = elsewhere();
  std::vector<Point3f> points;
  const double noise = 0.2 * model.spacing();
  const auto put = [&](const Vector3& p) {
    const Vector3 q = pose * p + noise * Vector3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    points.push_back(to_point(q));
  };
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Vector3 p = at(i);
    if ((p - at(tip)).norm() > 0.4 * model.radius()) {
      put(p);
      continue;
    }
    if (kind == TornKind::mirrored) {
      // On the other side of the object's middle plane across its first axis, and a little farther out.
      Vector3 mirrored = p + 0.15 * model.radius() * out;
      mirrored.x() = 2 * model.centre().x() - mirrored.x();
      put(mirrored);
      continue;
    }
    put(one * p);
    if (kind == TornKind::repeated) put(other * p);
  }
  return points;
}

struct TornResult {
  bool found = false;
  int regions = 0;  ///< beside the base
  double worst_tear =
      0;  ///< metres: of every region the least distance at its border with others, the largest
};

/// How far apart the two sides of each region's border come, where they stay nearest: measured on the result
/// alone.
inline TornResult register_torn(const ModelView& model, const std::vector<Point3f>& scene, bool constraints) {
  RegistrationSettings settings;
  settings.constraints = constraints;
  ReadyRegistration run(model, scene.size(), settings);
  TornResult out;
  if (run.fault != nullptr) return out;
  const RegistrationResult& result = run.registration.register_cloud(scene);
  out.found = !result.instances.empty();
  if (!out.found) return out;
  const InstanceResult& instance = result.instances[0];
  for (std::size_t r = 1; r < instance.regions.size(); ++r) {
    out.regions += instance.regions[r].points > 0 ? 1 : 0;
    double least = 1e9;
    for (std::size_t i = 0; i < model.size(); ++i) {
      if (instance.labels[i] != static_cast<std::int8_t>(r)) continue;
      const Point3f& p = model.positions()[i];
      const Vector3 x = to_vector(p);
      for (std::size_t k = 0; k < instance.regions.size(); ++k)
        if (k != r)
          least =
              std::min(least, (instance.regions[r].transform * x - instance.regions[k].transform * x).norm());
    }
    if (least < 1e9) out.worst_tear = std::max(out.worst_tear, least);  // else it lost all its points
  }
  return out;
}

}  // namespace pliant
