// From a mesh or cloud to the cached model.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/model/model_view.hpp"
#include "drivers/common/result.hpp"
#include "drivers/geometry_files/geometry.hpp"

namespace pliant {

/// Points that a model gets when they can be chosen freely: fine enough for dents of some spacings, and what
/// a small processor can follow at the camera's rate.
inline constexpr std::size_t kUsualPoints = 8000;
/// Mean distance to the nearest in a farthest-point sampling that took its points from eight times as many,
/// as a share of the hexagonal lattice's.
inline constexpr double kSamplingShare = 0.8;

struct ModelBuildSettings {
  double metres_per_unit = 1;  ///< of the input's coordinates [1e-6, 1e3]
  double spacing = 0;          ///< wished distance between points, metres; 0: derived from the surface (0, 1]
  bool wound_outward = false;  ///< the input's triangles are known to be: their winding is not looked into
  bool front_only = false;     ///< the back is unknown, and the model says so
  double material = 0.5;       ///< how easily the object stretches: 0 stiff … 1 soft [0, 1]
};

/// How the points of a model came about.
enum class PointOrigin { input_vertices, reduced_vertices, sampled_surface };

struct BuiltModel {
  std::vector<std::byte> image;  ///< aligned to eight bytes at least; ModelView::open accepts it
  std::size_t points = 0;
  std::size_t keypoints = 0;
  double spacing = 0;            ///< mean distance of a point to its nearest other, metres
  double extent[3] = {0, 0, 0};  ///< of the bounding box, metres
  PointOrigin origin = PointOrigin::input_vertices;
  bool closed_surface = false;
  bool characterisable = false;
  double characterisability = 0;      ///< [0, 1], see characterisability.hpp
  std::string reason;                 ///< why it is not characterisable; empty when it is
  std::vector<std::string> warnings;  ///< one line each
};

/// Deterministic. Vertices of the input are kept when they fit and are dense enough; else a mesh is sampled
/// evenly by area, a cloud thinned out. All points lie on the input's surface. An ErrorKind::bad_input when
/// there is too little to make a model of.
[[nodiscard]] Result<BuiltModel> build_model(const Geometry& geometry, const ModelBuildSettings& settings);

}  // namespace pliant
