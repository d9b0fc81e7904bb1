// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "tools/cameras/formats/gltf_document.h"
#include "tools/cameras/formats/gltf_formats.h"
#include "tools/cameras/frame_rate.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;
using nlohmann::json;

/// Deeper chains of nodes are loops.
constexpr std::size_t kDeepestNode = 1000;
constexpr double kUsualFps = 24.0;

enum class Curve { kStep, kLinear, kCubic };

/// The animation of a property of a node: times, and 3 or 4 numbers for each; three times as many
/// for a cubic curve.
struct Channel {
  std::vector<double> times_s;
  std::vector<double> values;
  std::size_t components = 0;
  Curve curve = Curve::kLinear;

  [[nodiscard]] const double* value(std::size_t key, std::size_t part) const {
    const std::size_t parts = curve == Curve::kCubic ? 3 : 1;
    return &values[(key * parts + (curve == Curve::kCubic ? part : 0)) * components];
  }
};
constexpr std::size_t kInTangent = 0;
constexpr std::size_t kValue = 1;
constexpr std::size_t kOutTangent = 2;

/// Where a node is in its parent, and how that changes.
struct Node {
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 scale = Vec3::Ones();
  std::map<std::string, Channel> channels;  ///< by path: translation, rotation, scale
};

Vec3 vector_in(const json& node, const char* key, const Vec3& otherwise) {
  const auto found = node.find(key);
  if (found == node.end() || !found->is_array() || found->size() != 3) return otherwise;
  Vec3 vector = otherwise;
  for (std::size_t k = 0; k < 3; ++k) {
    if ((*found)[k].is_number()) vector[static_cast<Eigen::Index>(k)] = (*found)[k].get<double>();
  }
  return vector;
}

Quat rotation_in(const json& node) {
  const auto found = node.find("rotation");
  if (found == node.end() || !found->is_array() || found->size() != 4) return Quat::Identity();
  std::array<double, 4> xyzw = {0, 0, 0, 1};
  for (std::size_t k = 0; k < 4; ++k) {
    if ((*found)[k].is_number()) xyzw[k] = (*found)[k].get<double>();
  }
  const Quat quat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  return quat.norm() > 0.0 ? quat.normalized() : Quat::Identity();
}

/// A matrix is by columns, and is no shear in files that animate.
void take_matrix(const json& matrix, Node& node) {
  std::array<double, 16> m{};
  for (std::size_t k = 0; k < 16; ++k) m[k] = matrix[k].is_number() ? matrix[k].get<double>() : 0.0;
  Eigen::Matrix3d linear;
  linear << m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10];
  node.translation = {m[12], m[13], m[14]};
  node.scale = linear.colwise().norm();
  if (linear.determinant() < 0.0) node.scale.x() *= -1.0;
  if ((node.scale.array() == 0.0).any()) return;
  for (Eigen::Index k = 0; k < 3; ++k) linear.col(k) /= node.scale[k];
  node.rotation = Quat(linear).normalized();
}

Node node_in(const json& description) {
  Node node;
  const auto matrix = description.find("matrix");
  if (matrix != description.end() && matrix->is_array() && matrix->size() == 16) {
    take_matrix(*matrix, node);
    return node;
  }
  node.translation = vector_in(description, "translation", Vec3::Zero());
  node.scale = vector_in(description, "scale", Vec3::Ones());
  node.rotation = rotation_in(description);
  return node;
}

template <class Vector>
Vector vector_of(const double* numbers) {
  return Eigen::Map<const Vector>(numbers);
}

/// The value of a channel at a time: of 3 numbers, or of 4 in the order x, y, z, w.
Vec4 value_at(const Channel& channel, double time_s) {
  const std::vector<double>& times = channel.times_s;
  const auto take = [&](std::size_t key, std::size_t part) {
    Vec4 vector = Vec4::Zero();
    std::copy_n(channel.value(key, part), channel.components, vector.data());
    return vector;
  };
  const auto later = std::ranges::upper_bound(times, time_s);
  if (later == times.begin()) return take(0, kValue);
  const auto i = static_cast<std::size_t>(later - times.begin()) - 1;
  if (later == times.end() || channel.curve == Curve::kStep) return take(i, kValue);
  const double step_s = times[i + 1] - times[i];
  const double u = (time_s - times[i]) / step_s;
  const Vec4 from = take(i, kValue);
  const Vec4 to = take(i + 1, kValue);
  if (channel.curve == Curve::kCubic) {
    const double u2 = u * u;
    const double u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * from + step_s * (u3 - 2 * u2 + u) * take(i, kOutTangent) +
           (3 * u2 - 2 * u3) * to + step_s * (u3 - u2) * take(i + 1, kInTangent);
  }
  if (channel.components == 3) return (1.0 - u) * from + u * to;
  return Quat(from).slerp(u, Quat(to)).coeffs();
}

