#include "firmware-app/commands/capture_guide.hpp"

#include <fmt/format.h>

#include <array>

namespace pliant {

namespace {

constexpr std::array<const char*, Coverage::kSectors> kSides = {
    "the front", "the front right", "the right", "the back right",
    "the back",  "the back left",   "the left",  "the front left"};

}  // namespace

std::string sides_missing(const Coverage& coverage) {
  std::string text;
  for (int s = 0; s < Coverage::kSectors; ++s) {
    if (coverage.seen(s)) continue;
    if (!text.empty()) text += ", ";
    text += kSides[static_cast<std::size_t>(s)];
  }
  return text;
}

std::string doubt_of_turning(const CaptureFigures& figures, const Coverage& coverage) {
  if (2 * figures.featureless <= figures.fused) {
    if (figures.longest_unheld < kUnheldStretch) return "";
    return fmt::format(
        "its turning could not be seen for {} pictures on end: what came before and after may lie turned "
        "against each other. Compare the surface (--ply) with the object, or keep in sight what stands out "
        "of it",
        figures.longest_unheld);
  }
  std::string text = fmt::format(
      "its turning could not be seen: in {} of {} pictures the shape, round about an axis or flat, did not "
      "tell how it was turned. ",
      figures.featureless, figures.fused);
  // Seen from elsewhere, what is round or flat stands in other pixels; turned on the spot, it does not.
  text +=
      coverage.sectors_seen() <= 1
          ? "The model is of one side; if the object was turned, what little stands out of it is smeared. "
            "Carry the sensor around it, or put something with edges onto it"
          : "Compare the surface (--ply) with the object: its sides may lie turned against each other";
  return text;
}

void CaptureGuide::take(const CaptureStatus& status, const Coverage& coverage) {
  status_ = status;
  sectors_ = coverage.sectors_seen();
  from_above_ = coverage.seen_from_above();
  missing_ = sides_missing(coverage);
  ++pictures_;
  held_ += status.state == CaptureState::capturing && !status.featureless ? 1 : 0;
  const Advice reason = wanted(status);
  pictures_with_reason_ = reason == reason_ ? pictures_with_reason_ + 1 : 1;
  reason_ = reason;
}

CaptureGuide::Advice CaptureGuide::wanted(const CaptureStatus& status) const {
  if (status.state == CaptureState::waiting) return status.too_near ? Advice::too_near : Advice::nothing;
  if (status.state == CaptureState::lost) return Advice::lost;
  if (status.too_large) return Advice::too_large;
  if (status.too_far) return Advice::too_far;
  if (status.too_fast) return Advice::too_fast;
  if (status.featureless) return status.standing > 0.5 ? Advice::unmoved : Advice::featureless;
  if (round_closed() && !told_closed_) return Advice::closed;
  return status.against ? Advice::against : Advice::none;
}

const char* CaptureGuide::words(Advice advice) {
  switch (advice) {
    case Advice::none:
      return "";
    case Advice::nothing:
      return "nothing stands before the background: put the object on a table, 0.4 to 1 m before the sensor, "
             "in the middle "
             "of the picture";
    case Advice::too_near:
      return "too near: most of the picture has no reading; move the sensor back to 0.4 m or more";
    case Advice::too_far:
      return "too far: the sensor's noise hides the shape; come nearer";
    case Advice::lost:
      return "lost: too fast, or nothing of what was seen is in the picture; show again what was seen last, "
             "and hold still";
    case Advice::too_fast:
      return "too fast: move more slowly";
    case Advice::too_large:
      return "larger than the volume: what reaches out of it is cut off; use a larger --size";
    case Advice::featureless:
      return "featureless: what is seen is round or flat and does not tell how it turns; show a side with "
             "more shape";
    case Advice::unmoved:
      return "featureless as it stands: what is seen is round or flat, and whether it turns cannot be seen; "
             "carry "
             "the sensor around it, or put something with edges onto it";
    case Advice::against:
      return "what moves against the object, such as a hand, is left out";
    case Advice::closed:
      return "seen from all sides: enough, Ctrl-C ends; views from above and below make it better";
  }
  return "";
}

std::string CaptureGuide::line() const {
  if (status_.state == CaptureState::waiting) return "waiting for the object";
  if (status_.state == CaptureState::lost) return "lost: show again what was seen last";
  return fmt::format("{:.2f} m, fits {:.0f} % within {:.1f} mm; seen {} of {} sides{}{}", status_.distance,
                     100 * status_.agreement, 1000 * status_.rms, sectors_, Coverage::kSectors,
                     missing_.empty() ? "" : ", not " + missing_, from_above_ ? "" : "; never from above");
}

double CaptureGuide::patience(Advice advice) const {
  if (advice != Advice::featureless && advice != Advice::unmoved) return rate_ / 4;
  // What stands out only here and there is known when it has moved by some degrees. The first view is not
  // judged.
  return held_ > 1 ? rate_ / 2 : 2 * rate_;
}

std::string CaptureGuide::advice() {
  const auto now = static_cast<std::size_t>(reason_);
  if (reason_ == Advice::none || pictures_with_reason_ < patience(reason_)) return "";
  const bool repeated = static_cast<double>(pictures_ - told_[now]) < (told_[now] < 0 ? 0 : 5 * rate_);
  if (repeated) return "";
  told_[now] = pictures_;
  told_closed_ = told_closed_ || reason_ == Advice::closed;
  return words(reason_);
}

}  // namespace pliant
