// SPDX-License-Identifier: MIT
//
// Poses in logs of other programs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <robot/pose_t.hpp>
#include <robot/track_t.hpp>

#include "tests/tools/camway/cli_runner.h"
#include "tests/tools/camway/replay/log_builder.h"
#include "tools/lcm_types/type_file.h"

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

/// A message of a struct of 8-byte members and one count of 4 bytes, as LCM has them on the wire.
class MessageBytes {
 public:
  MessageBytes(const LcmTypes& types, const std::string& name) {
    add(*lcm_fingerprint(types, name), 8);
  }
  void add(std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) {
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
  }
  void add(std::initializer_list<double> numbers) {
    for (const double number : numbers) add(std::bit_cast<std::uint64_t>(number), 8);
  }
  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// A planned path in one message, with the time when it was sent.
TEST_F(CliImportLog, OneTimeOfAListOfPosesIsNotTheTimeOfAny) {
  const std::string text =
      "struct path_t { int64_t utime; int32_t n; double pos[n][3]; double quat[n][4]; }";
  LcmTypes types;
  ASSERT_EQ(read_lcm_types(text, types), "");
  MessageBytes message(types, "path_t");
  message.add(1'700'000'000'000'000, 8);
  message.add(50, 4);
  for (int i = 0; i < 50; ++i) message.add({0.1 * i, 0.0, 0.0});
  for (int i = 0; i < 50; ++i) message.add({1.0, 0.0, 0.0, 0.0});
  log_ = LogBuilder();
  log_.add_event("PATH", message.bytes());
  const std::string type = folder_.write("path_t.lcm", text);
  const std::vector<std::string> flags = {"--type",        type,   "--position", "pos",
                                          "--orientation", "quat", "--all"};
  const CliRun untimed = import(flags);
  ASSERT_EQ(untimed.exit_code, 0) << untimed.err;
  EXPECT_THAT(untimed.err, HasSubstr("one time for a list of poses, which is not taken"));
  ASSERT_EQ(request()["keyframes"].size(), 50U);
  EXPECT_FALSE(request()["keyframes"][0].contains("time"));
  const auto with_flags = [&](std::vector<std::string> more) {
    more.insert(more.end(), flags.begin(), flags.end());
    return import(more);
  };
  const CliRun timed = with_flags({"--fps", "10"});
  ASSERT_EQ(timed.exit_code, 0) << timed.err;
  EXPECT_DOUBLE_EQ(request()["keyframes"][49]["time"].get<double>(), 4.9);
  const CliRun asked = with_flags({"--time", "utime"});
  EXPECT_EQ(asked.exit_code, 2);
  EXPECT_THAT(asked.err, HasSubstr("--time has 1 numbers for 50 poses"));
}

/// Poses of structs in a log, whose quaternions have the members `order`.
class CliImportStructs : public CliImportLog {
 protected:
  CliRun import_structs(const std::string& order, std::vector<std::string> flags,
                        const std::string& beside = "geo_vec3_t.lcm") {
    std::string members;
    for (const char c : order) members += fmt::format("double {}; ", c);
    const std::string vec3 = "package geo; struct vec3_t { double x, y, z; }";
    const std::string pose = "package geo; struct quat_t { " + members +
                             "} struct pose_t { vec3_t pos; quat_t q; } "
                             "struct place_t { int64_t utime; pose_t at; }";
    LcmTypes types;
    EXPECT_EQ(read_lcm_types(vec3, types), "");
    EXPECT_EQ(read_lcm_types(pose, types), "");
    log_ = LogBuilder();
    for (int i = 0; i < 3; ++i) {
      MessageBytes message(types, "geo.place_t");
      message.add(1'700'000'000'000'000 + 1000 * static_cast<std::uint64_t>(i), 8);
      message.add({1.0 * i, 2.0, 3.0, 0.5, 0.1, 0.7, std::sqrt(1.0 - 0.75)});
      log_.add_event("PLACE", message.bytes());
    }
    folder_.write(beside, vec3);
    flags.insert(flags.end(), {"--type", folder_.write("pose.lcm", pose), "--all"});
    return import(flags);
  }
};

TEST_F(CliImportStructs, CountAsTheirNumbersInTheOrderOfTheirNames) {
  const std::vector<std::string> flags = {"--position", "at.pos", "--orientation", "at.q"};
  for (const std::string order : {"wxyz", "xyzw", "zwyx"}) {
    std::vector<std::string> all = flags;
    if (order == "xyzw") all.insert(all.end(), {"--quaternion", "xyzw"});  // true, and not needed
    const CliRun run = import_structs(order, all);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, Not(HasSubstr("quaternions are taken")));
    const Json last = request()["keyframes"][2];
    EXPECT_EQ(last["position"], Json({2.0, 2.0, 3.0}));
    // The import normalises; its text has 17 digits.
    constexpr double kQuaternionRounding = 1e-12;
    const std::array<double, 4> written{0.5, 0.1, 0.7, std::sqrt(1.0 - 0.75)};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(std::abs(last["orientation"][std::string("wxyz").find(order[i])].get<double>()),
                  written[i], kQuaternionRounding)
          << order;
    }
  }
  const CliRun one_by_one = import_structs(
      "xyzw", {"--position", "at.pos", "--orientation", "at.q.x,at.q.y,at.q.z,at.q.w"});
  ASSERT_EQ(one_by_one.exit_code, 0) << one_by_one.err;
  EXPECT_NEAR(std::abs(request()["keyframes"][0]["orientation"][1].get<double>()), 0.5, 1e-12);
}

TEST_F(CliImportStructs, OfOtherFilesAreNamedWithTheFilesThatWereTried) {
  const CliRun run =
      import_structs("wxyz", {"--position", "at.pos", "--orientation", "at.q"}, "vectors.lcm");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("geo.vec3_t is neither in the files of --type nor beside them in "
                                 "geo_vec3_t.lcm or vec3_t.lcm"));
  const CliRun named = import_structs(
      "wxyz",
      {"--position", "at.pos", "--orientation", "at.q", "--type", folder_.file("vectors.lcm")},
      "vectors.lcm");
  EXPECT_EQ(named.exit_code, 0) << named.err;
}

TEST_F(CliImportLog, SaysWhichOrderOfQuaternionsItAssumed) {
  const std::string note = "its quaternions are taken in the order w, x, y, z";
  const CliRun assumed = import(pose_);
  EXPECT_THAT(assumed.err, HasSubstr(note));
  EXPECT_THAT(import(with({"--quaternion", "wxyz"})).err, Not(HasSubstr(note)));
}

TEST_F(CliImportLog, TheFormatOfLogsMayBeNamed) {
  EXPECT_EQ(import(with({"--format", "lcm"})).exit_code, 0);
  const std::string table = folder_.write("x.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n");
  const CliRun run =
      run_camway({"import", table, "--format", "lcm", "--request", folder_.file("r.json")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--format: " + table + " is no log of lcm-logger"));
}

TEST_F(CliImportLog, NoOtherFormatMayBeNamed) {
  const CliRun run = import(with({"--format", "tum"}));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is a log of lcm-logger, which is read as lcm"));
}

TEST_F(CliImportLog, AMissingFileIsNoOtherKindOfFile) {
  const CliRun run = run_camway({"import", folder_.file("none.lcmlog"), "--channel", "POSE",
                                 "--request", folder_.file("r.json")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, Not(HasSubstr("is no log")));
  EXPECT_THAT(run.err, HasSubstr("none.lcmlog"));
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