Eigen::Affine3d local_at(const Node& node, double time_s) {
  const auto find = [&](const char* path) {
    const auto found = node.channels.find(path);
    return found == node.channels.end() ? nullptr : &found->second;
  };
  Vec3 translation = node.translation;
  Quat rotation = node.rotation;
  Vec3 scale = node.scale;
  if (const Channel* channel = find("translation")) {
    translation = value_at(*channel, time_s).head<3>();
  }
  if (const Channel* channel = find("rotation")) {
    rotation = Quat(value_at(*channel, time_s)).normalized();
  }
  if (const Channel* channel = find("scale")) scale = value_at(*channel, time_s).head<3>();
  return Eigen::Affine3d(Eigen::Translation3d(translation) * rotation * Eigen::Scaling(scale));
}

/// A camera in the tree of nodes.
struct CameraNode {
  std::string name;
  std::vector<Node> chain;  ///< the camera's node, then what it hangs from, up to the root
  json lens;
  std::size_t lens_index = 0;
  std::vector<std::string> animations;  ///< names of those that move it and are not read

  [[nodiscard]] bool is_animated() const {
    return std::ranges::any_of(chain, [](const Node& node) { return !node.channels.empty(); });
  }
  [[nodiscard]] motion::Pose pose_at(double time_s) const {
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    for (const Node& node : chain) place = local_at(node, time_s) * place;
    Eigen::Matrix3d turn = place.linear();
    // A scaled node scales its children, but the frame of a camera has unit axes.
    turn.colwise().normalize();
    return {place.translation(), Quat(turn).normalized()};
  }
};

std::string text_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

class GltfReader {
 public:
  GltfReader(const GltfDocument& document, const CameraReadOptions& options)
      : document_(document), options_(options) {}

  base::Result<CameraTrack> read() {
    if (std::string fault = animation_fault(); !fault.empty()) return base::Failure{fault};
    find_parents();
    base::Result<CameraNode> camera = find_camera();
    if (!camera) return base::Failure{camera.error};
    CameraTrack track;
    track.name = camera->name;
    track.notes = std::move(notes_);
    std::string fault = read_lens(*camera, track);
    if (!fault.empty()) return base::Failure{std::move(fault)};
    if (!camera->is_animated()) {
      track.has_times = false;
      track.keys.push_back({0.0, camera->pose_at(0.0), std::nullopt});
      return track;
    }
    track.fps = options_.fps ? options_.fps : fps_of(*camera);
    if (!take_keys(*camera, track)) sample(*camera, track);
    return track;
  }

 private:
  [[nodiscard]] std::size_t count(const char* array) const {
    const auto found = document_.root().find(array);
    return found != document_.root().end() && found->is_array() ? found->size() : 0;
  }

  [[nodiscard]] std::string animation_fault() const {
    if (options_.animation.empty()) return "";
    std::string names;
    for (std::size_t i = 0; i < count("animations"); ++i) {
      if (animation_name(i) == options_.animation) return "";
      names += (names.empty() ? "" : ", ") + animation_name(i);
    }
    return "has no animation '" + options_.animation + "': " + names;
  }

  void find_parents() {
    for (std::size_t i = 0; i < count("nodes"); ++i) {
      const json& node = document_.element("nodes", i);
      const auto children = node.is_object() ? node.find("children") : node.end();
      if (!node.is_object() || children == node.end() || !children->is_array()) continue;
      for (const json& child : *children) {
        if (child.is_number_unsigned()) parents_[child.get<std::size_t>()] = i;
      }
    }
  }

