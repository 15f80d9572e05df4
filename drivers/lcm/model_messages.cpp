#include "drivers/lcm/model_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/lcm/fingerprint.hpp"
#include "drivers/lcm/wire.hpp"

namespace pliant {

namespace {

/// A Q14 component as an eighth-bit one.
std::int8_t eight_bits(std::int16_t q14) {
  return static_cast<std::int8_t>(std::clamp(std::lround(q14 * 127.0 / 16384.0), -127L, 127L));
}

}  // namespace

ModelMessages::ModelMessages(const ModelView& model)
    : ModelMessages(
          AnnouncedModel{model.header().checksum, model.spacing(), model.positions(), model.normals()}) {}

ModelMessages::ModelMessages(const AnnouncedModel& model) {
  const std::span<const Point3f> points = model.points;
  const std::span<const Normal16> normals = model.normals;
  const std::size_t parts = std::max<std::size_t>(1, (points.size() + kPointsPerPart - 1) / kPointsPerPart);
  buffer_.resize(parts * kHeaderBytes + points.size() * kPointBytes);

  constexpr float kFar = 1e9F;
  std::array<float, 3> low = {kFar, kFar, kFar}, high = {-kFar, -kFar, -kFar};
  for (const Point3f& point : points)
    for (std::size_t i = 0; i < 3; ++i) {
      const float value = i == 0 ? point.x : i == 1 ? point.y : point.z;
      low[i] = std::min(low[i], value);
      high[i] = std::max(high[i], value);
    }
  std::array<float, 3> origin{};
  double reach = 1e-6;
  for (std::size_t i = 0; i < 3; ++i) {
    origin[i] = 0.5F * (low[i] + high[i]);
    // The origin's own rounding is inside the reach, so that no coordinate leaves the 16 bits.
    const auto middle = static_cast<double>(origin[i]);
    reach = std::max({reach, static_cast<double>(high[i]) - middle, middle - static_cast<double>(low[i])});
  }
  const auto step = static_cast<float>(reach / 32767);
  const auto quantised = [&](float value, std::size_t axis) {
    const double steps =
        (static_cast<double>(value) - static_cast<double>(origin[axis])) / static_cast<double>(step);
    return static_cast<std::int16_t>(std::clamp(std::lround(steps), -32767L, 32767L));
  };

  std::size_t used = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t first = part * kPointsPerPart;
    const std::size_t count = std::min(points.size() - first, kPointsPerPart);
    wire::Writer out(std::span<std::uint8_t>(buffer_).subspan(used));
    out.put<std::uint64_t>(wire::kModelFingerprint);
    out.put<std::uint64_t>(model.id);
    out.put<std::int16_t>(static_cast<std::int16_t>(part));
    out.put<std::int16_t>(static_cast<std::int16_t>(parts));
    out.put<std::int32_t>(static_cast<std::int32_t>(points.size()));
    out.put<std::int32_t>(static_cast<std::int32_t>(first));
    out.put<std::int32_t>(static_cast<std::int32_t>(count));
    out.put<float>(static_cast<float>(model.spacing));
    for (const float value : origin) out.put<float>(value);
    out.put<float>(step);
    for (const Point3f& point : points.subspan(first, count)) {
      out.put<std::int16_t>(quantised(point.x, 0));
      out.put<std::int16_t>(quantised(point.y, 1));
      out.put<std::int16_t>(quantised(point.z, 2));
    }
    for (const Normal16& normal : normals.subspan(first, count)) {
      out.put<std::int8_t>(eight_bits(normal.x));
      out.put<std::int8_t>(eight_bits(normal.y));
      out.put<std::int8_t>(eight_bits(normal.z));
    }
    bodies_.push_back({MessageKind::model, std::span<const std::uint8_t>(buffer_).subspan(used, out.size())});
    used += out.size();
  }
}

}  // namespace pliant
