#include "firmware-app/commands/registration_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "drivers/geometry_files/atomic_file.hpp"
#include "firmware-app/measure/clock.hpp"

namespace pliant {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, kRegistrationStageCount> kNames = {
    "normals", "keypoints", "descriptors", "matching", "grouping", "chain", "deformed"};

Json matrix(const RigidTransform& transform) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r)
    rows.push_back({transform.rotation(r, 0), transform.rotation(r, 1), transform.rotation(r, 2),
                    transform.translation(r)});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

Json instance_json(const InstanceResult& instance) {
  Json regions = Json::array();
  for (const RegionResult& region : instance.regions)
    regions.push_back({{"id", region.id},
                       {"points", region.points},
                       {"rms", region.rms},
                       {"transform", matrix(region.transform)}});
  return {{"score", instance.score},
          {"regions", regions},
          {"deformed", instance.deformed},
          {"unobserved", instance.unobserved}};
}

}  // namespace

RegistrationObserver RegistrationTimes::observer(std::function<void(const char*)> progress) {
  progress_ = std::move(progress);
  return {&RegistrationTimes::stage_done, this};
}

void RegistrationTimes::begin() {
  stamp_ = monotonic_ns();
}

void RegistrationTimes::end() {
  // What comes after the last stage belongs to it.
  scene_.back() += static_cast<double>(monotonic_ns() - stamp_) * 1e-6;
}

void RegistrationTimes::stage_done(void* context, RegistrationStage stage, bool model_side) {
  auto* self = static_cast<RegistrationTimes*>(context);
  const std::int64_t now = monotonic_ns();
  const auto index = static_cast<std::size_t>(stage);
  (model_side ? self->model_ : self->scene_[index]) += static_cast<double>(now - self->stamp_) * 1e-6;
  if (self->progress_) self->progress_(kNames[index]);
  self->stamp_ = monotonic_ns();
}

double RegistrationTimes::total() const {
  return std::accumulate(scene_.begin(), scene_.end(), 0.0);
}

Outcome write_registration_report(const std::string& path, const RegistrationResult& result,
                                  const RegistrationTimes& times) {
  Json instances = Json::array();
  const bool found = result.outcome == RegistrationOutcome::found && !result.instances.empty();
  if (found)
    for (const InstanceResult& instance : result.instances) instances.push_back(instance_json(instance));
  Json timing;
  for (int i = 0; i < kRegistrationStageCount; ++i)
    timing[kNames[static_cast<std::size_t>(i)]] = times.stage(i);
  timing["total"] = times.total();
  timing["model_side"] = times.model_side();
  const Json report = {{"instances", instances},
                       {"keypoints", {{"model", result.model_keypoints}, {"scene", result.scene_keypoints}}},
                       {"timing_ms", timing},
                       {"found", found}};
  const std::string text = report.dump(2) + "\n";
  return write_whole_file(path.c_str(), std::as_bytes(std::span(text)), false);
}

std::string registration_table(const RegistrationResult& result, const RegistrationTimes& times) {
  std::string text;
  int number = 0;
  for (const InstanceResult& instance : result.instances) {
    text += fmt::format("instance {}: score {:.3f}, {} deformed and {} unobserved points\n", number++,
                        instance.score, instance.deformed, instance.unobserved);
    for (const RegionResult& region : instance.regions) {
      const Vector3& t = region.transform.translation;
      const Quaternion q = quaternion_from_rotation(region.transform.rotation);
      text += fmt::format(
          "  region {}: {} points, rms {:.2f} mm, at {:.4f} {:.4f} {:.4f} m, quaternion w x y z "
          "{:.4f} {:.4f} {:.4f} {:.4f}\n",
          region.id, region.points, region.rms * 1e3, t.x(), t.y(), t.z(), q.w, q.x, q.y, q.z);
    }
  }
  text +=
      fmt::format("keypoints: model {}, scene {}\ntime, ms:", result.model_keypoints, result.scene_keypoints);
  for (int i = 0; i < kRegistrationStageCount; ++i)
    text += fmt::format(" {} {:.1f},", kNames[static_cast<std::size_t>(i)], times.stage(i));
  return text + fmt::format(" total {:.1f}; model {:.1f}\n", times.total(), times.model_side());
}

std::string registration_fault(const RegistrationResult& result) {
  std::string text = describe(result.outcome);
  if (result.outcome == RegistrationOutcome::wrong_size)
    text += fmt::format(" (the scene is {:.4g} times as large as the model)", result.size_ratio);
  return text;
}

}  // namespace pliant
