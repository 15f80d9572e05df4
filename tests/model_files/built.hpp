// Builds models in tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "tests/geometry_files/bytes.hpp"

namespace pliant::testing {

inline bool warned(const BuiltModel& built, std::string_view part) {
  for (const std::string& warning : built.warnings)
    if (mentions(warning, part)) return true;
  return false;
}

/// A model that must be possible to build, with its checked view.
struct Made {
  BuiltModel built;
  ModelFile file;
  [[nodiscard]] const ModelView& view() const { return file.view(); }
};

inline Made make(const Geometry& geometry, const ModelBuildSettings& settings = {}) {
  Made made;
  Result<BuiltModel> built = build_model(geometry, settings);
  EXPECT_TRUE(built) << built.error().message;
  if (!built) return made;
  made.built = *built;
  Result<ModelFile> file = ModelFile::from_image(made.built.image, "built");
  EXPECT_TRUE(file) << file.error().message;
  if (file) made.file = std::move(*file);
  return made;
}

inline Vector3 to_vector(const Normal16& n) {
  return Vector3(n.x, n.y, n.z) / 16384.0;
}

/// Share of the model's normals for which `outward(position, normal)` is positive.
template <typename Outward>
double share_outward(const ModelView& model, Outward outward) {
  std::size_t good = 0;
  for (std::size_t i = 0; i < model.size(); ++i)
    good += outward(to_vector(model.positions()[i]), to_vector(model.normals()[i])) > 0 ? 1U : 0U;
  return static_cast<double>(good) / static_cast<double>(model.size());
}

}  // namespace pliant::testing
