#include "firmware-app/outputs/run_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace pliant {
namespace {

TEST(RunReport, StatsHoldEveryKeyOfTheContract) {
  RunFigures figures;
  figures.tracked = 3;
  figures.lost = 2;
  figures.searching = 1;
  figures.dropped = 4;
  figures.bad_frames = 5;
  figures.sent.failures = 6;
  figures.output_sha256 = "00ff";
  figures.latency.add(1'234'567);
  const nlohmann::json stats = nlohmann::json::parse(stats_json(figures));
  EXPECT_EQ(stats["frames"], 6);
  EXPECT_EQ(stats["tracked"], 3);
  EXPECT_EQ(stats["lost"], 2);
  EXPECT_EQ(stats["searching"], 1);
  EXPECT_EQ(stats["dropped"], 4);
  EXPECT_EQ(stats["bad_frames"], 5);
  EXPECT_EQ(stats["send_failures"], 6);
  for (const char* stage :
       {"surface", "predict", "associate", "align", "label", "regroup", "deform", "detect", "total"})
    for (const char* figure : {"median_us", "p99_us", "max_us"})
      EXPECT_TRUE(stats["stages"][stage].contains(figure)) << stage << " " << figure;
  EXPECT_NEAR(stats["latency_us"]["median_us"].get<double>(), 1234.6, 13);
  for (const char* key :
       {"heap_calls_after_start", "page_faults_after_start", "workspace_bytes", "rss_bytes"})
    EXPECT_TRUE(stats.contains(key)) << key;
  EXPECT_EQ(stats["output_sha256"], "00ff");
}

TEST(RunReport, WithoutAHeapWatchThereIsNoFigure) {
  RunFigures figures;
  figures.heap_watched = false;
  EXPECT_TRUE(nlohmann::json::parse(stats_json(figures))["heap_calls_after_start"].is_null());
  EXPECT_NE(closing_table(figures).find("not counted"), std::string::npos);
}

TEST(RunReport, StatusLineTellsStateAndPlace) {
  LiveFigures live;
  live.frame = 9;
  live.frames = 10;
  live.tracked = 8;
  live.state = TrackState::tracking;
  live.regions = 2;
  live.last_total_ns = 2'500'000;
  const std::string line = status_line(live, 300);
  EXPECT_EQ(line, "frame 10/300  tracking  2 regions, confidence 0.00  2.50 ms  tracked 8 of 10");
}

}  // namespace
}  // namespace pliant
