#include "firmware-app/pictures/scene_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/track_result.hpp"
#include "firmware-app/pictures/displacement_colours.hpp"

namespace pliant {

namespace {

constexpr RegionColour kWhite{255, 255, 255}, kBlack{0, 0, 0};
constexpr int kRow = 22, kLeft = 10, kTop = 10, kIndent = 24;

/// Near bright, far dark, no reading black, between the nearest and the farthest readings of the picture but
/// for a few per cent.
void draw_depth(std::span<const std::uint16_t> depth, Canvas& canvas) {
  std::vector<std::uint16_t> readings;
  for (const std::uint16_t d : depth)
    if (d != 0) readings.push_back(d);
  if (readings.empty()) return;
  std::sort(readings.begin(), readings.end());
  const double near = readings[readings.size() / 50],
               far = readings[readings.size() - 1 - readings.size() / 20];
  const double span = std::max(far - near, 1.0);
  std::size_t i = 0;
  for (int v = 0; v < canvas.height(); ++v)
    for (int u = 0; u < canvas.width(); ++u, ++i) {
      if (depth[i] == 0) continue;
      const double grey = 60 + 180 * std::clamp((far - depth[i]) / span, 0.0, 1.0);
      const auto level = static_cast<std::uint8_t>(grey);
      canvas.set(u, v, {level, level, level});
    }
}

struct Pixel {
  double u = 0, v = 0;
};

Pixel project(const Intrinsics& camera, const Vector3& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

void draw_points(const SceneView& view, double most, Canvas& canvas) {
  std::vector<std::size_t> order(view.positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // From far to near; deformed points lie on top of their neighbours.
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const bool a_deformed = view.labels[a] == kDeformed, b_deformed = view.labels[b] == kDeformed;
    if (a_deformed != b_deformed) return b_deformed;
    return view.positions[a].z > view.positions[b].z;
  });
  for (const std::size_t i : order) {
    const Point3f& p = view.positions[i];
    if (view.labels[i] == kNotObserved || !(p.z > 0)) continue;
    const auto z = static_cast<double>(p.z);
    const Pixel at = project(view.camera, {static_cast<double>(p.x), static_cast<double>(p.y), z});
    const RegionColour colour = view.labels[i] == kDeformed && i < view.displacement.size()
                                    ? displacement_colour(static_cast<double>(view.displacement[i]), most)
                                    : region_colour(view.labels[i]);
    canvas.disc(at.u, at.v, std::clamp(0.35 * view.spacing * view.camera.fx / z, 1.0, 20.0), colour, 0.8);
  }
}

/// x red, y green, z blue; the base's are longer.
void draw_axes(const SceneView& view, Canvas& canvas) {
  constexpr std::array<RegionColour, 3> kAxes = {{{230, 40, 40}, {40, 180, 60}, {60, 110, 255}}};
  double length = 8 * view.spacing;
  for (const RigidTransform& frame : view.axes) {
    if (!(frame.translation.z() > 0)) continue;
    const Pixel origin = project(view.camera, frame.translation);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 tip = frame.translation + length * frame.rotation.col(axis);
      if (!(tip.z() > 0)) continue;
      const Pixel end = project(view.camera, tip);
      canvas.line(origin.u, origin.v, end.u, end.v, kAxes[static_cast<std::size_t>(axis)]);
    }
    length = 5 * view.spacing;
  }
}

struct KeyRow {
  std::string words;
  int label = kNotObserved;  ///< not observed: without a colour, since such points are not drawn
};

void draw_key(const SceneView& view, double most, Canvas& canvas) {
  std::array<int, 256> count{};
  for (const std::int8_t label : view.labels) ++count[static_cast<std::size_t>(label + 128)];
  std::vector<KeyRow> rows;
  // The base first, what is not observed last.
  const auto add = [&](int label) {
    const int n = count[static_cast<std::size_t>(label + 128)];
    if (n == 0) return;
    rows.push_back({fmt::format("{}: {} {}{}", region_word(label), n, n == 1 ? "point" : "points",
                                label == kNotObserved ? ", not drawn" : ""),
                    label});
  };
  for (int label = 0; label < 128; ++label) add(label);
  for (int label = -1; label >= kNotObserved; --label) add(label);
  const bool scale = count[static_cast<std::size_t>(kDeformed + 128)] > 0;
  const std::string scale_words = fmt::format("0 to {:g} mm", 1000 * most);
  constexpr int kBar = 90;
  int width = Canvas::text_width(view.title);
  for (const KeyRow& row : rows) width = std::max(width, kIndent + Canvas::text_width(row.words));
  if (scale) width = std::max(width, kIndent + kBar + 8 + Canvas::text_width(scale_words));
  const int lines = static_cast<int>(rows.size()) + (scale ? 2 : 1);
  canvas.box(kLeft - 6, kTop - 6, width + 12, lines * kRow + 4, kBlack, 0.65);
  canvas.text(kLeft, kTop, view.title, kWhite);
  int v = kTop;
  for (const KeyRow& row : rows) {
    v += kRow;
    if (row.label == kDeformed) {
      canvas.box(kLeft, v, 16, 14, displacement_colour(0.5, 1));
    } else if (row.label != kNotObserved) {
      canvas.box(kLeft, v, 16, 14, region_colour(row.label));
    }
    canvas.text(kLeft + kIndent, v, row.words, kWhite);
  }
  if (!scale) return;
  v += kRow;
  for (int u = 0; u < kBar; ++u) canvas.box(kLeft + kIndent + u, v, 1, 14, displacement_colour(u, kBar));
  canvas.text(kLeft + kIndent + kBar + 8, v, scale_words, kWhite);
}

void draw_notes(const std::vector<std::string>& notes, Canvas& canvas) {
  int v = canvas.height() - static_cast<int>(notes.size()) * kRow - 4;
  int width = 0;
  for (const std::string& note : notes) width = std::max(width, Canvas::text_width(note));
  if (!notes.empty()) canvas.box(kLeft - 6, v - 6, width + 12, canvas.height() - v, kBlack, 0.65);
  for (const std::string& note : notes) {
    canvas.text(kLeft, v, note, kWhite);
    v += kRow;
  }
}

}  // namespace

Canvas draw_scene(const SceneView& view) {
  Canvas canvas(view.camera.width, view.camera.height);
  if (view.depth.size() ==
      static_cast<std::size_t>(view.camera.width) * static_cast<std::size_t>(view.camera.height))
    draw_depth(view.depth, canvas);
  const double most = displacement_scale(view.displacement);
  if (view.labels.size() == view.positions.size()) draw_points(view, most, canvas);
  draw_axes(view, canvas);
  draw_key(view, most, canvas);
  draw_notes(view.notes, canvas);
  return canvas;
}

Intrinsics camera_that_shows(std::span<const Point3f> points, int width, int height) {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (const Point3f& p : points) {
    if (!(p.z > 0)) continue;
    const double x = static_cast<double>(p.x / p.z), y = static_cast<double>(p.y / p.z);
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  Intrinsics camera;
  camera.width = width;
  camera.height = height;
  if (left > right) left = top = -0.5, right = bottom = 0.5;
  camera.fx = camera.fy =
      0.7 * std::min(width / std::max(right - left, 1e-3), height / std::max(bottom - top, 1e-3));
  camera.cx = width / 2.0 - camera.fx * (left + right) / 2;
  camera.cy = height / 2.0 - camera.fy * (top + bottom) / 2;
  return camera;
}

}  // namespace pliant
