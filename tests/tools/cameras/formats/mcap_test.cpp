// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cameras/files/mcap_records.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/cameras/files/mcap_file.h"
#include "tools/cameras/formats/mcap_formats.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using ::testing::HasSubstr;

CameraFile mcap_named(std::string bytes) { return {"drive.mcap", std::move(bytes), {}}; }

std::string mcap_error(const std::string& bytes) {
  const auto track = read_camera(*camera_format("mcap"), mcap_named(bytes), {});
  return track ? "" : track.error;
}

/// A file of one channel with two messages, in any encoding, in a chunk or not.
std::string mcap_of(std::string_view encoding, std::string_view schema_name,
                    std::string_view compression, const std::vector<std::string>& messages) {
  McapBytes records;
  McapBytes schema;
  schema.u16(7);
  schema.text(schema_name);
  schema.text("ros2msg");
  schema.text("");
  records.record(McapOpcode::kSchema, schema);
  McapBytes channel;
  channel.u16(3);
  channel.u16(7);
  channel.text("/pose");
  channel.text(encoding);
  channel.texts({});
  records.record(McapOpcode::kChannel, channel);
  McapBytes chunk_records;
  std::uint64_t time_ns = 5'000'000'000;
  for (const std::string& each : messages) {
    McapBytes message;
    message.u16(3);
    message.u32(0);
    message.u64(time_ns);
    message.u64(0);
    message.raw(each);
    chunk_records.record(McapOpcode::kMessage, message);
    time_ns += 250'000'000;
  }
  McapBytes chunk;
  for (int i = 0; i < 3; ++i) chunk.u64(0);
  chunk.u32(crc32_of(chunk_records.bytes()));
  chunk.text(compression);
  chunk.u64(chunk_records.size());
  chunk.raw(chunk_records.bytes());
  records.record(McapOpcode::kChunk, chunk);
  records.record(McapOpcode::kFooter, {});
  return std::string(kMcapMagic) + records.bytes() + std::string(kMcapMagic);
}

std::string pose_stamped(double x) {
  return R"({"header": {"frame_id": "map"}, "pose": {"position": {"x": )" + std::to_string(x) +
         R"(, "y": 2, "z": 3}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 2}}})";
}

CameraTrack two_keys() {
  CameraTrack track;
  track.fps = 4.0;
  track.keys = {{1.5, {Vec3(1, 2, 3), Quat(0.8, 0.6, 0, 0)}, {}},
                {1.75, {Vec3(2, 2, 3), Quat(0.8, 0, 0.6, 0)}, {}}};
  return track;
}

TEST(Mcap, HasTheChecksumOfZlib) {
  // The check value that catalogues of CRCs give for CRC-32/ISO-HDLC.
  EXPECT_EQ(crc32_of("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32_of(""), 0U);
}

TEST(Mcap, KeepsNameRateTimesAndLens) {
  const CameraWriteOptions options{"Hero", 1.2, 0.7, 0.25, 1920};
  const auto bytes = write_mcap(two_keys(), options);
  ASSERT_TRUE(bytes) << bytes.error;
  const auto track = read_camera(*camera_format("mcap"), mcap_named(*bytes), {});
  ASSERT_TRUE(track) << track.error;
  EXPECT_EQ(track->name, "Hero");
  EXPECT_EQ(track->fps, 4.0);
  EXPECT_EQ(track->near_m, 0.25);
  EXPECT_NEAR(*track->fov_x_rad, 1.2, 1e-12);
  EXPECT_NEAR(*track->fov_y_rad, 0.7, 1e-12);
  EXPECT_EQ(track->keys[1].time_s, 1.75);
  EXPECT_EQ(track->keys[1].pose_W.position, Vec3(2, 2, 3));
}

TEST(Mcap, CountsTimesBefore0From0) {
  CameraTrack track = two_keys();
  for (TrackKey& key : track.keys) key.time_s -= 10.0;
  const auto back = read_mcap(mcap_named(*write_mcap(track, {"c", 1, 1, 0.1, 100})), {});
  ASSERT_TRUE(back) << back.error;
  EXPECT_EQ(back->keys[0].time_s, 0.0);
  EXPECT_EQ(back->keys[1].time_s, 0.25);
  track.keys[1].time_s = track.keys[0].time_s + 1e-10;
  EXPECT_THAT(write_mcap(track, {"c", 1, 1, 0.1, 100}).error, HasSubstr("less than one apart"));
}

TEST(Mcap, ReadsPosesOfOtherTypes) {
  const auto track = read_mcap(
      mcap_named(mcap_of("json", "geometry_msgs/PoseStamped", "", {pose_stamped(1), "{}"})), {});
  ASSERT_TRUE(track) << track.error;
  ASSERT_EQ(track->keys.size(), 1U);
  EXPECT_EQ(track->keys[0].time_s, 5.0);
  EXPECT_EQ(track->keys[0].pose_W.position, Vec3(1, 2, 3));
  // Along the +Z of the optical frame.
  EXPECT_LT((track->keys[0].pose_W.orientation * -Vec3::UnitZ() - Vec3::UnitZ()).norm(), 1e-15);
  CameraReadOptions gl;
  gl.axes = CameraAxes::kGl;
  gl.camera = "/pose";
  const std::string transform =
      R"({"transform": {"translation": {"x": 4, "y": 5, "z": 6},
          "rotation": {"x": 0, "y": 0, "z": 0, "w": 1}}})";
  const auto other = read_mcap(mcap_named(mcap_of("json", "x", "", {transform})), gl);
  ASSERT_TRUE(other) << other.error;
  EXPECT_EQ(other->keys[0].pose_W.position, Vec3(4, 5, 6));
  EXPECT_EQ(other->keys[0].pose_W.orientation.w(), 1.0);
}

