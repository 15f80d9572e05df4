// Every body of the surface's rows against the reference, and the reference against exact arithmetic.
#include "core/camera/surface_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/camera/surface.hpp"

namespace pliant {
namespace {

using Row = std::vector<std::uint16_t>;

struct Body {
  std::string name;
  SurfaceRows rows;
};

/// Those that this CPU can run, beside the reference.
std::vector<Body> bodies() {
  std::vector<Body> all;
#if defined(__x86_64__) || defined(__i386__)
  if (cpu_features().sse41) all.push_back({"sse41", kSurfaceRowsSse41});
  if (cpu_features().avx2) all.push_back({"avx2", kSurfaceRowsAvx2});
#elif defined(__aarch64__) || defined(__arm__)
  if (cpu_features().neon) all.push_back({"neon", kSurfaceRowsNeon});
#endif
  return all;
}

struct Sensor {
  Intrinsics camera;
  SensorDescription description;
};

/// Ordinary and extreme cameras and sensors.
std::vector<Sensor> sensors() {
  const SensorDescription ordinary;
  SensorDescription coarse{0.05, 0.1, 0.05, 8.0}, fine{0.0001, 0.0, 0.2, 1.0};
  return {{{640, 480, 575, 575, 320, 240, 1000}, ordinary}, {{320, 240, 288, 288, 160, 120, 1000}, ordinary},
          {{640, 480, 525, 525, 320, 240, 5000}, ordinary}, {{1280, 720, 900, 900, 640, 360, 8000}, ordinary},
          {{64, 48, 10, 10, 32, 24, 10}, coarse},           {{1920, 1200, 10000, 9000, 0, 0, 1000000}, fine},
          {{640, 480, 600, 600, 320, 240, 32768}, coarse}};
}

/// A row with the room that bodies may look at and write to.
struct Padded {
  explicit Padded(std::size_t count, std::uint16_t fill = 0) : all(count + 4 * kRowSlack, fill) {}
  std::uint16_t* begin() { return all.data() + kRowSlack; }
  Row all;
};

/// Rows as they come: surfaces with noise, steps, holes; and wild ones.
enum class Content { surface, noise, extremes, empty };

void fill(Padded& row, Content content, std::mt19937& engine) {
  const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
  constexpr std::uint16_t kExtremes[] = {0,    1,    2,    399,   400,   3199,  3200,
                                         3201, 4095, 4096, 32767, 32768, 64000, 65535};
  std::uint32_t z = 2000 + random() % 40000;
  for (std::uint16_t& x : row.all) {
    if (content == Content::surface) {
      if (random() % 32 == 0) z = 2000 + random() % 40000;
      z = std::clamp<std::uint32_t>(z + random() % 41 - 20, 400, 64000);
      x = static_cast<std::uint16_t>(random() % 12 == 0 ? 0 : z);
    } else if (content == Content::noise) {
      x = static_cast<std::uint16_t>(random());
    } else {
      x = content == Content::empty ? std::uint16_t{0} : kExtremes[random() % std::size(kExtremes)];
    }
  }
}

TEST(SurfaceRows, EveryBodyConvertsLikeTheReference) {
  std::mt19937 random(1);
  const std::vector<Body> all = bodies();
  for (const Sensor& sensor : sensors()) {
    const DepthScale scale(sensor.camera, sensor.description);
    for (std::size_t count : {1U, 2U, 7U, 8U, 9U, 15U, 16U, 17U, 31U, 33U, 320U, 641U})
      for (const Content content : {Content::surface, Content::noise, Content::extremes}) {
        Padded source(count), expected(count, 7), got(count, 7);
        fill(source, content, random);
        // exactly `count` readings are there to be read
        const Row raw(source.begin(), source.begin() + static_cast<std::ptrdiff_t>(count));
        kSurfaceRowsScalar.convert(raw.data(), expected.begin(), count, scale);
        for (const Body& body : all) {
          body.rows.convert(raw.data(), got.begin(), count, scale);
          EXPECT_TRUE(std::equal(got.begin(), got.begin() + count, expected.begin()))
              << body.name << " " << count;
        }
      }
  }
}

TEST(SurfaceRows, EveryBodyConvertsEveryReadingLikeTheReference) {
  Row raw(65536), expected(65536), got(65536);
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = static_cast<std::uint16_t>(i);
  for (const Sensor& sensor : sensors()) {
    const DepthScale scale(sensor.camera, sensor.description);
    kSurfaceRowsScalar.convert(raw.data(), expected.data(), raw.size(), scale);
    for (const Body& body : bodies()) {
      body.rows.convert(raw.data(), got.data(), raw.size(), scale);
      EXPECT_EQ(got, expected) << body.name;
    }
  }
}

TEST(SurfaceRows, EveryBodyCleansAndSmoothsLikeTheReference) {
  std::mt19937 random(2);
  const std::vector<Body> all = bodies();
  for (const Sensor& sensor : sensors()) {
    const DiscontinuityRule rule(sensor.camera, sensor.description);
    for (int round = 0; round < 12; ++round)
      for (const Content content : {Content::surface, Content::noise, Content::extremes, Content::empty}) {
        const std::size_t count = round < 4 ? 640 + static_cast<std::size_t>(round) : 1 + random() % 70;
        Padded above(count), row(count), below(count), expected(count), got(count);
        fill(above, content, random);
        row.all = above.all;
        below.all = above.all;
        if (round % 2 == 0) {
          fill(row, content, random);
          fill(below, content, random);
        }
        const auto same = [&] { return std::equal(got.begin(), got.begin() + count, expected.begin()); };
        kSurfaceRowsScalar.clean(above.begin(), row.begin(), below.begin(), expected.begin(), count, rule);
        for (const Body& body : all) {
          body.rows.clean(above.begin(), row.begin(), below.begin(), got.begin(), count, rule);
          EXPECT_TRUE(same()) << body.name << " clean " << count;
        }
        kSurfaceRowsScalar.smooth(above.begin(), row.begin(), below.begin(), expected.begin(), count, rule);
        for (const Body& body : all) {
          body.rows.smooth(above.begin(), row.begin(), below.begin(), got.begin(), count, rule);
          EXPECT_TRUE(same()) << body.name << " smooth " << count;
        }
      }
  }
}

TEST(SurfaceRows, BodiesWriteNoFartherThanTheSlack) {
  const DiscontinuityRule rule(sensors()[0].camera, sensors()[0].description);
  std::vector<Body> all = bodies();
  all.push_back({"scalar", kSurfaceRowsScalar});
  for (const Body& body : all)
    for (std::size_t count = 1; count < 40; ++count) {
      Padded row(count, 8000), out(count, 12345);
      body.rows.smooth(row.begin(), row.begin(), row.begin(), out.begin(), count, rule);
      for (std::size_t i = 0; i < kRowSlack; ++i) EXPECT_EQ(out.all[i], 12345) << body.name;
      for (std::size_t i = count + 2 * kRowSlack; i < out.all.size(); ++i)
        EXPECT_EQ(out.all[i], 12345) << body.name;
    }
}

TEST(SurfaceRows, DepthIsExactToHalfAUnitAndThe16thBit) {
  for (const Sensor& sensor : sensors()) {
    const DepthScale scale(sensor.camera, sensor.description);
    Row raw(65536), depth(65536);
    for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = static_cast<std::uint16_t>(i);
    kSurfaceRowsScalar.convert(raw.data(), depth.data(), raw.size(), scale);
    for (std::size_t i = 0; i < raw.size(); ++i) {
      const double exact = static_cast<double>(i) / sensor.camera.depth_scale * kDepthUnitsPerMetre;
      if (depth[i] != 0) {
        ASSERT_NEAR(depth[i], exact, 0.501 + exact / (2 * scale.multiplier)) << i;
      } else {
        ASSERT_TRUE(exact < sensor.description.near_limit * kDepthUnitsPerMetre + 1.5 ||
                    exact > sensor.description.far_limit * kDepthUnitsPerMetre - 1.5)
            << i << " at scale " << sensor.camera.depth_scale;
      }
    }
  }
}

TEST(SurfaceRows, ReadingsBeyondTheSensorsRangeAreNone) {
  const Intrinsics camera{640, 480, 575, 575, 320, 240, 1000};
  SensorDescription sensor;
  sensor.near_limit = 0.4;
  sensor.far_limit = 3.0;
  const DepthScale scale(camera, sensor);
  const Row raw = {0, 1, 399, 400, 401, 2999, 3000, 3001, 8192, 65535};
  Row out(raw.size());
  kSurfaceRowsScalar.convert(raw.data(), out.data(), raw.size(), scale);
  EXPECT_EQ(out, (Row{0, 0, 0, 3200, 3208, 23992, 24000, 0, 0, 0}));
}

TEST(SurfaceRows, LimitFollowsNoiseAndSlope) {
  for (const Sensor& sensor : sensors()) {
    const DiscontinuityRule rule(sensor.camera, sensor.description);
    const double pixel = 1 / std::min(sensor.camera.fx, sensor.camera.fy);
    for (int z8 = 0; z8 <= 64000; z8 += 7) {
      const double z = z8 / kDepthUnitsPerMetre;
      const double exact = (4 * sensor.description.sigma(z) + 3.732 * pixel * z) * kDepthUnitsPerMetre;
      const double expected = std::min({exact, 4095.0, std::max(z8 - 1.0, 0.0)});
      // three products, each cut to a unit, one of them shifted by up to three bits, and factors of 16 bits
      ASSERT_NEAR(rule.limit(static_cast<std::uint16_t>(z8)), expected, 12 + expected * 0.02) << z8;
      if (sensor.description.noise_growth > 0.01) continue;
      ASSERT_NEAR(rule.limit(static_cast<std::uint16_t>(z8)), expected, 4 + expected * 0.002) << z8;
    }
  }
}

TEST(SurfaceRows, SmoothingIsAsGoodAsInDoublePrecision) {
  // Signal to noise of the integer mean against the same mean in double precision.
  const Sensor sensor = sensors()[0];
  const DiscontinuityRule rule(sensor.camera, sensor.description);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 12);
  constexpr std::size_t kCount = 4096;
  Padded rows[3] = {Padded(kCount), Padded(kCount), Padded(kCount)};
  for (int r = 0; r < 3; ++r)
    for (std::size_t i = 0; i < rows[r].all.size(); ++i)
      rows[r].all[i] =
          static_cast<std::uint16_t>(7000 + 2 * static_cast<int>(i % 512) + 3 * r + noise(random));
  Padded out(kCount);
  kSurfaceRowsScalar.smooth(rows[0].begin(), rows[1].begin(), rows[2].begin(), out.begin(), kCount, rule);
  double signal = 0, error = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double z = rows[1].begin()[i], limit = rule.limit(rows[1].begin()[i]);
    double sum = 0;
    int count = 0;
    for (Padded& row : rows)
      for (int k = -1; k <= 1; ++k) {
        const double x = *(row.begin() + static_cast<std::ptrdiff_t>(i) + k);
        if (std::fabs(x - z) > limit) continue;
        sum += x;
        ++count;
      }
    const double exact = sum / count;
    ASSERT_NEAR(out.begin()[i], exact, 0.63);
    signal += exact * exact;
    error += (out.begin()[i] - exact) * (out.begin()[i] - exact);
  }
  EXPECT_GT(10 * std::log10(signal / error), 80.0);  // dB
}

TEST(SurfaceRows, BodyFollowsTheSetting) {
  EXPECT_EQ(simd_body(Kernels::scalar), SimdBody::scalar);
  const CpuFeatures has = cpu_features();
  EXPECT_EQ(simd_body(Kernels::sse), has.sse41 ? SimdBody::sse41 : SimdBody::scalar);
  EXPECT_EQ(simd_body(Kernels::avx2), has.avx2 ? SimdBody::avx2 : SimdBody::scalar);
  EXPECT_EQ(simd_body(Kernels::neon), has.neon ? SimdBody::neon : SimdBody::scalar);
  EXPECT_EQ(simd_body(Kernels::automatic) == SimdBody::scalar, bodies().empty());
}

}  // namespace
}  // namespace pliant