  /// The number of nodes that have a camera.
  [[nodiscard]] std::size_t count_cameras() const {
    std::size_t cameras = 0;
    for (std::size_t i = 0; i < count("nodes"); ++i) {
      if (gltf_index(document_.element("nodes", i), "camera")) ++cameras;
    }
    return cameras;
  }

  base::Result<CameraNode> find_camera() {
    std::vector<CameraNode> cameras;
    std::string names;
    const bool has_several = count_cameras() > 1;
    for (std::size_t i = 0; i < count("nodes"); ++i) {
      const json& node = document_.element("nodes", i);
      const auto lens = gltf_index(node, "camera");
      if (!lens) continue;
      CameraNode camera{text_in(node, "name"), {}, document_.element("cameras", *lens), *lens, {}};
      if (camera.name.empty() && camera.lens.is_object())
        camera.name = text_in(camera.lens, "name");
      // Several without a name need one, by which --camera can choose.
      if (camera.name.empty() && has_several) camera.name = "node " + std::to_string(i);
      std::string fault = read_chain(i, camera);
      if (!fault.empty()) return base::Failure{fault};
      names += (names.empty() ? "" : ", ") + camera.name;
      if (options_.camera.empty() || is_called(i, camera)) cameras.push_back(std::move(camera));
    }
    if (cameras.empty()) {
      return base::Failure{names.empty() ? "has no camera in its nodes"
                                         : "has no camera '" + options_.camera + "': " + names};
    }
    const auto animated = std::ranges::find_if(cameras, &CameraNode::is_animated);
    const CameraNode& chosen = animated != cameras.end() ? *animated : cameras.front();
    if (cameras.size() > 1) notes_.push_back(choice_note(chosen.name, names));
    for (const std::string& animation : chosen.animations) {
      notes_.push_back("animation '" + animation +
                       "' moves the camera, too, and was not read: the first one counts "
                       "(--animation names one)");
    }
    return chosen;
  }

  /// By its own name, that of its lens, or that of the node that it hangs from.
  bool is_called(std::size_t node, const CameraNode& camera) const {
    const auto parent = parents_.find(node);
    return camera.name == options_.camera ||
           (camera.lens.is_object() && text_in(camera.lens, "name") == options_.camera) ||
           (parent != parents_.end() &&
            text_in(document_.element("nodes", parent->second), "name") == options_.camera);
  }

  std::string read_chain(std::size_t node, CameraNode& camera) {
    while (true) {
      if (camera.chain.size() == kDeepestNode) return "has nodes that hang from themselves";
      camera.chain.push_back(node_in(document_.element("nodes", node)));
      std::string fault = read_channels(node, camera);
      if (!fault.empty()) return fault;
      const auto parent = parents_.find(node);
      if (parent == parents_.end()) return "";
      node = parent->second;
    }
  }

  std::string read_channels(std::size_t node, CameraNode& camera) {
    Node& into = camera.chain.back();
    for (std::size_t i = 0; i < count("animations"); ++i) {
      const json& animation = document_.element("animations", i);
      const std::string name = animation_name(i);
      for (const json* const channel : channels_of(animation)) {
        const std::string path = path_of(*channel, node);
        if (path != "translation" && path != "rotation" && path != "scale") continue;
        if (!options_.animation.empty() && name != options_.animation) continue;
        // The first animation that moves the node counts.
        if (into.channels.contains(path)) {
          if (std::ranges::count(camera.animations, name) == 0) camera.animations.push_back(name);
          continue;
        }
        base::Result<Channel> read = read_channel(animation, *channel, path == "rotation" ? 4 : 3);
        if (!read) return "animation " + std::to_string(i) + ": " + read.error;
        if (!read->times_s.empty()) into.channels.emplace(path, *std::move(read));
      }
    }
    return "";
  }