TEST(Mcap, NamesWhatItDoesNotRead) {
  EXPECT_EQ(mcap_error(mcap_of("cdr", "nav_msgs/msg/Odometry", "zstd", {"\1"})),
            "drive.mcap: its messages are in the encoding cdr (nav_msgs/msg/Odometry); only json "
            "is read");
  EXPECT_EQ(mcap_error(mcap_of("json", "foxglove.FrameTransform", "lz4", {"x"})),
            "drive.mcap: its chunks are compressed by lz4; only chunks without compression are "
            "read");
  EXPECT_EQ(mcap_error(mcap_of("json", "x", "", {"{}"})), "drive.mcap: no message has a pose");
  EXPECT_THAT(mcap_error(mcap_of("json", "x", "", {"{"})), HasSubstr("a message of /pose: line 1"));
  CameraReadOptions options;
  options.camera = "Zoe";
  EXPECT_EQ(read_mcap(mcap_named(mcap_of("json", "x", "", {pose_stamped(1)})), options).error,
            "has no camera 'Zoe': /pose");
}

TEST(Mcap, FindsDamage) {
  const std::string whole = *write_mcap(two_keys(), {"c", 1, 1, 0.1, 100});
  std::string changed = whole;
  changed[changed.find("\"translation\":{\"x\":") + 19] = '9';
  EXPECT_THAT(mcap_error(changed), HasSubstr("a chunk does not have its checksum"));
  EXPECT_THAT(mcap_error(whole.substr(0, whole.size() / 2)), HasSubstr("ends within a record"));
  EXPECT_THAT(mcap_error("\x89MCAP1\r\n"), HasSubstr("is no MCAP file of version 0"));
}

TEST(Mcap, MakesChunksOfAboutAMebibyte) {
  McapFile file({{"/t", "s", "{}", {}}});
  const std::string text(100'000, ' ');
  for (std::uint64_t i = 0; i < 25; ++i) file.add(0, i, text);
  const std::string bytes = file.finish();
  McapCursor cursor(std::string_view(bytes).substr(kMcapMagic.size()));
  std::vector<std::uint64_t> sizes;
  while (cursor.rest().size() > kMcapMagic.size()) {
    const auto opcode = static_cast<McapOpcode>(cursor.u8());
    const std::string_view record = cursor.raw(cursor.u64());
    if (opcode == McapOpcode::kChunk) sizes.push_back(record.size());
  }
  ASSERT_FALSE(cursor.failed());
  ASSERT_EQ(sizes.size(), 3U);
  EXPECT_NEAR(static_cast<double>(sizes[0]), 1.1e6, 1e5);
}

}  // namespace
}  // namespace camway::tools
