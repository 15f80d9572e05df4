// Every kind of damage to a model image: refused with its own word, never a crash.
#include <cstring>
#include <functional>
#include <initializer_list>
#include <limits>

#include "drivers/model_files/model_image.hpp"
#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;
using Image = std::vector<std::byte>;

const Image& good_image() {
  static const Image image = make(shapes::cushion_with_knob(), {1, 0.02}).built.image;
  return image;
}

ModelFault fault_of(std::span<const std::byte> image) {
  ModelView view;
  const ModelFault fault = ModelView::open(image, view);
  EXPECT_EQ(view.empty(), fault != ModelFault::none);
  return fault;
}

/// The good image with a changed header and the checksum that goes with it.
ModelFault with_header(const std::function<void(ModelHeader&)>& change) {
  Image image = good_image();
  ModelHeader header;
  std::memcpy(&header, image.data(), sizeof header);
  change(header);
  std::memcpy(image.data(), &header, sizeof header);
  seal_model_image(image);
  return fault_of(image);
}

/// The same with the first item of the section at `offset` changed.
template <typename T>
ModelFault with_item(std::uint64_t ModelHeader::*offset, const std::function<void(T&)>& change) {
  Image image = good_image();
  ModelHeader header;
  std::memcpy(&header, image.data(), sizeof header);
  T item;
  std::memcpy(&item, image.data() + header.*offset, sizeof item);
  change(item);
  std::memcpy(image.data() + header.*offset, &item, sizeof item);
  seal_model_image(image);
  return fault_of(image);
}

TEST(ModelDamage, TheUndamagedImageIsWell) {
  EXPECT_EQ(fault_of(good_image()), ModelFault::none);
  EXPECT_EQ(with_header([](ModelHeader&) {}), ModelFault::none);
}

TEST(ModelDamage, CutShortAnywhere) {
  const std::span<const std::byte> image = good_image();
  for (std::size_t length = 0; length < image.size(); length += 97) {
    const ModelFault fault = fault_of(image.first(length));
    EXPECT_EQ(fault, length < 8 ? ModelFault::too_short : ModelFault::truncated) << length;
  }
  Image longer = good_image();
  longer.resize(longer.size() + 8);
  EXPECT_EQ(fault_of(longer), ModelFault::corrupt);
}

TEST(ModelDamage, EveryFlippedBitIsNoticed) {
  Image image = good_image();
  // All of the header and the first points, then a sample of the rest.
  for (std::size_t byte = 0; byte < image.size(); byte += byte < 512 ? 1 : 1009)
    for (int bit = 0; bit < 8; bit += byte < 512 ? 1 : 3) {
      image[byte] ^= std::byte{1} << bit;
      EXPECT_NE(fault_of(image), ModelFault::none) << "byte " << byte << " bit " << bit;
      image[byte] ^= std::byte{1} << bit;
    }
}

TEST(ModelDamage, OtherMachinesAndVersions) {
  EXPECT_EQ(with_header([](ModelHeader& h) { h.byte_order = 0x04030201; }), ModelFault::foreign_byte_order);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.byte_order = 0x02010403; }), ModelFault::corrupt);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.version += 1; }), ModelFault::newer_version);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.version -= 1; }), ModelFault::older_version);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.magic[0] = 'X'; }), ModelFault::not_a_model);
}

