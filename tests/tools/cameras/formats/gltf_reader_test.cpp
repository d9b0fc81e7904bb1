// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/cameras/formats/gltf_formats.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

const double kHalf = std::sqrt(0.5);

/// A document with one buffer, in a file of its own.
class Document {
 public:
  Document() {
    root_ = json::parse(R"({"asset": {"version": "2.0"},
      "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 1.5, "znear": 0.2}}],
      "nodes": [{"name": "eye", "camera": 0, "translation": [1, 2, 3]}],
      "animations": [{"channels": [], "samplers": []}],
      "accessors": [], "bufferViews": [], "buffers": [{"uri": "b.bin", "byteLength": 0}]})");
  }

  json& root() { return root_; }

  std::size_t add(const std::vector<float>& numbers, const std::string& type, std::size_t parts) {
    root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}});
    root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                  {"componentType", 5126},
                                  {"type", type},
                                  {"count", numbers.size() / parts}});
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
    return root_["accessors"].size() - 1;
  }
  void animate(std::size_t node, const std::string& path, const std::vector<float>& times,
               const std::vector<float>& values, const std::string& curve = "LINEAR") {
    json& animation = root_["animations"][0];
    const bool is_rotation = path == "rotation";
    const std::size_t input = add(times, "SCALAR", 1);
    const std::size_t output = add(values, is_rotation ? "VEC4" : "VEC3", is_rotation ? 4 : 3);
    animation["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", curve}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }
  [[nodiscard]] base::Result<CameraTrack> read(const CameraReadOptions& options = {}) const {
    return read_gltf({"f.gltf", root_.dump(),
                      [this](const std::string& name) -> base::Result<std::string> {
                        opened_.push_back(name);
                        return bytes_;
                      }},
                     options);
  }
  /// The files that were opened.
  [[nodiscard]] const std::vector<std::string>& opened() const { return opened_; }

  void animate_by_pointer(const std::string& pointer, const std::vector<float>& times,
                          const std::vector<float>& values, const std::string& type,
                          std::size_t parts) {
    json& animation = root_["animations"][0];
    const std::size_t input = add(times, "SCALAR", 1);
    animation["samplers"].push_back({{"input", input}, {"output", add(values, type, parts)}});
    json target = {{"path", "pointer"}};
    target["extensions"]["KHR_animation_pointer"]["pointer"] = pointer;
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", target}});
  }

 private:
  json root_;
  std::string bytes_;
  mutable std::vector<std::string> opened_;
};

TEST(GltfReader, TakesKeysOfACameraThatAloneMoves) {
  Document document;
  const auto half = static_cast<float>(kHalf);
  document.animate(0, "translation", {0, 1, 2}, {0, 0, 0, 4, 0, 0, 4, 4, 0});
  document.animate(0, "rotation", {0.5, 1}, {0, 0, 0, 1, 0, half, 0, half});
  const auto track = document.read();
  ASSERT_TRUE(track) << track.error;
  EXPECT_EQ(track->name, "eye");
  EXPECT_EQ(track->playback, Playback::kLinear);
  ASSERT_EQ(track->keys.size(), 4U);
  EXPECT_EQ(track->keys[1].time_s, 0.5);
  EXPECT_EQ(track->keys[1].pose_W.position, Vec3(2, 0, 0));
  EXPECT_NEAR(track->keys[0].pose_W.orientation.angularDistance(Quat::Identity()), 0.0, 1e-7);
  EXPECT_NEAR(track->keys[3].pose_W.orientation.angularDistance(Quat(kHalf, 0, kHalf, 0)), 0.0,
              1e-6);
  EXPECT_EQ(*track->fov_y_rad, 0.5);
  EXPECT_EQ(*track->aspect, 1.5);
  EXPECT_EQ(*track->near_m, 0.2);
}

TEST(GltfReader, KeepsCubicCurves) {
  Document document;
  document.animate(0, "translation", {0, 2}, {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 3, 0, 4, 0, 0, 9, 9, 9},
                   "CUBICSPLINE");
  document.animate(0, "rotation", {0, 2},
                   {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0},
                   "CUBICSPLINE");
  const auto track = document.read();
  ASSERT_TRUE(track) << track.error;
  EXPECT_EQ(track->playback, Playback::kCubic);
  // The formula of appendix C.5 by hand, in the middle: (0 + 4) / 2 + 2 (1 - 0) / 8, 2 (0 - 3) / 8.
  EXPECT_EQ(pose_at(*track, 1.0).position, Vec3(2.25, -0.75, 0));
}

