// What the person who shows the object is told.
#include <gtest/gtest.h>

#include "firmware-app/commands/capture_guide.hpp"

namespace pliant::test {
namespace {

CaptureStatus fine() {
  CaptureStatus status;
  status.state = CaptureState::capturing;
  status.agreement = 0.97;
  status.rms = 0.0008;
  status.distance = 0.6;
  return status;
}

/// The camera at `turns` around the object, 0 being the first view, at a height of `height` metres at 0.6 m.
RigidTransform seen_from(double x, double y, double height) {
  RigidTransform model_from_camera;
  model_from_camera.translation = Vector3(x, y, height);
  return model_from_camera.inverse();
}

Coverage seen_from_all_but_the_back() {
  Coverage coverage;
  const double h = 0.42;
  for (int i = 0; i < 5; ++i)
    for (const auto& [x, y] :
         {std::pair{0.0, -0.6}, {h, -h}, {0.6, 0.0}, {h, h}, {-h, h}, {-0.6, 0.0}, {-h, -h}})
      coverage.add(seen_from(x, y, 0.3));
  return coverage;
}

std::string after(CaptureGuide& guide, const CaptureStatus& status, const Coverage& coverage, int pictures) {
  std::string advice;
  for (int i = 0; i < pictures; ++i) {
    guide.take(status, coverage);
    if (const std::string now = guide.advice(); !now.empty()) advice = now;
  }
  return advice;
}

TEST(CaptureGuide, NamesTheSideThatIsMissing) {
  const Coverage coverage = seen_from_all_but_the_back();
  EXPECT_EQ(sides_missing(coverage), "the back");
  CaptureGuide guide(30);
  guide.take(fine(), coverage);
  EXPECT_NE(guide.line().find("7 of 8 sides, not the back"), std::string::npos) << guide.line();
  EXPECT_EQ(guide.line().find("never from above"), std::string::npos) << guide.line();
  Coverage all = coverage;
  for (int i = 0; i < 5; ++i) all.add(seen_from(0, 0.6, 0.3));
  EXPECT_EQ(sides_missing(all), "");
  EXPECT_NE(after(guide, fine(), all, 30).find("enough"), std::string::npos);
}

TEST(CaptureGuide, TheFirstViewIsTheFrontAndItsRightIsTheRight) {
  Coverage coverage;
  for (int i = 0; i < 3; ++i) coverage.add(seen_from(0, -0.6, 0.1));
  EXPECT_TRUE(coverage.seen(0));
  EXPECT_EQ(coverage.sectors_seen(), 1);
  EXPECT_FALSE(coverage.seen_from_above());
  for (int i = 0; i < 3; ++i) coverage.add(seen_from(0.6, 0, 0.1));
  EXPECT_EQ(sides_missing(coverage).find("the right,"), std::string::npos) << sides_missing(coverage);
  EXPECT_NE(sides_missing(coverage).find("the left"), std::string::npos);
}

TEST(CaptureGuide, SaysWhatIsWrong) {
  const Coverage coverage;
  const auto advice = [&](auto change) {
    CaptureGuide guide(30);
    CaptureStatus status = fine();
    change(status);
    return after(guide, status, coverage, 20);
  };
  EXPECT_NE(advice([](CaptureStatus& s) { s.too_fast = true; }).find("too fast"), std::string::npos);
  EXPECT_NE(advice([](CaptureStatus& s) { s.too_far = true; }).find("too far"), std::string::npos);
  EXPECT_NE(advice([](CaptureStatus& s) { s.too_large = true; }).find("--size"), std::string::npos);
  EXPECT_NE(advice([](CaptureStatus& s) { s.against = true; }).find("left out"), std::string::npos);
  EXPECT_NE(advice([](CaptureStatus& s) { s.state = CaptureState::lost; }).find("lost"), std::string::npos);
  EXPECT_NE(advice([](CaptureStatus& s) { s.state = CaptureState::waiting; }).find("nothing stands"),
            std::string::npos);
  EXPECT_EQ(advice([](CaptureStatus&) {}), "");
}

TEST(CaptureGuide, SaysThatItIsFeaturelessOnlyWhenItWillNotShowByItself) {
  const Coverage coverage;
  const auto advice = [&](double standing, int pictures) {
    CaptureGuide guide(30);
    CaptureStatus status = fine();
    status.featureless = true;
    status.standing = standing;
    return after(guide, status, coverage, pictures);
  };
  EXPECT_EQ(advice(1, 45), "") << "nobody has turned it yet";
  EXPECT_NE(advice(1, 70).find("whether it turns cannot be seen; carry the sensor"), std::string::npos);
  EXPECT_NE(advice(0.1, 70).find("show a side with more shape"), std::string::npos);
}

TEST(CaptureGuide, SaysSoonThatWhatStoodOutWentOutOfSight) {
  CaptureGuide guide(30);
  const Coverage coverage;
  after(guide, fine(), coverage, 10);
  CaptureStatus status = fine();
  status.featureless = true;
  EXPECT_EQ(after(guide, status, coverage, 10), "");
  EXPECT_NE(after(guide, status, coverage, 10).find("show a side with more shape"), std::string::npos);
}

TEST(CaptureGuide, SaysInTheEndWhatAFeaturelessCaptureIsWorth) {
  CaptureFigures figures;
  figures.frames = figures.fused = 300;
  figures.featureless = 20;
  Coverage front;
  for (int i = 0; i < 3; ++i) front.add(seen_from(0, -0.6, 0.1));
  EXPECT_EQ(doubt_of_turning(figures, front), "");
  figures.longest_unheld = 40;
  const std::string gap = doubt_of_turning(figures, seen_from_all_but_the_back());
  EXPECT_NE(gap.find("for 40 pictures on end"), std::string::npos) << gap;
  figures.featureless = 298;
  const std::string doubt = doubt_of_turning(figures, front);
  EXPECT_NE(doubt.find("in 298 of 300 pictures"), std::string::npos) << doubt;
  EXPECT_NE(doubt.find("smeared"), std::string::npos) << doubt;
  const std::string round = doubt_of_turning(figures, seen_from_all_but_the_back());
  EXPECT_EQ(round.find("smeared"), std::string::npos) << round;
  EXPECT_NE(round.find("Compare the surface"), std::string::npos) << round;
}

TEST(CaptureGuide, DoesNotChatter) {
  CaptureGuide guide(30);
  CaptureStatus fast = fine();
  fast.too_fast = true;
  const Coverage coverage;
  int said = 0;
  for (int i = 0; i < 120; ++i) {  // four seconds
    guide.take(i % 40 < 3 ? fine() : fast, coverage);
    said += guide.advice().empty() ? 0 : 1;
  }
  EXPECT_EQ(said, 1);
  guide.take(fine(), coverage);
  EXPECT_EQ(guide.advice(), "") << "a reason of one picture is none";
}

}  // namespace
}  // namespace pliant::test