TEST(ModelDamage, CountsOverTheLimitsWithTheRightChecksum) {
  EXPECT_EQ(with_header([](ModelHeader& h) { h.point_count = limits::kMaxModelPoints + 1; }),
            ModelFault::over_limit);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.point_count = 0xFFFFFFFF; }), ModelFault::over_limit);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.keypoint_count = limits::kMaxModelKeypoints + 1; }),
            ModelFault::over_limit);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.point_count = limits::kMaxModelPoints; }),
            ModelFault::corrupt);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.keypoint_count = limits::kMaxModelKeypoints; }),
            ModelFault::corrupt);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.point_count = 0; }), ModelFault::corrupt);
  EXPECT_EQ(with_header([](ModelHeader& h) { h.keypoint_count = 0; }), ModelFault::corrupt);

  const std::pair<std::uint32_t ModelHeader::*, std::size_t> network[] = {
      {&ModelHeader::patch_count, limits::kMaxPatches},
      {&ModelHeader::surface_link_count, limits::kMaxBorders},
      {&ModelHeader::body_link_count, limits::kMaxBodyLinks}};
  for (const auto& limit : network) {
    const auto with_count = [count = limit.first](std::size_t n) {
      return with_header([&](ModelHeader& h) { h.*count = static_cast<std::uint32_t>(n); });
    };
    EXPECT_EQ(with_count(limit.second + 1), ModelFault::over_limit);
    EXPECT_EQ(with_count(0xFFFFFFFF), ModelFault::over_limit);
    EXPECT_EQ(with_count(limit.second), ModelFault::corrupt);
  }
  EXPECT_EQ(with_header([](ModelHeader& h) { h.patch_count = 0; }), ModelFault::corrupt);
  EXPECT_EQ(with_header([](ModelHeader& h) { --h.patch_count; }), ModelFault::corrupt);
}

TEST(ModelDamage, OffsetsThatLeadElsewhere) {
  for (const auto offset :
       {&ModelHeader::positions_offset, &ModelHeader::normals_offset, &ModelHeader::neighbours_offset,
        &ModelHeader::descriptors_offset, &ModelHeader::frames_offset, &ModelHeader::patch_of_offset,
        &ModelHeader::blends_offset, &ModelHeader::patches_offset, &ModelHeader::surface_links_offset,
        &ModelHeader::body_links_offset})
    for (const std::uint64_t wrong : std::initializer_list<std::uint64_t>{
             0, 64, 257, good_image().size() - 64, good_image().size(), good_image().size() + 64,
             std::uint64_t{1} << 63, std::numeric_limits<std::uint64_t>::max() - 63})
      EXPECT_EQ(with_header([&](ModelHeader& h) { h.*offset = wrong; }), ModelFault::corrupt) << wrong;
}

TEST(ModelDamage, NumbersThatMakeNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinite = std::numeric_limits<double>::infinity();
  for (const auto member : {&ModelHeader::spacing, &ModelHeader::support_radius, &ModelHeader::radius,
                            &ModelHeader::patch_radius})
    for (const double wrong : {nan, infinite, -infinite, 0.0, -1.0})
      EXPECT_EQ(with_header([&](ModelHeader& h) { h.*member = wrong; }), ModelFault::corrupt);
  EXPECT_EQ(with_header([&](ModelHeader& h) { h.centre[1] = nan; }), ModelFault::corrupt);
  EXPECT_EQ(with_header([&](ModelHeader& h) { h.lowest[2] = h.highest[2] + 1; }), ModelFault::corrupt);
  EXPECT_EQ(with_header([&](ModelHeader& h) { h.characterisability = 2; }), ModelFault::corrupt);
  EXPECT_EQ(with_header([&](ModelHeader& h) { h.ambiguity = 77; }), ModelFault::corrupt);
  for (const double wrong : {nan, infinite, -0.01, 1.01})
    EXPECT_EQ(with_header([&](ModelHeader& h) { h.material = wrong; }), ModelFault::corrupt);

  for (const float wrong :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 100.0F})
    EXPECT_EQ(with_item<Point3f>(&ModelHeader::positions_offset, [&](Point3f& p) { p.y = wrong; }),
              ModelFault::corrupt);
  EXPECT_EQ(with_item<Normal16>(&ModelHeader::normals_offset, [](Normal16& n) { n = {}; }),
            ModelFault::corrupt);
  EXPECT_EQ(with_item<Normal16>(&ModelHeader::normals_offset,
                                [](Normal16& n) {
                                  n = {-32768, -32768, -32768, 0};
                                }),
            ModelFault::corrupt);
  EXPECT_EQ(with_item<std::uint16_t>(&ModelHeader::neighbours_offset, [](std::uint16_t& n) { n = 0xFFFE; }),
            ModelFault::corrupt);
  EXPECT_EQ(with_item<Descriptor>(&ModelHeader::descriptors_offset, [](Descriptor& d) { d.bins[7] = -1; }),
            ModelFault::corrupt);
  EXPECT_EQ(with_item<LocalFrame>(&ModelHeader::frames_offset, [](LocalFrame& f) { f.axes[8] = 32767; }),
            ModelFault::corrupt);
}

