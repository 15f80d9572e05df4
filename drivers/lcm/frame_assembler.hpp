// Puts frames, the model and depth pictures together again from the messages that they were sent in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/lcm/messages.hpp"

namespace pliant {

/// One frame's result as a subscriber knows it.
struct ReceivedFrame {
  std::int64_t utime = 0, frame = 0, model_id = 0;
  TrackState state = TrackState::searching;
  float confidence = 0;
  std::vector<RegionMessage> regions;  ///< the base first, where it was seen
  std::vector<std::int8_t> labels;     ///< one a model point; empty unless tracking
  std::vector<std::int16_t> deformed;  ///< model points, ascending
  std::vector<Point3f> position;       ///< of those, camera frame, metres
  std::vector<Point3f> displacement;   ///< of those, metres
  std::vector<float> strain;           ///< of those, as a share of the length
};

class FrameAssembler {
 public:
  /// Each returns true when this message made a frame whole: frame() is it until the next call.
  [[nodiscard]] bool take(const RegionsMessage& message);
  [[nodiscard]] bool take(const DeformedMessage& message);
  [[nodiscard]] const ReceivedFrame& frame() const { return frame_; }
  /// Frames given up: messages of a newer one came before their last, or their parts contradict each other.
  [[nodiscard]] std::int64_t incomplete() const { return incomplete_; }

 private:
  struct DeformedPoint {
    std::int16_t index;
    Point3f position, displacement;
    float strain;
  };

  void begin(std::int64_t utime, std::int64_t frame, std::int64_t model_id);
  [[nodiscard]] bool finish();
  [[nodiscard]] bool order_deformed();

  ReceivedFrame frame_;
  std::vector<DeformedPoint> deformed_;  // as they came
  std::vector<bool> regions_seen_, deformed_seen_;
  bool begun_ = false, told_ = false;
  std::int64_t incomplete_ = 0;
};

/// The model as it was announced. Unit normals.
struct ReceivedModel {
  std::int64_t model_id = 0;
  float spacing = 0;  ///< metres
  std::vector<Point3f> points, normals;
};

class ModelAssembler {
 public:
  /// True when this message made a model whole that was not known before: model() is it.
  [[nodiscard]] bool take(const ModelMessage& message);
  /// Empty before the first.
  [[nodiscard]] const ReceivedModel& model() const { return model_; }

 private:
  ReceivedModel model_, coming_;
  std::vector<bool> seen_;
};

/// A whole depth picture, raw units.
struct ReceivedDepth {
  std::int64_t utime = 0, frame = 0;
  Intrinsics camera;
  std::vector<std::uint16_t> depth;  ///< rows from the top; 0 = no reading
};

class PictureAssembler {
 public:
  /// True when this message made a picture whole: picture() is it until the next call.
  [[nodiscard]] bool take(const DepthMessage& message);
  [[nodiscard]] const ReceivedDepth& picture() const { return picture_; }
  [[nodiscard]] std::int64_t incomplete() const { return incomplete_; }

 private:
  ReceivedDepth picture_;
  std::vector<bool> seen_;
  std::int64_t incomplete_ = 0;
};

/// Where every model point is, camera frame, metres: by its region, by its own position where it is deformed,
/// by the first region where it is not observed. Empty unless the frame is tracked and of this model.
void place_points(const ReceivedFrame& frame, const ReceivedModel& model, std::vector<Point3f>& positions);

}  // namespace pliant