TEST(GltfReader, FollowsWhatTheCameraHangsFrom) {
  Document document;
  const auto half = static_cast<float>(kHalf);
  // The camera is 2 in front of an arm that turns by 90 degrees in a second and is scaled by 3.
  document.root()["nodes"] = json::parse(R"([
    {"camera": 0, "translation": [0, 0, -2], "name": "eye"},
    {"children": [0], "scale": [3, 3, 3]},
    {"children": [1], "translation": [0, 10, 0]}])");
  document.animate(1, "rotation", {1, 2}, {0, 0, 0, 1, 0, half, 0, half});
  const auto track = document.read();
  ASSERT_TRUE(track) << track.error;
  EXPECT_EQ(track->fps, 24.0);
  ASSERT_EQ(track->keys.size(), 25U);
  EXPECT_THAT(track->notes, Contains(HasSubstr("sampled 24 times")));
  EXPECT_LT((track->keys[0].pose_W.position - Vec3(0, 10, -6)).norm(), 1e-6);
  EXPECT_LT((track->keys[24].pose_W.position - Vec3(-6, 10, 0)).norm(), 1e-5);
  const Vec3 look = track->keys[24].pose_W.orientation * -Vec3::UnitZ();
  EXPECT_LT((look + Vec3::UnitX()).norm(), 1e-5);
}

TEST(GltfReader, ReadsNormalisedIntegersAndBase64) {
  Document document;
  document.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  json& root = document.root();
  // Two quaternions of bytes: (0, 0, 0, 127) and (0, 127, 0, 0).
  root["buffers"].push_back({{"uri", "data:application/octet-stream;base64,AAAAfwB/AAA="}});
  root["bufferViews"].push_back({{"buffer", 1}});
  root["accessors"].push_back({{"bufferView", root["bufferViews"].size() - 1},
                               {"componentType", 5120},
                               {"normalized", true},
                               {"type", "VEC4"},
                               {"count", 2}});
  json& animation = root["animations"][0];
  animation["samplers"].push_back({{"input", 0}, {"output", root["accessors"].size() - 1}});
  animation["channels"].push_back(
      {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}});
  const auto track = document.read();
  ASSERT_TRUE(track) << track.error;
  EXPECT_NEAR(track->keys[0].pose_W.orientation.w(), 1.0, 1e-12);
  EXPECT_NEAR(track->keys[1].pose_W.orientation.y(), 1.0, 1e-12);
}

TEST(GltfReader, ChoosesTheCameraByName) {
  Document document;
  document.root()["nodes"].push_back(
      {{"name", "other"}, {"camera", 0}, {"translation", {7, 8, 9}}});
  document.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  EXPECT_EQ(document.read()->name, "eye");
  CameraReadOptions options;
  options.camera = "other";
  const auto other = document.read(options);
  ASSERT_TRUE(other) << other.error;
  EXPECT_EQ(other->keys.size(), 1U);
  EXPECT_EQ(other->keys[0].pose_W.position, Vec3(7, 8, 9));
  options.camera = "none";
  EXPECT_EQ(document.read(options).error, "has no camera 'none': eye, other");
}

TEST(GltfReader, NumbersCamerasWithoutAName) {
  Document document;
  for (auto& node : document.root()["nodes"]) node.erase("name");
  for (auto& camera : document.root()["cameras"]) camera.erase("name");
  const std::size_t other = document.root()["nodes"].size();
  document.root()["nodes"].push_back({{"camera", 0}, {"translation", {7, 8, 9}}});
  document.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  CameraReadOptions options;
  options.camera = "none";
  const std::string last = "node " + std::to_string(other);
  EXPECT_THAT(document.read(options).error, ::testing::EndsWith(", " + last));
  options.camera = last;
  const auto track = document.read(options);
  ASSERT_TRUE(track) << track.error;
  EXPECT_EQ(track->keys[0].pose_W.position, Vec3(7, 8, 9));
}