  base::Result<Channel> read_channel(const json& animation, const json& description,
                                     std::size_t components) {
    const auto samplers = animation.find("samplers");
    const auto index = gltf_index(description, "sampler");
    if (samplers == animation.end() || !samplers->is_array() || !index ||
        *index >= samplers->size() || !(*samplers)[*index].is_object()) {
      return base::Failure{"a channel has no sampler"};
    }
    const json& sampler = (*samplers)[*index];
    const auto input = gltf_index(sampler, "input");
    const auto output = gltf_index(sampler, "output");
    if (!input || !output) return base::Failure{"a sampler has no input or output"};
    base::Result<std::vector<double>> times = document_.values(*input, 1);
    if (!times) return base::Failure{times.error};
    base::Result<std::vector<double>> values = document_.values(*output, components);
    if (!values) return base::Failure{values.error};
    const std::string curve = text_in(sampler, "interpolation");
    Channel channel{
        *std::move(times), *std::move(values), components,
        curve == "STEP" ? Curve::kStep : (curve == "CUBICSPLINE" ? Curve::kCubic : Curve::kLinear)};
    const std::size_t parts = channel.curve == Curve::kCubic ? 3 : 1;
    if (channel.values.size() != channel.times_s.size() * parts * components) {
      return base::Failure{"a sampler has " + std::to_string(channel.times_s.size()) +
                           " times and another number of values"};
    }
    if (!std::ranges::is_sorted(channel.times_s, std::less_equal<>())) {
      return base::Failure{"the times of a sampler do not increase"};
    }
    return channel;
  }

  /// Reads the lens, and what animates it. Returns why that is not possible.
  std::string read_lens(const CameraNode& camera, CameraTrack& track) {
    const json& lens = camera.lens;
    const auto found = lens.is_object() ? lens.find("perspective") : lens.end();
    if (!lens.is_object() || found == lens.end()) {
      track.why_no_fov = lens.is_object() && text_in(lens, "type") == "orthographic"
                             ? "its camera is orthographic"
                             : "its camera has no perspective";
      return "";
    }
    track.fov_y_rad = gltf_number(*found, "yfov");
    track.aspect = gltf_number(*found, "aspectRatio");
    track.near_m = gltf_number(*found, "znear");
    const std::string pointer =
        "/cameras/" + std::to_string(camera.lens_index) + "/perspective/yfov";
    for (std::size_t i = 0; i < count("animations"); ++i) {
      const json& animation = document_.element("animations", i);
      for (const json* const channel : channels_of(animation)) {
        if (pointer_of(*channel) != pointer) continue;
        if (!options_.animation.empty() && animation_name(i) != options_.animation) continue;
        base::Result<Channel> read = read_channel(animation, *channel, 1);
        if (!read) return "animation " + std::to_string(i) + ": " + read.error;
        if (!read->times_s.empty()) take_widest(*read, track);
      }
    }
    return "";
  }

  /// The widest angle of a lens that changes counts. A cubic is within its Bezier points.
  static void take_widest(const Channel& channel, CameraTrack& track) {
    double widest_rad = 0.0;
    for (std::size_t i = 0; i < channel.times_s.size(); ++i) {
      const double value = *channel.value(i, kValue);
      widest_rad = std::max(widest_rad, value);
      if (channel.curve != Curve::kCubic || i + 1 == channel.times_s.size()) continue;
      const double third_s = (channel.times_s[i + 1] - channel.times_s[i]) / 3.0;
      const double next = *channel.value(i + 1, kValue);
      widest_rad = std::max({widest_rad, value + third_s * *channel.value(i, kOutTangent),
                             next - third_s * *channel.value(i + 1, kInTangent)});
    }
    track.fov_y_rad = widest_rad;
    track.notes.push_back("the lens changes: its widest angle counts, " +
                          std::to_string(widest_rad * 180.0 / std::numbers::pi) +
                          " degrees upwards");
  }

  std::string animation_name(std::size_t index) const {
    const json& animation = document_.element("animations", index);
    const std::string name = animation.is_object() ? text_in(animation, "name") : "";
    return name.empty() ? std::to_string(index) : name;
  }

  /// The channels of an animation that are objects with a target.
  static std::vector<const json*> channels_of(const json& animation) {
    std::vector<const json*> channels;
    const auto found = animation.is_object() ? animation.find("channels") : animation.end();
    if (!animation.is_object() || found == animation.end() || !found->is_array()) return channels;
    for (const json& channel : *found) {
      if (channel.is_object() && channel.contains("target") && channel["target"].is_object()) {
        channels.push_back(&channel);
      }
    }
    return channels;
  }

  /// The pointer of KHR_animation_pointer; empty without one.
  static std::string pointer_of(const json& channel) {
    const json& target = channel["target"];
    const json::json_pointer at("/extensions/KHR_animation_pointer/pointer");
    return target.contains(at) && target[at].is_string() ? target[at].get<std::string>() : "";
  }

