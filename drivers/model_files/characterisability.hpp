// Whether a shape tells where it is.
#pragma once

#include <string>

#include "core/model/model_view.hpp"
#include "drivers/model_files/mesh.hpp"

namespace pliant {

struct Characterisability {
  /// Over all rigid motions: the smallest share of a motion (root mean square over the surface) that moves
  /// the surface along its normal, where a depth camera can see it. 0: a motion exists that the shape does
  /// not notice. A box has about 0.4.
  double measure = 0;
  double needed = 0;  ///< least measure for the sensor to notice
  ModelHeader::Ambiguity ambiguity = ModelHeader::Ambiguity::none;
  /// The motions that it does not notice, with their axis or direction in the model's frame; empty where
  /// there are several of a kind, as of a plane and a sphere.
  std::string motions;
  std::string reason;  ///< one line; empty when the shape is characterisable
};

/// Geometric stability of the point-to-plane constraints (Gelfand et al.: Geometrically stable sampling for
/// the ICP algorithm, 3DIM 2003), relative to how far the motion moves the points, so that it has no unit.
///
/// Needed: a slip by a tenth of the object's radius must move the surface along its normal by half the
/// sensor's noise at 0.8 m (structured light, 1.5 mm): noise that is alike over neighbouring pixels does not
/// average out. And never less than 0.04, what the facets and the scan noise of a featureless object's model
/// feign.
///
/// `cloud`: points in farthest-point order; `spacing`: of the points, metres.
[[nodiscard]] Characterisability characterise(const OrientedCloud& cloud, double spacing);

}  // namespace pliant
