// SPDX-License-Identifier: MIT
#include "tools/lcm_types/message_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <robot/track_t.hpp>

#include "tests/support/random.h"

namespace camway::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

LcmTypes sample_types() {
  LcmTypes types;
  for (const char* name : {"robot_pose_t.lcm", "robot_track_t.lcm"}) {
    std::ifstream stream(std::filesystem::path(CAMWAY_LCM_SAMPLES_FOLDER) / name);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(read_lcm_types(text, types), "");
  }
  return types;
}

class LcmMessageReaderTest : public ::testing::Test {
 protected:
  LcmMessageReaderTest() { reader_ = *LcmMessageReader::make(types_, "robot.track_t"); }

  robot::track_t random_track() {
    robot::track_t track;
    track.stamp_ns = 1'700'000'000'000'000'000;
    track.rows = static_cast<std::int32_t>(random_.integer(0, 4));
    track.poses = static_cast<std::int16_t>(random_.integer(0, 3));
    const auto rows = static_cast<std::size_t>(track.rows);
    const auto poses = static_cast<std::size_t>(track.poses);
    track.pad.assign(rows, 7);
    track.is_new = 1;
    track.grid.assign(rows, std::vector<float>(3));
    for (auto& row : track.grid) {
      for (float& value : row) value = static_cast<float>(random_.uniform(-9.0, 9.0));
    }
    track.list.resize(poses);
    for (robot::pose_t& pose : track.list) {
      pose.utime = random_.integer(-1000, 1000);
      for (double& value : pose.pos) value = random_.uniform(-9.0, 9.0);
      for (double& value : pose.quat) value = random_.uniform(-1.0, 1.0);
      pose.frame = std::string(static_cast<std::size_t>(random_.integer(0, 5)), 'f');
    }
    track.target = {};
    track.target.y = random_.uniform(-9.0, 9.0);
    track.small = -3;
    track.names.assign(2, std::vector<std::string>(poses, "bc"));
    return track;
  }

  static std::vector<std::uint8_t> bytes_of(const robot::track_t& track) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(track.getEncodedSize()));
    track.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    return bytes;
  }

  std::vector<LcmSelector> selectors(const std::vector<std::string>& names) {
    std::vector<LcmSelector> result;
    for (const std::string& name : names) {
      auto selector = LcmSelector::make(types_, "robot.track_t", name);
      EXPECT_TRUE(selector) << selector.error;
      if (selector) result.push_back(*std::move(selector));
    }
    return result;
  }

  std::string why_none(const std::string& name) {
    return LcmSelector::make(types_, "robot.track_t", name).error;
  }

  LcmTypes types_ = sample_types();
  std::optional<LcmMessageReader> reader_;
  camway::testing::Random random_{20};
};

// The oracle is the code that lcm-gen makes.
TEST_F(LcmMessageReaderTest, ReadsTheNumbersThatGeneratedCodeHasWritten) {
  const auto wanted = selectors({"stamp_ns", "list.pos", "list.utime", "grid[1]", "target.y",
                                 "small", "is_new", "grid[0][2]", "list[1].quat[3]", "pad"});
  for (int i = 0; i < 300; ++i) {
    const robot::track_t track = random_track();
    const auto read = reader_->read(bytes_of(track), wanted);
    ASSERT_TRUE(read) << read.error;
    std::vector<double> positions;
    std::vector<double> times;
    for (const robot::pose_t& pose : track.list) {
      positions.insert(positions.end(), std::begin(pose.pos), std::end(pose.pos));
      times.push_back(static_cast<double>(pose.utime));
    }
    EXPECT_THAT((*read)[0], ElementsAre(1.7e18));
    EXPECT_EQ((*read)[1], positions);
    EXPECT_EQ((*read)[2], times);
    EXPECT_EQ((*read)[3], track.rows > 1
                              ? std::vector<double>(track.grid[1].begin(), track.grid[1].end())
                              : std::vector<double>{});
    EXPECT_THAT((*read)[4], ElementsAre(track.target.y));
    EXPECT_THAT((*read)[5], ElementsAre(-3.0));
    EXPECT_THAT((*read)[6], ElementsAre(1.0));
    EXPECT_EQ((*read)[7],
              track.rows > 0 ? std::vector<double>{track.grid[0][2]} : std::vector<double>{});
    EXPECT_EQ((*read)[8],
              track.poses > 1 ? std::vector<double>{track.list[1].quat[3]} : std::vector<double>{});
    EXPECT_EQ((*read)[9], std::vector<double>(static_cast<std::size_t>(track.rows), 7.0));
  }
}

