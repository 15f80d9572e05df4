// What a registration came to, for people and programs.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "core/registration/cloud_registration.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

/// Times the stages of a registration.
class RegistrationTimes {
 public:
  /// `progress` is told the name of each stage that is done.
  [[nodiscard]] RegistrationObserver observer(std::function<void(const char*)> progress);
  void begin();
  void end();

  /// Without what belongs to the model. Milliseconds.
  [[nodiscard]] double stage(int index) const { return scene_[static_cast<std::size_t>(index)]; }
  /// All stages together.
  [[nodiscard]] double total() const;
  /// What belongs to the model and could have been done beforehand.
  [[nodiscard]] double model_side() const { return model_; }

 private:
  static void stage_done(void* context, RegistrationStage stage, bool model_side);
  std::function<void(const char*)> progress_;
  std::array<double, kRegistrationStageCount> scene_{};
  double model_ = 0;
  std::int64_t stamp_ = 0;
};

/// The JSON report.
[[nodiscard]] Outcome write_registration_report(const std::string& path, const RegistrationResult& result,
                                                const RegistrationTimes& times);
/// Instances, regions and times for people.
[[nodiscard]] std::string registration_table(const RegistrationResult& result,
                                             const RegistrationTimes& times);
/// Why nothing was found, in one line.
[[nodiscard]] std::string registration_fault(const RegistrationResult& result);

}  // namespace pliant
