// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/json/json_response.h"

namespace camway::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsNan;
using ::testing::StartsWith;

constexpr const char* kSegment = R"({"t0": 0, "t1": 1, "_made": "by hand",
    "position": [[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3]],
    "orientation": [[1, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0],
                    [1, 0, 0, 0], [1, 0, 0, 0]]})";

std::string path_with(const std::string& more) {
  return std::string(R"({"segments": [)") + kSegment + "]" + more + "}";
}

/// Returns the times of given keyframes.
std::vector<double> times_of(const PathFile& file) {
  std::vector<double> times_s;
  for (const motion::Keyframe& keyframe : file.keyframes) {
    if (keyframe.origin == motion::KeyframeOrigin::kGiven) times_s.push_back(keyframe.time_s);
  }
  return times_s;
}

std::vector<double> times_of(const std::string& keyframes) {
  const auto read = parse_as<PathFile>(path_with(R"(, "keyframes": )" + keyframes), "P.json");
  EXPECT_TRUE(read) << read.error;
  return read.value ? times_of(*read.value) : std::vector<double>{-1.0};
}

std::string error_of(const std::string& text) { return parse_as<PathFile>(text, "P.json").error; }

TEST(PathFile, NeedsSegmentsAlone) {
  const auto read = parse_as<PathFile>(path_with(""), "P.json");
  ASSERT_TRUE(read) << read.error;
  ASSERT_EQ(read->path.segments().size(), 1U);
  EXPECT_EQ(read->path.segments()[0].position[3], geometry::Vec3(0, 0, 3));
  EXPECT_THAT(read->keyframes, IsEmpty());
  EXPECT_EQ(read->scene_digest, "");
  EXPECT_EQ(error_of("{}"), "P.json: segments: is missing");
}

TEST(PathFile, IgnoresWhatCannotChangeWhatIsProved) {
  const auto read = parse_as<PathFile>(
      path_with(R"(, "status": 200, "certificate": "mine", "author": {"name": "x"})"), "P.json");
  EXPECT_TRUE(read) << read.error;
}

TEST(PathFile, RefusesWhatCould) {
  std::string text = path_with("");
  text.insert(text.find("\"t0\""), R"("weights": [1, 2, 2, 1], )");
  EXPECT_THAT(error_of(text), StartsWith("P.json: segments[0].weights: is unknown; segments[0] has "
                                         "t0, t1, position, orientation"));
  std::string misspelled = path_with("");
  misspelled.replace(misspelled.find("segments"), 8, "Segments");
  EXPECT_EQ(error_of(misspelled), "P.json: segments: is missing");
}

TEST(PathFile, TakesTheTimesOfGivenKeyframes) {
  EXPECT_THAT(times_of(R"([{"time": 0}, {"time": 0.5, "name": "door"}, {"time": 1}])"),
              ElementsAre(0.0, 0.5, 1.0));
  EXPECT_THAT(times_of(R"([{"time": 0, "origin": "given"}, {"time": 0.5, "origin": "inserted"}])"),
              ElementsAre(0.0));
  EXPECT_THAT(times_of(R"([{"time": 0}, {"position": [0, 0, 0]}])"), ElementsAre(0.0, IsNan()));
  EXPECT_EQ(error_of(path_with(R"(, "keyframes": [{"time": 0, "origin": "mine"}])")),
            "P.json: keyframes[0].origin: 'mine' is unknown; there are given, inserted");
}

TEST(PathFile, IsEveryResponseOfOurs) {
  planning::PlanResult result;
  result.status = planning::Status::kPartial;
  result.path = parse_as<PathFile>(path_with(""), "P.json")->path;
  result.keyframes.resize(3);
  result.keyframes[1].origin = motion::KeyframeOrigin::kInserted;
  result.keyframes[2].time_s = 1.0;
  ResponseFormat format;
  format.scene_digest = "00ff";
  const auto read = parse_as<PathFile>(*write_plan_response(result, format), "P.json");
  ASSERT_TRUE(read) << read.error;
  EXPECT_EQ(read->path.segments().size(), 1U);
  EXPECT_THAT(times_of(*read.value), ElementsAre(0.0, 1.0));
  EXPECT_EQ(read->scene_digest, "00ff");
}

}  // namespace
}  // namespace camway::tools