TEST_F(LcmMessageReaderTest, RefusesNamesOfNoNumbers) {
  EXPECT_THAT(why_none("lost"), HasSubstr("has no member 'lost'; it has stamp_ns, rows"));
  EXPECT_THAT(why_none("names"), HasSubstr("is a string, not numbers"));
  EXPECT_THAT(why_none("list"),
              HasSubstr("is a robot.pose_t, not numbers; it has utime, pos, quat"));
  EXPECT_THAT(why_none("small.x"), HasSubstr("'x' stands behind a number"));
  EXPECT_THAT(why_none("pad[0][1]"), HasSubstr("no array of so many dimensions"));
  for (const char* name : {"pad[", "pad[x]", "pad[-1]", "pad[1]x"}) {
    EXPECT_THAT(why_none(name), HasSubstr("in brackets")) << name;
  }
  EXPECT_NE(why_none(""), "");
}

TEST_F(LcmMessageReaderTest, NamesTheNumbersOfAStruct) {
  EXPECT_THAT(lcm_number_members(types_, "robot.track_t", "target"), ElementsAre("x", "y", "z"));
  for (const char* name : {"list", "target.x", "grid", "lost", ""}) {
    EXPECT_THAT(lcm_number_members(types_, "robot.track_t", name), IsEmpty()) << name;
  }
}

TEST_F(LcmMessageReaderTest, RefusesEveryTruncationAndExtension) {
  robot::track_t track = random_track();
  while (track.poses == 0 || track.rows == 0) track = random_track();
  std::vector<std::uint8_t> bytes = bytes_of(track);
  const auto wanted = selectors({"list.pos"});
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_FALSE(reader_->read(std::span(bytes).first(length), wanted)) << length;
  }
  bytes.push_back(0);
  EXPECT_EQ(reader_->read(bytes, wanted).error, "the message has 1 bytes behind its end");
}

TEST_F(LcmMessageReaderTest, EndsForDamagedMessages) {
  const auto wanted = selectors({"list.pos", "grid"});
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> bytes = bytes_of(random_track());
    for (int flips = random_.integer(1, 4); flips > 0; --flips) {
      const auto at =
          static_cast<std::size_t>(random_.integer(8, static_cast<int>(bytes.size()) - 1));
      bytes[at] = static_cast<std::uint8_t>(random_.integer(0, 255));
    }
    const auto read = reader_->read(bytes, wanted);
    EXPECT_EQ(read.error.empty(), static_cast<bool>(read));
    if (!read) continue;
    EXPECT_EQ((*read)[0].size() % 3, 0U);
    EXPECT_EQ((*read)[1].size() % 3, 0U);
    EXPECT_LE(8 * (*read)[0].size() + 4 * (*read)[1].size(), bytes.size());
  }
}

TEST(LcmMessageReader, EndsForArraysOfNothing) {
  LcmTypes types;
  ASSERT_EQ(
      read_lcm_types("struct none_t { } struct a_t { int32_t n; none_t v[n][n][n][n]; byte b[n]; }",
                     types),
      "");
  const auto reader = LcmMessageReader::make(types, "a_t");
  ASSERT_TRUE(reader) << reader.error;
  constexpr std::size_t kCount = 100'000;
  std::vector<std::uint8_t> bytes;
  for (int i = 7; i >= 0; --i) {
    bytes.push_back(static_cast<std::uint8_t>(reader->fingerprint() >> (8 * i)));
  }
  for (int i = 3; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(kCount >> (8 * i)));
  bytes.resize(bytes.size() + kCount);
  EXPECT_THAT(reader->read(bytes, {}).error, HasSubstr("more elements than bytes"));
}

}  // namespace
}  // namespace camway::tools