  /// The property of the node that a channel animates; empty if it is none of it.
  static std::string path_of(const json& channel, std::size_t node) {
    if (gltf_index(channel["target"], "node") == node) return text_in(channel["target"], "path");
    const std::string pointer = pointer_of(channel);
    const std::string begin = "/nodes/" + std::to_string(node) + "/";
    return pointer.starts_with(begin) ? pointer.substr(begin.size()) : "";
  }

  static std::set<double> key_times(const CameraNode& camera) {
    std::set<double> times;
    for (const Node& node : camera.chain) {
      for (const auto& [path, channel] : node.channels) {
        times.insert(channel.times_s.begin(), channel.times_s.end());
      }
    }
    return times;
  }

  /// The rate on whose frames all keys are.
  static std::optional<double> fps_of(const CameraNode& camera) {
    const std::set<double> times = key_times(camera);
    return rate_of_times(std::vector<double>(times.begin(), times.end()));
  }

  /// Takes the keys as they are if the camera's own node alone moves, on lines or on cubics with
  /// the same times.
  static bool take_keys(const CameraNode& camera, CameraTrack& track) {
    const Node& node = camera.chain.front();
    for (std::size_t i = 1; i < camera.chain.size(); ++i) {
      if (!camera.chain[i].channels.empty()) return false;
    }
    const auto is = [&](Curve curve) {
      return std::ranges::all_of(node.channels,
                                 [&](const auto& each) { return each.second.curve == curve; });
    };
    if (is(Curve::kLinear)) {
      for (const double time_s : key_times(camera)) {
        track.keys.push_back({time_s, camera.pose_at(time_s), std::nullopt});
      }
      return true;
    }
    return is(Curve::kCubic) && camera.chain.size() == 1 && take_cubic(node, track);
  }

  static bool take_cubic(const Node& node, CameraTrack& track) {
    const auto position = node.channels.find("translation");
    const auto rotation = node.channels.find("rotation");
    if (position == node.channels.end() || rotation == node.channels.end()) return false;
    const Channel& p = position->second;
    const Channel& r = rotation->second;
    if (p.times_s != r.times_s) return false;
    const auto wxyz_of = [](const double* xyzw) {
      return Vec4(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    };
    track.playback = Playback::kCubic;
    for (std::size_t i = 0; i < p.times_s.size(); ++i) {
      const Vec4 orientation = wxyz_of(r.value(i, kValue));
      track.keys.push_back({p.times_s[i],
                            {vector_of<Vec3>(p.value(i, kValue)), geometry::from_wxyz(orientation)},
                            std::nullopt});
      track.tangents.push_back({vector_of<Vec3>(p.value(i, kInTangent)),
                                vector_of<Vec3>(p.value(i, kOutTangent)),
                                wxyz_of(r.value(i, kInTangent)), wxyz_of(r.value(i, kOutTangent))});
    }
    return true;
  }

  void sample(const CameraNode& camera, CameraTrack& track) const {
    const double fps = track.fps.value_or(kUsualFps);
    const std::set<double> times = key_times(camera);
    const double begin_s = *times.begin();
    const double frames = std::ceil((*times.rbegin() - begin_s) * fps - kOnFrame);
    constexpr double kMostFrames = 1e6;
    for (double i = 0.0; i <= std::min(frames, kMostFrames); i += 1.0) {
      const double time_s = begin_s + i / fps;
      track.keys.push_back({time_s, camera.pose_at(time_s), std::nullopt});
    }
    track.fps = fps;
    track.notes.push_back("the motion was sampled " + std::to_string(static_cast<int>(fps)) +
                          " times a second");
  }

  const GltfDocument& document_;
  const CameraReadOptions& options_;
  std::map<std::size_t, std::size_t> parents_;
  std::vector<std::string> notes_;
};

}  // namespace

base::Result<CameraTrack> read_gltf(const CameraFile& file, const CameraReadOptions& options) {
  const base::Result<GltfDocument> document = GltfDocument::parse(file);
  if (!document) return base::Failure{document.error};
  return GltfReader(*document, options).read();
}

}  // namespace camway::tools
