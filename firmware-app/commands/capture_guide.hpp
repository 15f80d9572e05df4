// What the person who shows the object is told.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/capture/object_capture.hpp"

namespace pliant {

/// Names of the sides that were not seen: "the back, the back left". Empty when all were.
[[nodiscard]] std::string sides_missing(const Coverage& coverage);

/// Pictures on end that leave a turn in doubt when their shape does not tell of it: at a turn in ten seconds
/// the object goes on by more than the distances reach.
inline constexpr std::int64_t kUnheldStretch = 15;
/// What a capture is worth in whose pictures the shape did not tell how it turned, mostly or for a stretch of
/// kUnheldStretch; empty when it did.
[[nodiscard]] std::string doubt_of_turning(const CaptureFigures& figures, const Coverage& coverage);

/// Turns the pictures' statuses into a line that is renewed and advice that is given when it changes.
class CaptureGuide {
 public:
  explicit CaptureGuide(double rate) : rate_(rate > 1 ? rate : 30) {}

  /// Takes a picture's status in.
  void take(const CaptureStatus& status, const Coverage& coverage);
  /// How far it is: renewed with every picture.
  [[nodiscard]] std::string line() const;
  /// Advice that should be read now; empty for most pictures. No sooner than two seconds after the same
  /// advice was given, and only after a quarter of a second of good reason. Featureless: after half a second,
  /// and after two while it may be that the object has not been turned yet.
  [[nodiscard]] std::string advice();
  /// Everything from the first view all round to it again was seen.
  [[nodiscard]] bool round_closed() const { return sectors_ == Coverage::kSectors; }

 private:
  enum class Advice : std::uint8_t {
    none,
    nothing,
    too_near,
    too_far,
    lost,
    too_fast,
    too_large,
    featureless,
    unmoved,
    against,
    closed
  };
  [[nodiscard]] Advice wanted(const CaptureStatus& status) const;
  [[nodiscard]] static const char* words(Advice advice);
  /// Pictures of good reason before it is given.
  [[nodiscard]] double patience(Advice advice) const;

  double rate_;
  CaptureStatus status_;
  int sectors_ = 0, held_ = 0;  // pictures whose shape told how they lie
  bool from_above_ = false, told_closed_ = false;
  std::string missing_;
  Advice reason_ = Advice::none;
  int pictures_with_reason_ = 0;
  std::vector<std::int64_t> told_ = std::vector<std::int64_t>(11, -1000000);  // at which picture
  std::int64_t pictures_ = 0;
};

}  // namespace pliant
