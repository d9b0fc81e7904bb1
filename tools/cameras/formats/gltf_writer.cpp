// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/base64.h"
#include "tools/cameras/files/glb_file.h"
#include "tools/cameras/formats/gltf_formats.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloatType = 5126;

/// Arrays of floats in one buffer, an accessor for each.
class FloatBuffer {
 public:
  void add(const std::vector<float>& numbers, std::size_t components, const char* type,
           bool has_bounds) {
    views_.push_back({{"buffer", 0},
                      {"byteOffset", bytes_.size()},
                      {"byteLength", numbers.size() * sizeof(float)}});
    Json accessor{{"bufferView", accessors_.size()},
                  {"componentType", kFloatType},
                  {"count", numbers.size() / components},
                  {"type", type}};
    if (has_bounds) {
      accessor["min"] = {numbers.front()};
      accessor["max"] = {numbers.back()};
    }
    accessors_.push_back(std::move(accessor));
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] const Json& views() const { return views_; }
  [[nodiscard]] const Json& accessors() const { return accessors_; }

 private:
  std::string bytes_;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

/// Times after this one, as those since 1970, count from 0: a float holds no more than a hundredth
/// of a frame there.
constexpr double kLatestBegin_s = 3600.0;

/// Appends numbers; those of a quaternion in the order x, y, z, w of glTF.
void append_floats(const geometry::Vec3& v, std::vector<float>& numbers) {
  for (const double x : v) numbers.push_back(static_cast<float>(x));
}
void append_floats(const geometry::Vec4& wxyz, std::vector<float>& numbers) {
  for (const Eigen::Index i : {1, 2, 3, 0}) numbers.push_back(static_cast<float>(wxyz[i]));
}

/// A key of a cubic track: the tangent before it, its value, and the tangent after it.
void append_cubic(const TrackKey& key, const KeyTangents& tangents, std::vector<float>& positions,
                  std::vector<float>& rotations) {
  append_floats(tangents.position_in_m_per_s, positions);
  append_floats(key.pose_W.position, positions);
  append_floats(tangents.position_out_m_per_s, positions);
  append_floats(tangents.orientation_in_per_s, rotations);
  append_floats(geometry::wxyz(key.pose_W.orientation), rotations);
  append_floats(tangents.orientation_out_per_s, rotations);
}

FloatBuffer buffer_of(const CameraTrack& track) {
  const double first_s = track.keys.front().time_s;
  const double begin_s = first_s >= 0.0 && first_s < kLatestBegin_s ? 0.0 : first_s;
  std::vector<float> times;
  std::vector<float> positions;
  std::vector<float> rotations;
  const bool is_cubic = track.playback == Playback::kCubic;
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const TrackKey& key = track.keys[i];
    times.push_back(static_cast<float>(key.time_s - begin_s));
    if (is_cubic) {
      append_cubic(key, track.tangents[i], positions, rotations);
      continue;
    }
    append_floats(key.pose_W.position, positions);
    append_floats(geometry::wxyz(key.pose_W.orientation), rotations);
  }
  FloatBuffer buffer;
  buffer.add(times, 1, "SCALAR", true);
  buffer.add(positions, 3, "VEC3", false);
  buffer.add(rotations, 4, "VEC4", false);
  return buffer;
}

Json channel(int sampler, const char* path) {
  return {{"sampler", sampler}, {"target", {{"node", 0}, {"path", path}}}};
}

Json document_of(const FloatBuffer& buffer, Playback playback, const CameraWriteOptions& options) {
  const char* const curve = playback == Playback::kCubic ? "CUBICSPLINE" : "LINEAR";
  Json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "Camway"}};
  root["scene"] = 0;
  root["scenes"] = Json::array({{{"nodes", {0}}}});
  root["nodes"] = Json::array({{{"name", options.name}, {"camera", 0}}});
  // The fields of view were proved. The aspect of the picture in pixels is rounded, and may be any
  // that a user chooses.
  const double aspect = std::tan(0.5 * options.fov_x_rad) / std::tan(0.5 * options.fov_y_rad);
  root["cameras"] = Json::array(
      {{{"name", options.name},
        {"type", "perspective"},
        {"perspective",
         {{"aspectRatio", aspect}, {"yfov", options.fov_y_rad}, {"znear", options.near_m}}}}});
  root["animations"] = Json::array(
      {{{"name", options.name},
        {"channels", Json::array({channel(0, "translation"), channel(1, "rotation")})},
        {"samplers", Json::array({{{"input", 0}, {"interpolation", curve}, {"output", 1}},
                                  {{"input", 0}, {"interpolation", curve}, {"output", 2}}})}}});
  root["buffers"] = Json::array({{{"byteLength", buffer.bytes().size()}}});
  root["bufferViews"] = buffer.views();
  root["accessors"] = buffer.accessors();
  return root;
}

}  // namespace

base::Result<std::string> write_gltf(const CameraTrack& track, const CameraWriteOptions& options) {
  const FloatBuffer buffer = buffer_of(track);
  Json document = document_of(buffer, track.playback, options);
  if (options.is_text) {
    document["buffers"][0]["uri"] =
        "data:application/octet-stream;base64," + base::encode_base64(buffer.bytes());
    return json_text(document) + "\n";
  }
  return glb_file(json_text(document), buffer.bytes());
}

}  // namespace camway::tools
