#include "drivers/simulated/simulated.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "drivers/simulated/actor.hpp"
#include "drivers/simulated/disparity_image.hpp"
#include "drivers/simulated/motion.hpp"
#include "drivers/simulated/options.hpp"
#include "drivers/simulated/scene.hpp"
#include "drivers/simulated/staging.hpp"
#include "drivers/simulated/structure_sensor.hpp"

namespace pliant {

namespace {

using namespace simulated;

constexpr double kVisibleTolerance = 0.004;  ///< metres; half a pixel of a surface seen at 70 degrees
constexpr std::int64_t kFewestVisible = 30;  ///< vertices of an object that is present

Stage stage_for(ObjectKind object) {
  switch (object) {
    case ObjectKind::figure:
      return {make_figure(), {22, 0.82, 0.175}};
    case ObjectKind::box:
      return {make_box(), {33, 0.80, 0.10}};
    case ObjectKind::cushion:
      break;
  }
  return {make_cushion(), {42, 0.78, 0.05}};
}

Intrinsics camera_for(const Options& options) {
  const double focal = 570.0 * options.width / 640;
  return {options.width, options.height, focal, focal, 0.5 * options.width, 0.5 * options.height, 1000};
}

SensorDescription sensor_for(const Options& options) {
  SensorDescription sensor;
  if (!options.noise) {  // what is left is the rounding to whole millimetres
    sensor.noise_floor = 0.0003;
    sensor.noise_growth = 0;
  }
  return sensor;
}

/// Depth of exactly drawn disparity in millimetres.
void measure_exactly(const DisparityImage& scene, std::span<std::uint16_t> depth) {
  constexpr auto kMillimetres = static_cast<std::int64_t>(1000 * kFocalBaseline * (1 << kDisparityBits));
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const std::int64_t d = scene.pixels()[i];
    const std::int64_t z = d > 0 ? (kMillimetres + d / 2) / d : 0;
    depth[i] = z < 65536 ? static_cast<std::uint16_t>(z) : std::uint16_t{0};
  }
}

/// What a hand adds to the camera's way: sway of some millimetres at one to two hertz, tremor of a fifth of a
/// degree at five to seven.
RigidTransform tremor(std::int64_t number) {
  const double seconds = static_cast<double>(number) / 30;
  RigidTransform shaken;
  shaken.translation = Vector3(0.005 * sine(1.1 * seconds), 0.004 * sine(1.7 * seconds + 0.3),
                               0.004 * sine(0.9 * seconds + 0.6));
  const auto turns = [&](double hertz, double start) {
    return kDegree * (0.2 * sine(hertz * seconds + start) + 0.5 * sine(0.2 * hertz * seconds + start));
  };
  shaken.rotation = rotation_about(Vector3::UnitX(), turns(5.3, 0.1)) *
                    rotation_about(Vector3::UnitY(), turns(6.1, 0.7)) *
                    rotation_about(Vector3::UnitZ(), turns(6.9, 0.4));
  return shaken;
}

class Simulated final : public SimulatedSource {
 public:
  Simulated(const Options& options, Stage stage)
      : options_(options),
        actor_(std::move(stage.actor)),
        camera_(camera_for(options)),
        description_(sensor_for(options)),
        view_(stage.view),
        camera_from_table_(camera_from_table(stage.view)),
        background_(camera_),
        image_(camera_),
        sensor_(camera_, description_, options.seed) {
    surroundings_.draw(camera_from_table_, background_);
    const std::size_t count = actor_->mesh().vertices.size();
    vertices_.resize(count);
    float_vertices_.resize(count);
    visible_.resize(count);
    for (const Point3f& p : actor_->hand().vertices) hand_rest_.push_back(to_vector(p));
    hand_.resize(hand_rest_.size());
    depth_.resize(image_.pixels().size());
  }

  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_; }
  [[nodiscard]] const SensorDescription& sensor() const override { return description_; }
  [[nodiscard]] bool live() const override { return false; }
  [[nodiscard]] std::int64_t frame_count() const override { return options_.frames; }
  [[nodiscard]] const Geometry& mesh() const override { return actor_->mesh(); }
  [[nodiscard]] const SimulatedTruth& truth() const override { return truth_; }
  void close() override { closed_ = true; }