TEST(GltfReader, TakesTheWidestAngleOfALensThatChanges) {
  Document document;
  document.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  document.animate_by_pointer("/cameras/0/perspective/yfov", {0, 1, 2}, {0.4F, 1.25F, 0.6F},
                              "SCALAR", 1);
  const auto track = document.read();
  ASSERT_TRUE(track) << track.error;
  EXPECT_NEAR(*track->fov_y_rad, 1.25, 1e-6);
  EXPECT_THAT(track->notes, Contains(HasSubstr("the lens changes: its widest angle counts")));
}

TEST(GltfReader, FollowsPointersToNodes) {
  Document document;
  document.animate_by_pointer("/nodes/0/translation", {0, 1}, {0, 0, 0, 4, 0, 0}, "VEC3", 3);
  const auto track = document.read();
  ASSERT_TRUE(track) << track.error;
  ASSERT_EQ(track->keys.size(), 2U);
  EXPECT_EQ(track->keys[1].pose_W.position, Vec3(4, 0, 0));
}

TEST(GltfReader, SaysWhatItLeavesOut) {
  Document document;
  document.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  document.root()["animations"][0]["name"] = "first";
  document.root()["animations"].push_back(document.root()["animations"][0]);
  document.root()["animations"][1]["name"] = "second";
  document.root()["animations"][1]["samplers"][0]["output"] =
      document.add({0, 0, 0, 0, 5, 0}, "VEC3", 3);
  EXPECT_THAT(document.read()->notes,
              Contains(HasSubstr("animation 'second' moves the camera, too, and was not read")));
  CameraReadOptions options;
  options.animation = "second";
  const auto second = document.read(options);
  ASSERT_TRUE(second) << second.error;
  EXPECT_EQ(second->keys[1].pose_W.position, Vec3(0, 5, 0));
  options.animation = "third";
  EXPECT_EQ(document.read(options).error, "has no animation 'third': first, second");
  document.root()["nodes"].push_back({{"name", "other"}, {"camera", 0}});
  EXPECT_THAT(document.read()->notes,
              Contains(HasSubstr("camera 'eye' was taken of several, the first that moves "
                                 "(--camera names one): eye, other")));
  document.root()["cameras"][0] = {{"type", "orthographic"}};
  EXPECT_EQ(document.read()->why_no_fov, "its camera is orthographic");
}

TEST(GltfReader, DecodesTheNamesOfFiles) {
  Document document;
  document.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  document.root()["buffers"][0]["uri"] = "sub/a%20b%C3%BC.bin";
  EXPECT_EQ(document.read().error, "");
  EXPECT_EQ(document.opened().back(), "sub/a b\xC3\xBC.bin");
  document.root()["buffers"][0]["uri"] = "100%.bin";
  EXPECT_EQ(document.read().error, "");
  EXPECT_EQ(document.opened().back(), "100%.bin");
}

TEST(GltfReader, RefusesWhatReachesTooFar) {
  const auto error_with = [](const std::string& pointer, const json& value) {
    Document document;
    document.animate(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
    document.root()[json::json_pointer(pointer)] = value;
    return document.read().error;
  };
  EXPECT_EQ(error_with("/accessors/1/count", 2), "");
  const json most = std::uint64_t{18'446'744'073'709'551'615U};
  for (const char* const member :
       {"/accessors/1/count", "/accessors/1/byteOffset", "/bufferViews/1/byteOffset"}) {
    EXPECT_THAT(error_with(member, most), HasSubstr("accessor 1 reaches beyond its buffer"));
  }
  EXPECT_THAT(error_with("/bufferViews/1/byteStride", most), HasSubstr("reaches beyond"));
  EXPECT_THAT(error_with("/bufferViews/1/byteStride", 1), HasSubstr("reaches beyond"));
  EXPECT_THAT(error_with("/bufferViews/1/buffer", 5), HasSubstr("has no buffer"));
  EXPECT_THAT(error_with("/accessors/1/type", "VEC2"), HasSubstr("not of the kind"));
  EXPECT_THAT(error_with("/accessors/0/count", 1), HasSubstr("another number of values"));
  EXPECT_THAT(error_with("/bufferViews/1/extensions", {{"EXT_meshopt_compression", {}}}),
              HasSubstr("compressed (EXT_meshopt_compression)"));
  EXPECT_THAT(error_with("/nodes/0/children", {0}), HasSubstr("hang from themselves"));
  EXPECT_THAT(error_with("/asset", nullptr), "");
}

}  // namespace
}  // namespace camway::tools
