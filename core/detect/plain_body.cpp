#include "core/detect/plain_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/detect/fast_transform.hpp"
#include "core/detect/flat_faces.hpp"
#include "core/detect/quadric.hpp"

namespace pliant {

namespace {

constexpr std::size_t kFewest = 60;       // readings: six for each unknown of a quadric
constexpr std::size_t kFewestOfCap = 12;  // likewise, of a plane
constexpr double kNone = 1e9;             // there is no such body
constexpr float kNear = 0.05F;            // metres; nearer points have no pixel
// Of two fits to the same 150 readings that are equally good, noise makes one in a thousand half again as far
// (F distribution).
constexpr double kClearlyFarther = 1.5;

constexpr double kFlat = 0.25;     // of the noise: what a model's faces bulge by at the most, unseen
constexpr double kSmoothed = 0.5;  // of the noise, that the snapshot's smoothing leaves at the most
constexpr int kCapRounds = 4;      // of telling each reading cap or tube and fitting both anew

/// Mean squared distance from a plane, at first `cap`, and a quadric.
double capped_distance(std::span<const OrientedReading> readings, std::span<const float> limits, double unit,
                       FlatFaces cap) noexcept {
  std::array<bool, kMostPlainPoints> on_cap{};
  std::array<OrientedReading, kMostPlainPoints> of_cap;
  const auto limit = [&](std::size_t k) { return static_cast<double>(limits[k]) / unit; };
  for (std::size_t k = 0; k < readings.size(); ++k)
    on_cap[k] = cap.squared_distance(readings[k].point, 1) < limit(k) * limit(k);
  double sum = 0;
  for (int round = 0; round < kCapRounds; ++round) {
    QuadricFit tube;
    std::size_t caps = 0;
    for (std::size_t k = 0; k < readings.size(); ++k) {
      if (on_cap[k]) {
        of_cap[caps++] = readings[k];
      } else {
        tube.add(readings[k].point);
      }
    }
    if (caps < kFewestOfCap || readings.size() - caps < kFewest || !tube.solve()) return kNone;
    cap.fit_alone({of_cap.data(), caps});
    sum = 0;
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const double to_cap = cap.squared_distance(readings[k].point, limit(k)),
                   to_tube = tube.squared_distance(readings[k].point, limit(k));
      on_cap[k] = to_cap < to_tube;
      sum += std::min(to_cap, to_tube);
    }
  }
  return sum / static_cast<double>(readings.size());
}

}  // namespace

bool PlainBodyFit::quadric_is_nearer() const noexcept {
  return readings > 0 && model > kClearlyFarther * quadric;
}

bool PlainBodyFit::faces_are_nearer() const noexcept {
  return readings > 0 && model > kClearlyFarther * faces;
}

bool PlainBodyFit::pieces_explain() const noexcept {
  const double pieces = std::min(faces, capped);
  return readings > 0 && model > kClearlyFarther * pieces && pieces < kSmoothed * noise;
}

PlainBodyFit plain_body_fit(const ProbePoints& points, const DepthSnapshot& snapshot,
                            const RigidTransform& pose, std::size_t count, double tolerance,
                            double most) noexcept {
  // About the model's middle, in its radii.
  const Vector3 middle = pose * points.centre();
  const double unit = points.radius();
  const auto base = static_cast<float>(tolerance), widest = static_cast<float>(most);
  std::array<OrientedReading, kMostPlainPoints> readings, own;  // own: the model's points under the readings
  std::array<float, kMostPlainPoints> limits;
  std::size_t number = 0;
  PlainBodyFit fit;
  QuadricFit quadric;
  points.visit_facing(FastTransform(pose), std::min(count, kMostPlainPoints),
                      [&](const Point3f& p, const Point3f& normal, float facing) {
                        int u = 0, v = 0;
                        if (p.z < kNear || !snapshot.project(p, u, v) || snapshot.depth(u, v) == 0) return;
                        const float z = snapshot.vertex(u, v).z, sigma = sigma_at(snapshot.sensor(), p.z);
                        const float off = std::fabs(facing * (z - p.z) / p.z);
                        const float limit = std::min(base + 3 * sigma, widest);
                        if (off > limit) return;
                        // On the point's own line of sight, so that all distances are of one place.
                        const double scale = static_cast<double>(z / p.z);
                        const Vector3 reading = scale * to_vector(p);
                        const Normal16& n = snapshot.normal(u, v);
                        readings[number] = {(reading - middle) / unit, Vector3(n.x, n.y, n.z) / 16384.0};
                        own[number] = {(reading / scale - middle) / unit, to_vector(normal)};
                        limits[number] = limit;
                        quadric.add(readings[number++].point);
                        fit.model += static_cast<double>(off * off);
                        fit.noise += static_cast<double>(sigma * sigma);
                      });
  if (number < kFewest || !quadric.solve()) return {};
  FlatFaces faces;
  faces.start({readings.data(), number});
  fit.capped = kNone;
  for (std::size_t k = 0; k < faces.count(); ++k)
    fit.capped = std::min(fit.capped, capped_distance({readings.data(), number}, {limits.data(), number},
                                                      unit, faces.alone(k)));
  faces.fit({readings.data(), number});
  for (std::size_t k = 0; k < number; ++k) {
    const double limit = static_cast<double>(limits[k]) / unit;
    fit.quadric += quadric.squared_distance(readings[k].point, limit);
    fit.faces += faces.squared_distance(readings[k].point, limit);
  }
  // A model that has flat faces itself is no worse for them.
  FlatFaces of_model;
  of_model.start({own.data(), number});
  of_model.fit({own.data(), number});
  double bulge = 0;
  for (std::size_t k = 0; k < number; ++k) bulge += of_model.squared_distance(own[k].point, 1);
  const bool flat_itself = bulge * unit * unit < kFlat * kFlat * fit.noise;
  fit.readings = static_cast<int>(number);
  const auto share = 1.0 / static_cast<double>(number);
  fit.model *= share;
  fit.noise *= share;
  fit.quadric *= share * unit * unit;
  fit.faces *= share * unit * unit;
  fit.capped *= unit * unit;
  if (flat_itself) fit.faces = fit.capped = kNone;
  return fit;
}

}  // namespace pliant
