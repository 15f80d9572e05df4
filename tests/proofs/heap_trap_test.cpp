// Tracker::process() makes no heap call, from the first frame on: while it searches, tracks, loses and finds.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "core/tracker.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "drivers/simulated/simulated.hpp"
#include "firmware-app/measure/path_cost.hpp"
#include "firmware-app/pipeline/memory_block.hpp"

namespace pliant {
namespace {

/// Heap calls inside process() over a whole simulated sequence, and how often each state came.
struct Trapped {
  std::uint64_t heap_calls = 0;
  std::map<TrackState, int> frames;
};

Trapped track(const std::string& source_name, bool allocate_too) {
  Trapped trapped;
  const auto source = open_simulated(source_name);
  EXPECT_TRUE(source);
  const auto built = build_model((*source)->mesh(), {});
  EXPECT_TRUE(built);
  const auto model = ModelFile::from_image(built->image, source_name);
  EXPECT_TRUE(model);
  const Intrinsics& camera = (*source)->intrinsics();
  auto block = MemoryBlock::allocate(Tracker::workspace_bytes(model->view(), camera, {}));
  EXPECT_TRUE(block);
  Tracker tracker;
  EXPECT_EQ(tracker.start(model->view(), camera, (*source)->sensor(), {}, block->bytes()), nullptr);

  PathCost cost;
  SourceItem item;
  for ((*source)->next(1000, item); item.event == SourceEvent::frame; (*source)->next(1000, item)) {
    TrackState state = TrackState::searching;
    {
      const PathWatch watch(cost);
      state = tracker.process(item.frame).state;
      if (allocate_too) delete new volatile int(1);
    }
    ++trapped.frames[state];
  }
  trapped.heap_calls = cost.heap_calls.load();
  return trapped;
}

TEST(HeapTrap, FiresWhenThereIsACall) {
  if (!heap_is_watched()) GTEST_SKIP() << "a sanitizer brings a heap of its own";
  EXPECT_EQ(track("simulated:box?frames=3&width=160&height=120", true).heap_calls, 6U);
}

TEST(HeapTrap, NoCallWhileSearchingAndTrackingADeformingObject) {
  if (!heap_is_watched()) GTEST_SKIP() << "a sanitizer brings a heap of its own";
  Trapped trapped = track("simulated:cushion?frames=140&width=320&height=240", false);
  EXPECT_EQ(trapped.heap_calls, 0U);
  EXPECT_GT(trapped.frames[TrackState::tracking], 100);
}

TEST(HeapTrap, NoCallOverSeveralRegions) {
  if (!heap_is_watched()) GTEST_SKIP() << "a sanitizer brings a heap of its own";
  EXPECT_EQ(track("simulated:figure?frames=150&width=320&height=240", false).heap_calls, 0U);
}

TEST(HeapTrap, NoCallOverLossAndReturn) {
  if (!heap_is_watched()) GTEST_SKIP() << "a sanitizer brings a heap of its own";
  Trapped trapped = track("simulated:box?frames=300&width=320&height=240", false);
  EXPECT_EQ(trapped.heap_calls, 0U);
  EXPECT_GT(trapped.frames[TrackState::tracking], 100);
  EXPECT_GT(trapped.frames[TrackState::lost], 0);  // the box is carried out of the picture
}

}  // namespace
}  // namespace pliant
