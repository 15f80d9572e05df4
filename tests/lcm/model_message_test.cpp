// The announced model: what arrives is the model, and nothing else passes for one.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "drivers/lcm/frame_assembler.hpp"
#include "drivers/lcm/model_messages.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "drivers/simulated/simulated.hpp"
#include "pliant/model_t.hpp"

namespace pliant {
namespace {

const ModelView& cushion() {
  static const ModelFile kFile = [] {
    auto source = open_simulated("simulated:cushion");
    auto built = build_model((*source)->mesh(), {});
    return std::move(*ModelFile::from_image(std::move(built->image), "cushion"));
  }();
  return kFile.view();
}

TEST(ModelMessages, AModelComesBackFromItsPartsInAnyOrder) {
  const ModelView& model = cushion();
  const ModelMessages messages(model);
  const auto bodies = messages.bodies();
  EXPECT_EQ(bodies.size(), (model.size() + 1699) / 1700);
  ModelAssembler assembler;
  for (std::size_t i = bodies.size(); i-- > 0;) {
    EXPECT_LE(bodies[i].bytes.size(), kMaxMessageBytes);
    ModelMessage message;
    ASSERT_TRUE(decode(bodies[i].bytes, message));
    EXPECT_EQ(assembler.take(message), i == 0);
    if (i == 0) {
      EXPECT_FALSE(assembler.take(message)) << "a model is told once";
    }
  }
  const ReceivedModel& got = assembler.model();
  EXPECT_EQ(static_cast<std::uint64_t>(got.model_id), model.header().checksum);
  EXPECT_FLOAT_EQ(got.spacing, static_cast<float>(model.spacing()));
  ASSERT_EQ(got.points.size(), model.size());
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Point3f& p = model.positions()[i];
    const Point3f& q = got.points[i];
    // Half a step (a 65,535th of the largest extent) along each axis.
    ASSERT_LT(std::hypot(p.x - q.x, p.y - q.y, p.z - q.z), 3e-5F * static_cast<float>(model.header().radius));
    const Normal16& n = model.normals()[i];
    const Point3f& m = got.normals[i];
    ASSERT_NEAR(static_cast<float>(n.x) / 16384, m.x, 0.005F);
    ASSERT_NEAR(static_cast<float>(n.y) / 16384, m.y, 0.005F);
    ASSERT_NEAR(static_cast<float>(n.z) / 16384, m.z, 0.005F);
  }
}

TEST(ModelMessages, TheGeneratedClassReadsTheSame) {
  const ModelMessages messages(cushion());
  const MessageBody& last = messages.bodies().back();
  ModelMessage ours;
  ASSERT_TRUE(decode(last.bytes, ours));
  model_t theirs;
  ASSERT_EQ(theirs.decode(last.bytes.data(), 0, static_cast<int>(last.bytes.size())),
            static_cast<int>(last.bytes.size()));
  EXPECT_EQ(theirs.model_id, ours.model_id);
  EXPECT_EQ(theirs.part, ours.part);
  EXPECT_EQ(theirs.parts, ours.parts);
  EXPECT_EQ(theirs.model_points, ours.model_points);
  EXPECT_EQ(theirs.first_point, ours.first_point);
  ASSERT_EQ(static_cast<std::size_t>(theirs.num_points), ours.position.size());
  for (std::size_t i = 0; i < ours.position.size(); ++i) {
    ASSERT_FLOAT_EQ(theirs.origin[1] + theirs.step * static_cast<float>(theirs.position[i][1]),
                    ours.position[i].y);
    ASSERT_FLOAT_EQ(static_cast<float>(theirs.normal[i][2]) / 127, ours.normal[i].z);
  }
  std::vector<std::uint8_t> again(static_cast<std::size_t>(theirs.getEncodedSize()));
  ASSERT_EQ(theirs.encode(again.data(), 0, static_cast<int>(again.size())), static_cast<int>(again.size()));
  EXPECT_EQ(again, std::vector<std::uint8_t>(last.bytes.begin(), last.bytes.end()));
}

TEST(ModelMessages, WhatIsCutShortOrOutOfRangeIsRefused) {
  const ModelMessages messages(cushion());
  const auto whole = messages.bodies().front().bytes;
  std::vector<std::uint8_t> body(whole.begin(), whole.end());
  ModelMessage message;
  for (std::size_t size = 0; size < body.size(); size += size < 80 ? 1 : 97)
    EXPECT_FALSE(decode(std::span(body).first(size), message)) << size;
  const auto with = [&](std::size_t at, std::uint8_t value) {
    std::vector<std::uint8_t> changed = body;
    changed[at] = value;
    return decode(changed, message);
  };
  EXPECT_TRUE(with(8, 77)) << "another model";
  EXPECT_FALSE(with(0, 0)) << "another type";
  EXPECT_FALSE(with(16, 0x80)) << "a part below zero";
  EXPECT_FALSE(with(20, 0x7F)) << "more points than a model may have";
  EXPECT_FALSE(with(24, 0x7F)) << "points beyond the model";
  EXPECT_FALSE(with(28, 0x7F)) << "more points than there are bytes";
  EXPECT_FALSE(with(32, 0xFF)) << "a spacing below zero";
  EXPECT_FALSE(with(48, 0xFF)) << "a step below zero";
}

}  // namespace
}  // namespace pliant