  void next(int /*timeout_ms*/, SourceItem& item) override {
    item.frame = {};
    item.fault.clear();
    item.event = SourceEvent::end;
    if (closed_ || number_ >= options_.frames) return;
    stage();
    draw();
    tell_truth();
    if (options_.noise)
      sensor_.measure(image_, number_, depth_);
    else
      measure_exactly(image_, depth_);
    item.event = SourceEvent::frame;
    item.frame = {depth_.data(), camera_.width, camera_.height, camera_.width, truth_.utime, number_};
    ++number_;
  }

 private:
  /// Puts object, hand and camera where they are in this frame.
  void stage() {
    const bool handled = options_.motion == Motion::handled;
    actor_->move(handled ? phase_of(number_) : 0, state_, vertices_);
    if (handled) return;
    // Once round, and a twelfth more, so that the first view comes back.
    const double turned = 13.0 / 12 *
                          glide(static_cast<double>(number_), 0,
                                static_cast<double>(std::max<std::int64_t>(1, options_.frames - 1)));
    if (options_.motion == Motion::turned) {
      Vector3 axis = state_.parts[0].translation;
      axis.z() = 0;
      const RigidTransform turn = hinge(axis, Vector3::UnitZ(), turned);
      for (Vector3& p : vertices_) p = turn * p;
      for (RigidTransform& part : state_.parts) part = turn * part;
    } else {
      View view = view_;
      view.azimuth = turned;
      view.pitch = 36 + 17 * sine(3 * turned);
      view.distance = view_.distance * (0.92 + 0.08 * sine(2 * turned));
      if (options_.motion == Motion::carried) view.azimuth += 0.012 * sine(5 * turned);
      camera_from_table_ = camera_from_table(view);
      if (options_.motion == Motion::carried) camera_from_table_ = tremor(number_) * camera_from_table_;
      background_.clear();
      surroundings_.draw(camera_from_table_, background_);
    }
  }
  void draw() {
    for (Vector3& p : vertices_) p = camera_from_table_ * p;
    const RigidTransform hand = camera_from_table_ * state_.hand;
    for (std::size_t i = 0; i < hand_.size(); ++i) hand_[i] = hand * hand_rest_[i];
    image_.copy_from(background_);
    std::fill(visible_.begin(), visible_.end(), std::uint8_t{0});
    image_.draw(vertices_, actor_->mesh().triangles, visible_);  // those that face the camera, for now
    image_.draw(hand_, actor_->hand().triangles, {});
  }

  void tell_truth() {
    std::int64_t seen = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const Vector3& p = vertices_[i];
      float_vertices_[i] = to_point(p);
      if (visible_[i] != 0 && !image_.sees(p, kVisibleTolerance)) visible_[i] = 0;
      seen += visible_[i];
    }
    for (std::size_t k = 0; k < actor_->parts(); ++k) parts_[k] = camera_from_table_ * state_.parts[k];
    truth_.number = number_;
    truth_.utime = (number_ * 1000000 + 15) / 30;
    truth_.present = seen >= kFewestVisible;
    truth_.vertices = float_vertices_;
    truth_.parts = {parts_, actor_->parts()};
    truth_.vertex_part = actor_->vertex_part();
    truth_.visible = visible_;
  }

  Options options_;
  std::unique_ptr<Actor> actor_;
  Intrinsics camera_;
  SensorDescription description_;
  View view_;
  RigidTransform camera_from_table_;
  Surroundings surroundings_;
  DisparityImage background_;  ///< the surroundings as the camera sees them
  DisparityImage image_;
  StructureSensor sensor_;
  ActorState state_;
  std::vector<Vector3> vertices_, hand_rest_, hand_;  ///< camera, hand and camera frame
  std::vector<Point3f> float_vertices_;
  std::vector<std::uint8_t> visible_;
  RigidTransform parts_[kMaxParts];
  std::vector<std::uint16_t> depth_;
  SimulatedTruth truth_;
  std::int64_t number_ = 0;
  bool closed_ = false;
};

}  // namespace

std::unique_ptr<SimulatedSource> simulated::stage_source(const Options& options, Stage stage) {
  return std::make_unique<Simulated>(options, std::move(stage));
}

Result<std::unique_ptr<SimulatedSource>> open_simulated(std::string_view text) {
  const Result<Options> options = parse_options(text);
  if (!options) return options.error();
  return stage_source(*options, stage_for(options->object));
}

}  // namespace pliant
