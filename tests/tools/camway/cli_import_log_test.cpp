// SPDX-License-Identifier: MIT
//
// Poses in logs of other programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <robot/pose_t.hpp>
#include <robot/track_t.hpp>

#include "tests/tools/camway/cli_runner.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// A robot that drives along -Z and turns about Y, a pose each millisecond.
robot::pose_t pose_at(int i) {
  robot::pose_t pose{};
  pose.utime = 1'700'000'000'000'000 + 1000 * i;
  pose.pos[2] = -0.01 * i;
  const double half_turn_rad = 0.005 * i;
  pose.quat[0] = std::cos(half_turn_rad);
  pose.quat[2] = std::sin(half_turn_rad);
  return pose;
}

class CliImportLog : public ::testing::Test {
 protected:
  CliImportLog() {
    for (int i = 0; i < 50; ++i) {
      log_.add_event("POSE", encoded(pose_at(i)));
      if (i % 10 == 0) log_.add_event("NOISE", {1, 2, 3});
    }
  }

  CliRun import(std::vector<std::string> flags) {
    const std::string file = folder_.write("drive.lcmlog", log_.bytes());
    std::vector<std::string> arguments{"import",   file,  "--fov-y-deg", "40",
                                       "--aspect", "1.5", "--request",   folder_.file("r.json")};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return run_camway(arguments);
  }
  [[nodiscard]] Json request() const { return Json::parse(read_all(folder_.file("r.json"))); }

  const std::string type_ = CAMWAY_LCM_SAMPLES_FOLDER "/robot_pose_t.lcm";
  const std::vector<std::string> pose_ = {"--channel",  "POSE", "--type",        type_,
                                          "--position", "pos",  "--orientation", "quat"};
  std::vector<std::string> with(std::vector<std::string> more) const {
    std::vector<std::string> flags = pose_;
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  }

  TemporaryFolder folder_;
  LogBuilder log_;
};

