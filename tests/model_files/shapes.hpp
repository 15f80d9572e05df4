// Simple shapes to build models of. Metres, wound outward.
#pragma once

#include <cstddef>
#include <functional>

#include "drivers/geometry_files/geometry.hpp"

namespace pliant::shapes {

/// A grid over (s, t) in [0, 1]², put into space by `place`.
[[nodiscard]] Geometry patch(std::size_t columns, std::size_t rows,
                             const std::function<Vector3(double s, double t)>& place);

[[nodiscard]] Geometry sphere(double radius, std::size_t rows);
/// A cloud of `count` evenly spread points.
[[nodiscard]] Geometry even_sphere(double radius, std::size_t count);
/// Half axes a, b, c.
[[nodiscard]] Geometry ellipsoid(double a, double b, double c, std::size_t rows);
[[nodiscard]] Geometry plane(double width, double height, std::size_t rows);
/// Along z; `closed`: with its two ends.
[[nodiscard]] Geometry cylinder(double radius, double height, std::size_t rows, bool closed);
/// A bottle along z as it is seen from one side: `degrees` of its turn, the middle of them towards x. Its
/// axis goes through (0.1, 0.2).
[[nodiscard]] Geometry side_of_bottle(double degrees, std::size_t rows);
/// A bar of an L's profile along y, without its ends.
[[nodiscard]] Geometry angle_bar(std::size_t rows);
[[nodiscard]] Geometry torus(double radius, double tube, std::size_t rows);
/// Eight vertices, twelve triangles.
[[nodiscard]] Geometry box(double x, double y, double z);
/// A flattened cushion with a knob off its middle.
[[nodiscard]] Geometry cushion_with_knob();
/// A sheet of thickness `thickness` with a front and a back.
[[nodiscard]] Geometry thin_plate(double width, double thickness, std::size_t rows);

[[nodiscard]] Geometry joined(const Geometry& a, const Geometry& b);
[[nodiscard]] Geometry turned_over(Geometry geometry);
/// The vertices alone.
[[nodiscard]] Geometry cloud_of(const Geometry& geometry);
/// Each coordinate moved by up to `amplitude`, the same at each call.
[[nodiscard]] Geometry with_noise(Geometry geometry, double amplitude);

}  // namespace pliant::shapes