TEST(ModelDamage, SizesThatDoNotFitTheBox) {
  ModelView good;
  ASSERT_EQ(ModelView::open(good_image(), good), ModelFault::none);
  const double radius = good.radius();
  for (int i = 0; i < 3; ++i) {
    for (const double off : {-1e-9, -1.0, -1e300})
      EXPECT_EQ(with_header([&](ModelHeader& h) { h.centre[i] = h.lowest[i] + off; }), ModelFault::corrupt);
    for (const double off : {1e-9, 1.0, 1e300})
      EXPECT_EQ(with_header([&](ModelHeader& h) { h.centre[i] = h.highest[i] + off; }), ModelFault::corrupt);
    EXPECT_EQ(with_header([&](ModelHeader& h) { h.lowest[i] = -1e300, h.highest[i] = 1e300; }),
              ModelFault::corrupt);
  }
  for (const double wrong : {2.001 * radius, 1.0, 1e10, 1e300})
    EXPECT_EQ(with_header([&](ModelHeader& h) { h.spacing = wrong; }), ModelFault::corrupt) << wrong;
  for (const double wrong : {4 * radius, 10.0, 1e300})  // the box's diagonal is up to √12 of the radius
    EXPECT_EQ(with_header([&](ModelHeader& h) { h.spacing = h.radius = wrong; }), ModelFault::corrupt)
        << wrong;
}

TEST(ModelDamage, DescriptorsLongerThanTheMatcherTakes) {
  const auto descriptor = [](int bins, int value, int more) {
    return with_item<Descriptor>(&ModelHeader::descriptors_offset, [&](Descriptor& d) {
      d.bins.fill(0);
      for (int i = 0; i < bins; ++i) d.bins[static_cast<std::size_t>(i)] = static_cast<std::int8_t>(value);
      d.bins[351] = static_cast<std::int8_t>(more);
    });
  };
  EXPECT_EQ(descriptor(0, 0, 0), ModelFault::none);        // of a keypoint without a frame
  EXPECT_EQ(descriptor(1, 127, 49), ModelFault::none);     // 18,530
  EXPECT_EQ(descriptor(1, 127, 50), ModelFault::corrupt);  // 18,629
  EXPECT_EQ(descriptor(351, 7, 37), ModelFault::none);     // 18,568
  EXPECT_EQ(descriptor(351, 7, 38), ModelFault::corrupt);  // 18,643
  EXPECT_EQ(descriptor(351, 127, 127), ModelFault::corrupt);
}

TEST(ModelDamage, PatchesThatAreNotThereOrOtherThanTheySay) {
  const auto count = [] {
    ModelView view;
    EXPECT_EQ(ModelView::open(good_image(), view), ModelFault::none);
    return static_cast<std::uint8_t>(view.patches().size());
  }();
  EXPECT_EQ(with_item<std::uint8_t>(&ModelHeader::patch_of_offset, [&](std::uint8_t& p) { p = count; }),
            ModelFault::corrupt);
  EXPECT_EQ(with_item<std::uint8_t>(&ModelHeader::patch_of_offset, [](std::uint8_t& p) { ++p; }),
            ModelFault::corrupt)
      << "the patches' sizes do not fit it";

  const auto patch = [](const std::function<void(ModelPatch&)>& change) {
    return with_item<ModelPatch>(&ModelHeader::patches_offset, change);
  };
  EXPECT_EQ(patch([](ModelPatch& p) { p.points = 0; }), ModelFault::corrupt);
  EXPECT_EQ(patch([](ModelPatch& p) { ++p.points; }), ModelFault::corrupt);
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, 100.0})
    EXPECT_EQ(patch([&](ModelPatch& p) { p.centre[2] = wrong; }), ModelFault::corrupt) << wrong;

  const auto blend = [](const std::function<void(PointBlend&)>& change) {
    return with_item<PointBlend>(&ModelHeader::blends_offset, change);
  };
  for (std::size_t j = 0; j < 4; ++j)
    EXPECT_EQ(blend([&](PointBlend& b) { b.patch[j] = count; }), ModelFault::corrupt) << j;
  EXPECT_EQ(blend([](PointBlend& b) { ++b.weight[0]; }), ModelFault::corrupt);
  EXPECT_EQ(blend([](PointBlend& b) { b.weight = {0, 0, 0, 0}; }), ModelFault::corrupt);
  EXPECT_EQ(blend([](PointBlend& b) { b.weight = {0, 128, 0, 0}; }), ModelFault::corrupt);
  EXPECT_EQ(blend([](PointBlend& b) { b.weight = {255, 129, 0, 0}; }), ModelFault::corrupt);
  EXPECT_EQ(blend([](PointBlend& b) { b.weight = {128, 0, 0, 0}; }), ModelFault::none);
}