TEST_F(CliImportLog, EveryPoseBecomesAKeyframe) {
  const CliRun run = import(with({"--all"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("lcm, camera 'POSE': 50 poses, 1000 frames a second"));
  EXPECT_THAT(run.err, HasSubstr("its times are taken as us"));
  const Json keyframes = request()["keyframes"];
  ASSERT_EQ(keyframes.size(), 50U);
  for (int i = 0; i < 50; ++i) {
    const robot::pose_t pose = pose_at(i);
    const Json& keyframe = keyframes[static_cast<std::size_t>(i)];
    EXPECT_DOUBLE_EQ(keyframe["time"].get<double>(), static_cast<double>(pose.utime) * 1e-6);
    EXPECT_EQ(keyframe["position"][2].get<double>(), pose.pos[2]);
    EXPECT_NEAR(keyframe["orientation"][2].get<double>(), pose.quat[2], 1e-15);
  }
}

TEST_F(CliImportLog, TheRequestIsPlanned) {
  ASSERT_EQ(import(pose_).exit_code, 0);
  EXPECT_LT(request()["keyframes"].size(), 10U);
  const std::string scene = folder_.write("far.obj", "v 0 0 99\nv 1 0 99\nv 0 1 99\nf 1 2 3\n");
  const CliRun plan = run_camway({"plan", "--request", folder_.file("r.json"), "--scene", scene,
                                  "--response", folder_.file("a.json")});
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
}

TEST_F(CliImportLog, TakesComponentsOrdersAxesAndUnits) {
  const CliRun run = import({"--channel", "POSE", "--type", type_, "--position",
                             "pos[2],pos[0],pos[1]", "--orientation", "quat", "--quaternion",
                             "xyzw", "--camera-axes", "cv", "--time-unit", "ms", "--all"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json last = request()["keyframes"][49];
  EXPECT_EQ(last["position"][0].get<double>(), pose_at(49).pos[2]);
  EXPECT_DOUBLE_EQ(last["time"].get<double>(), static_cast<double>(pose_at(49).utime) * 1e-3);
  // (x, y, z, w) = quat, then half a turn about X: (w, x, y, z) (0, 1, 0, 0) = (-x, w, z, -y).
  const double sign = last["orientation"][0].get<double>() * -pose_at(49).quat[0] < 0 ? -1.0 : 1.0;
  EXPECT_NEAR(last["orientation"][0].get<double>(), -sign * pose_at(49).quat[0], 1e-12);
  EXPECT_NEAR(last["orientation"][2].get<double>(), sign * pose_at(49).quat[2], 1e-12);
}

TEST_F(CliImportLog, AListOfPosesInOneMessageIsAPath) {
  LogBuilder log;
  robot::track_t track{};
  track.poses = 20;
  for (int i = 0; i < track.poses; ++i) track.list.push_back(pose_at(i));
  track.names.assign(2, std::vector<std::string>(20));
  log.add_event("TRACK", encoded(track));
  log_ = log;
  const std::string type = CAMWAY_LCM_SAMPLES_FOLDER "/robot_track_t.lcm";
  const CliRun run = import({"--type", type, "--position", "list.pos", "--orientation", "list.quat",
                             "--time", "list.utime", "--all"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(request()["keyframes"].size(), 20U);
  const CliRun untimed =
      import({"--type", type, "--position", "list.pos", "--orientation", "list.quat"});
  ASSERT_EQ(untimed.exit_code, 0) << untimed.err;
  EXPECT_FALSE(request()["keyframes"][0].contains("time"));
}

TEST_F(CliImportLog, LeavesOutWhatIsDamagedAndSaysSo) {
  std::vector<std::uint8_t> broken = encoded(pose_at(50));
  broken.pop_back();
  log_.add_event("POSE", broken);
  log_.add_event("POSE", encoded(pose_at(10)));
  const std::size_t whole = log_.bytes().size();
  log_.add_event("POSE", encoded(pose_at(51)));
  CliRun run = import(with({"--all"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(
      run.err,
      HasSubstr("1 of its messages cannot be read and are left out: the message breaks off"));
  EXPECT_THAT(run.err,
              HasSubstr("1 of its 52 poses are not later than one before and are left out"));
  EXPECT_EQ(request()["keyframes"].size(), 51U);
  const std::string cut = folder_.write("cut.lcmlog", log_.bytes().substr(0, whole + 40));
  run = run_camway({"import", cut, "--channel", "POSE", "--type", type_, "--position", "pos",
                    "--orientation", "quat", "--all", "--fov-y-deg", "40", "--aspect", "1",
                    "--request", folder_.file("r.json")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("57 good events before it"));
  EXPECT_EQ(request()["keyframes"].size(), 50U);
}

TEST_F(CliImportLog, RefusesWhatDoesNotFit) {
  const auto expect_refused = [&](const std::vector<std::string>& flags, const std::string& words) {
    const CliRun run = import(flags);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(words));
  };
  expect_refused({}, "--type names the .lcm file of its messages");
  expect_refused({"--type", type_, "--position", "pos"}, "--orientation names the member");
  expect_refused(
      {"--type", type_, "--position", "pos", "--orientation", "quat"},
      "has several channels; --channel names one:\n  NOISE: 5 messages\n  POSE: 50 messages");
  expect_refused({"--channel", "NO", "--type", type_, "--position", "pos", "--orientation", "quat"},
                 "has no channel 'NO'");
  expect_refused(
      {"--channel", "NOISE", "--type", type_, "--position", "pos", "--orientation", "quat"},
      "the fingerprint of none");
  expect_refused({"--channel", "POSE", "--type", CAMWAY_LCM_SAMPLES_FOLDER "/none.lcm",
                  "--position", "pos", "--orientation", "quat"},
                 "--type: ");
  expect_refused(
      {"--channel", "POSE", "--type", type_, "--position", "place", "--orientation", "quat"},
      "has no member 'place'; it has utime, pos, quat, frame");
  expect_refused(
      {"--channel", "POSE", "--type", type_, "--position", "quat", "--orientation", "quat"},
      "--position has 4 numbers, not three for a pose");
  expect_refused(
      {"--channel", "POSE", "--type", type_, "--position", "pos,pos", "--orientation", "quat"},
      "name one array, or 3 numbers");
  const std::string table = folder_.write("x.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n");
  const CliRun run =
      run_camway({"import", table, "--channel", "POSE", "--request", folder_.file("r.json")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is no log of lcm-logger"));
}

TEST_F(CliImportLog, ABodyNeedsNoOrientation) {
  const CliRun run = import({"--channel", "POSE", "--type", type_, "--position", "pos", "--body",
                             R"({"type": "sphere", "radius_m": 0.1})"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("it is never turned"));
  EXPECT_THAT(run.err, Not(HasSubstr("--camera-axes")));
  EXPECT_EQ(request()["keyframes"][1]["orientation"], Json({1.0, 0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace camway::tools
