// A jointed object that something covers for a few frames.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/tracker.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

using synthetic::degrees_between;
using synthetic::OwnedWorkspace;
using synthetic::Picture;

constexpr int kBent = 50;  ///< frames until it is bent and what is seen of it has settled

enum class Cover : std::uint8_t { none, wall, no_reading };

class HiddenObject : public ::testing::Test {
 protected:
  void SetUp() override {
    block_ = OwnedWorkspace::aligned(storage_, Tracker::workspace_bytes(file_.view(), camera_, {}));
    ASSERT_EQ(tracker_.start(file_.view(), camera_, SensorDescription(), {}, block_), nullptr);
    tracker_.start_from(pose());
    for (int frame = 0; frame < kBent; ++frame) (void)see(std::min(0.4, 0.02 * frame));
  }
  static RigidTransform pose() { return synthetic::pose_at({0, 0, 0.6}, {1, 0, 0}, 0.4); }
  const TrackResult& see(double angle, Cover cover = Cover::none) {
    Picture picture(camera_);
    if (cover != Cover::no_reading) {
      picture.draw(mesh_, pose(), [&](const Vector3& p) {
        return p.x() > 0 ? Vector3(synthetic::turn({0, 1, 0.3}, angle) * p) : p;
      });
      picture.wall(cover == Cover::wall ? 0.35 : 1.5);
      picture.shake(0.001, static_cast<unsigned>(number_));
    }
    picture_ = picture;
    return tracker_.process(picture_.frame(number_++));
  }

  const Geometry mesh_ = synthetic::two_part_bar();
  const ModelFile file_ = synthetic::model_of(mesh_, 0.005);
  const Intrinsics camera_ = synthetic::small_camera();
  Tracker tracker_;
  std::vector<std::byte> storage_;
  std::span<std::byte> block_;
  Picture picture_{camera_};
  int number_ = 0;
};

TEST_F(HiddenObject, IsTheSameWhenItComesBackAfterAnyNumberOfFrames) {
  for (const Cover cover : {Cover::wall, Cover::no_reading})
    for (int frames = 1; frames <= 5; ++frames) {
      number_ = 0;
      SetUp();
      const TrackResult& before = see(0.4);
      ASSERT_EQ(before.state, TrackState::tracking);
      ASSERT_GE(before.regions.size(), 2U);
      const std::vector<Region> regions(before.regions.begin(), before.regions.end());
      const std::vector<std::int8_t> labels(before.labels.begin(), before.labels.end());
      for (int k = 0; k < frames; ++k) EXPECT_NE(see(0.4, cover).state, TrackState::tracking);
      for (int k = 0; k < 6; ++k) {
        const TrackResult& after = see(0.4);
        const std::string where = std::to_string(frames) + " hidden, " + std::to_string(k) + " later";
        ASSERT_EQ(after.state, TrackState::tracking) << where;
        ASSERT_EQ(after.regions.size(), regions.size()) << where;
        for (std::size_t r = 0; r < regions.size(); ++r) {
          if (regions[r].points < 200) continue;  // what bends between the halves
          EXPECT_LT(degrees_between(after.regions[r].pose.rotation, regions[r].pose.rotation), 1) << where;
          EXPECT_LT((after.regions[r].pose.translation - regions[r].pose.translation).norm(), 0.003) << where;
        }
        std::size_t other = 0;
        for (std::size_t i = 0; i < labels.size(); ++i)
          other += labels[i] >= 0 && after.labels[i] >= 0 && labels[i] != after.labels[i] ? 1U : 0U;
        EXPECT_LT(other, labels.size() / 20) << where;
      }
    }
}

}  // namespace
}  // namespace pliant
