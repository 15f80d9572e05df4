// One scene for all tests of a suite: it is not changed but by what a test sets first.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "tests/core/track_scene.hpp"

namespace pliant::synthetic {

template <Geometry (*kBody)(), int kSpacingMillimetres = 6>
class SharedScene : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TrackScene>(kBody(), kSpacingMillimetres / 1000.0);
  }
  static void TearDownTestSuite() { shared_.reset(); }
  static TrackScene& scene() { return *shared_; }

 private:
  static inline std::unique_ptr<TrackScene> shared_;
};

}  // namespace pliant::synthetic
