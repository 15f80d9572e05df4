// Compares what the tracker says with what the simulator knows.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/model/model_view.hpp"
#include "core/track_result.hpp"
#include "drivers/simulated/simulated.hpp"
#include "firmware-app/measure/histogram.hpp"

namespace pliant::demo {

/// A simulated source that remembers the truth of the frames it gave last, since they are tracked a little
/// later and on another thread. No heap call after the first frame.
class RememberingSource final : public DepthSource {
 public:
  explicit RememberingSource(std::unique_ptr<SimulatedSource> source);

  [[nodiscard]] const Intrinsics& intrinsics() const override { return source_->intrinsics(); }
  [[nodiscard]] const SensorDescription& sensor() const override { return source_->sensor(); }
  [[nodiscard]] bool live() const override { return source_->live(); }
  [[nodiscard]] std::int64_t frame_count() const override { return source_->frame_count(); }
  void next(int timeout_ms, SourceItem& item) override;
  void close() override { source_->close(); }

  [[nodiscard]] const Geometry& mesh() const { return source_->mesh(); }
  struct Memory {
    std::int64_t number = -1;
    bool present = false;
    std::vector<Point3f> vertices;
    RigidTransform base;
  };
  /// Copies the truth of a frame; false when it is forgotten.
  [[nodiscard]] bool recall(std::int64_t number, Memory& memory) const;

 private:
  std::unique_ptr<SimulatedSource> source_;
  mutable std::mutex mutex_;
  std::array<Memory, 8> memories_;  // more than the frames between capture and tracking
  std::size_t next_ = 0;
};

/// Errors over all observed points of all tracked frames.
class TruthCheck {
 public:
  TruthCheck(const ModelView& model, const RememberingSource& source);
  /// On the tracking thread; no heap call.
  void look(const TrackResult& result);

  /// Frames in which the object was there to be seen, and of those the tracked ones.
  [[nodiscard]] std::int64_t present() const { return present_; }
  [[nodiscard]] std::int64_t present_and_tracked() const { return present_and_tracked_; }
  /// Frames that were tracked although the object was not there.
  [[nodiscard]] std::int64_t claimed_while_gone() const { return claimed_while_gone_; }
  /// Distance of an observed point to where it truly is, micrometres.
  [[nodiscard]] const Histogram& position() const { return position_; }
  /// Of the base region's pose: against the rigid motion that the points it claims truly made, at their
  /// middle, micrometres; and its angle, thousandths of a degree.
  [[nodiscard]] const Histogram& base_shift() const { return base_shift_; }
  [[nodiscard]] const Histogram& base_angle() const { return base_angle_; }

 private:
  void compare_base(const TrackResult& result);

  /// A model point between vertices of the simulated mesh.
  struct Place {
    std::array<std::uint32_t, 3> vertices{};
    std::array<double, 3> weights{};
  };
  const RememberingSource& source_;
  std::vector<Point3f> mesh_rest_;
  std::vector<Vector3> rest_;
  std::vector<Place> places_;
  std::vector<Vector3> where_;  ///< truly, in this frame
  RememberingSource::Memory truth_;
  std::int64_t present_ = 0, present_and_tracked_ = 0, claimed_while_gone_ = 0;
  Histogram position_, base_shift_, base_angle_;
};

}  // namespace pliant::demo