template <typename Link>
void expect_damage_is_told(std::uint64_t ModelHeader::*offset, std::uint32_t ModelHeader::*count) {
  const auto damaged = [&](const std::function<void(Link&)>& change) {
    return with_item<Link>(offset, change);
  };
  ASSERT_EQ(damaged([](Link&) {}), ModelFault::none);
  EXPECT_EQ(damaged([](Link& l) { std::swap(l.a, l.b); }), ModelFault::corrupt);
  EXPECT_EQ(damaged([](Link& l) { l.a = l.b; }), ModelFault::corrupt);
  EXPECT_EQ(damaged([](Link& l) { l.b = 255; }), ModelFault::corrupt);
  EXPECT_EQ(damaged([](Link& l) { l.a = 1, l.b = 200; }), ModelFault::corrupt) << "not in order";
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 0.0, -0.01, 100.0})
    EXPECT_EQ(damaged([&](Link& l) { l.length = wrong; }), ModelFault::corrupt) << wrong;
  // Twice the same.
  Image image = good_image();
  ModelHeader header;
  std::memcpy(&header, image.data(), sizeof header);
  ASSERT_GE(header.*count, 2U);
  std::memcpy(image.data() + header.*offset + sizeof(Link), image.data() + header.*offset, sizeof(Link));
  seal_model_image(image);
  EXPECT_EQ(fault_of(image), ModelFault::corrupt);
}

TEST(ModelDamage, LinksThatHoldNothingTogether) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_damage_is_told<SurfaceLink>(&ModelHeader::surface_links_offset, &ModelHeader::surface_link_count);
  const auto along = [](const std::function<void(SurfaceLink&)>& change) {
    return with_item<SurfaceLink>(&ModelHeader::surface_links_offset, change);
  };
  EXPECT_EQ(along([](SurfaceLink& l) { l.edges = 0; }), ModelFault::corrupt);
  EXPECT_EQ(along([](SurfaceLink& l) { l.edges = 0xFFFFFFFF; }), ModelFault::corrupt);
  EXPECT_EQ(along([&](SurfaceLink& l) { l.centre[0] = nan; }), ModelFault::corrupt);
  EXPECT_EQ(along([](SurfaceLink& l) { l.centre[1] = -100; }), ModelFault::corrupt);

  expect_damage_is_told<BodyLink>(&ModelHeader::body_links_offset, &ModelHeader::body_link_count);
  const auto across = [](const std::function<void(BodyLink&)>& change) {
    return with_item<BodyLink>(&ModelHeader::body_links_offset, change);
  };
  EXPECT_EQ(across([](BodyLink& l) { l.looks = 0; }), ModelFault::corrupt);
  EXPECT_EQ(across([](BodyLink& l) { l.looks = 0xFFFFFFFF; }), ModelFault::corrupt);
  EXPECT_EQ(across([&](BodyLink& l) { l.middle[0] = nan; }), ModelFault::corrupt);
  EXPECT_EQ(across([](BodyLink& l) { l.middle[2] = 100; }), ModelFault::corrupt);
}

TEST(ModelDamage, EveryFaultHasItsLine) {
  for (int fault = 0; fault <= static_cast<int>(ModelFault::over_limit); ++fault) {
    const std::string line = describe(static_cast<ModelFault>(fault));
    EXPECT_FALSE(line.empty());
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant
