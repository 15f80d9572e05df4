// What is tracked arrives at a subscriber, by way of an LCM log file, which needs no network.
#include <algorithm>
#include <filesystem>

#include "drivers/lcm/subscriber.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "tests/integration/run.hpp"

namespace pliant::test {
namespace {

TEST(Messages, EveryFrameArrivesWhole) {
  const std::string log =
      (std::filesystem::path(testing::TempDir()) / "pliant_messages_test.lcmlog").string();
  auto source = open_simulated("simulated:cushion?frames=60&width=320&height=240");
  ASSERT_TRUE(source);
  auto built = build_model((*source)->mesh(), {});
  ASSERT_TRUE(built);
  const auto model = ModelFile::from_image(std::move(built->image), "cushion");
  ASSERT_TRUE(model);
  RunSettings settings = quiet_settings(**source);
  settings.lcm_url = "file://" + log + "?mode=w";
  settings.lcm_prefix = "TEST";
  const auto end = run_pipeline(**source, model->view(), settings);
  ASSERT_TRUE(end) << end.error().message;

  std::int64_t frames = 0, tracking = 0, labels = 0;
  float most_strain = 0, energy = -1;
  TrackState last_status = TrackState::searching;
  LcmSubscriber::Handlers handlers;
  handlers.regions = [&](const RegionsMessage& message) {
    EXPECT_EQ(message.frame, frames);
    ++frames;
    tracking += message.state == TrackState::tracking ? 1 : 0;
    labels += static_cast<std::int64_t>(message.labels.size());
  };
  handlers.deformed = [&](const DeformedMessage& message) {
    for (const float strain : message.strain) most_strain = std::max(most_strain, strain);
  };
  handlers.status = [&](const StatusMessage& message) {
    last_status = message.state;
    energy = message.strain_energy;
    EXPECT_EQ(message.stages.back().name, "total");
  };
  auto subscriber = LcmSubscriber::create("file://" + log + "?speed=0", "TEST", handlers);
  ASSERT_TRUE(subscriber) << subscriber.error().message;
  while ((*subscriber)->handle(100) > 0) {
  }
  const LcmSubscriber::Counters& counters = (*subscriber)->counters();
  EXPECT_EQ(counters.garbage, 0);
  EXPECT_EQ(frames, 60);
  EXPECT_EQ(tracking, end->figures.tracked);
  EXPECT_EQ(counters.of(MessageKind::pose), end->figures.tracked);
  EXPECT_EQ(labels, end->figures.tracked * static_cast<std::int64_t>(model->view().size()));
  EXPECT_EQ(last_status, TrackState::tracking);
  EXPECT_GT(most_strain, 0) << "the cushion is pressed";
  EXPECT_GT(energy, 0);
  EXPECT_EQ(energy, end->figures.last_strain_energy);
  EXPECT_EQ(end->figures.sent.unsent, 0);
  EXPECT_GT(end->figures.latency.count(), 0U);
  std::filesystem::remove(log);
}

}  // namespace
}  // namespace pliant::test
