// pliant devices, with and without something to list.
#include "tests/commands/program.hpp"
#include "tests/openni2/sensor_rig.hpp"

namespace pliant::test {
namespace {

TEST(Devices, ListsADeviceAndSaysWhatToCheckWhereThereIsNone) {
  const SensorRig rig;
  Ended ended = run_pliant({"devices"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("openni2:virtual/sensor@1/7  test virtual sensor"), std::string::npos)
      << ended.out;
  rig.control().plugged = 0;
  ended = run_pliant({"devices"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out.find("virtual/sensor"), std::string::npos) << ended.out;
  // What a machine with cameras of its own says is its own affair.
  if (ended.out.find("sources:") == std::string::npos &&
      ended.out.find("cannot be used:") == std::string::npos) {
    EXPECT_NE(ended.out.find("no depth device is seen. Check that"), std::string::npos) << ended.out;
  }
}

}  // namespace
}  // namespace pliant::test
