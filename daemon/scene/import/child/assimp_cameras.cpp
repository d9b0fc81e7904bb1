// SPDX-License-Identifier: MIT
#include "daemon/scene/import/child/assimp_cameras.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <set>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace camway::scene {
namespace {

/// Ticks a second where a file does not say: as assimp's own tools assume.
constexpr double kUsualTicks_per_s = 25.0;
constexpr std::size_t kMostKeys = 1'000'000;

// A motion has a key for each frame if it has at least so many keys, and this share of them is on a
// frame, but for this share of a frame.
constexpr std::size_t kFewestFrames = 10;
constexpr double kOnFrame = 0.01;
constexpr double kRegularShare = 0.9;

double value_of(ai_real number) { return static_cast<double>(number); }

/// The animation of a node, or null, and its ticks in a second.
struct NodeMotion {
  const aiNodeAnim* channel = nullptr;
  double ticks_per_s = kUsualTicks_per_s;
};

NodeMotion motion_of(const aiScene& scene, const aiNode& node) {
  for (const aiAnimation* animation : std::span(scene.mAnimations, scene.mNumAnimations)) {
    for (const aiNodeAnim* channel : std::span(animation->mChannels, animation->mNumChannels)) {
      if (channel->mNodeName != node.mName) continue;
      const double ticks = animation->mTicksPerSecond;
      return {channel, ticks > 0.0 ? ticks : kUsualTicks_per_s};
    }
  }
  return {};
}

/// The value of keys at a time, by `between(a, b, share)` from one to the next.
template <class Key, class Between>
auto value_at(std::span<const Key> keys, double time, const Between& between) {
  const auto later =
      std::ranges::upper_bound(keys, time, {}, [](const Key& key) { return key.mTime; });
  if (later == keys.begin()) return keys.front().mValue;
  if (later == keys.end()) return keys.back().mValue;
  const Key& before = *(later - 1);
  const double share = (time - before.mTime) / (later->mTime - before.mTime);
  return between(before.mValue, later->mValue, static_cast<ai_real>(share));
}

aiMatrix4x4 local_at(const aiNode& node, const NodeMotion& motion, double time_s) {
  if (motion.channel == nullptr) return node.mTransformation;
  const aiNodeAnim& channel = *motion.channel;
  aiVector3D scaling;
  aiQuaternion rotation;
  aiVector3D position;
  node.mTransformation.Decompose(scaling, rotation, position);
  const double time = time_s * motion.ticks_per_s;
  const auto line = [](const aiVector3D& a, const aiVector3D& b, ai_real share) {
    return a + (b - a) * share;
  };
  if (channel.mNumPositionKeys > 0) {
    position = value_at(
        std::span<const aiVectorKey>(channel.mPositionKeys, channel.mNumPositionKeys), time, line);
  }
  if (channel.mNumScalingKeys > 0) {
    scaling = value_at(std::span<const aiVectorKey>(channel.mScalingKeys, channel.mNumScalingKeys),
                       time, line);
  }
  if (channel.mNumRotationKeys > 0) {
    rotation = value_at(std::span<const aiQuatKey>(channel.mRotationKeys, channel.mNumRotationKeys),
                        time, [](const aiQuaternion& a, const aiQuaternion& b, ai_real share) {
                          aiQuaternion between;
                          aiQuaternion::Interpolate(between, a, b, share);
                          return between;
                        });
  }
  return aiMatrix4x4(scaling, rotation, position);
}

/// A camera, and the nodes from its own up to the root.
struct CameraChain {
  const aiCamera* camera = nullptr;
  std::vector<const aiNode*> nodes;
  std::vector<NodeMotion> motions;
};

/// The number of animations that move a camera. The first counts.
std::size_t takes_of(const aiScene& scene, const CameraChain& chain) {
  const auto moves = [&](const aiAnimation* animation) {
    const std::span channels(animation->mChannels, animation->mNumChannels);
    return std::ranges::any_of(channels, [&](const aiNodeAnim* channel) {
      return std::ranges::any_of(
          chain.nodes, [&](const aiNode* node) { return channel->mNodeName == node->mName; });
    });
  };
  const std::span animations(scene.mAnimations, scene.mNumAnimations);
  return static_cast<std::size_t>(std::ranges::count_if(animations, moves));
}

CameraChain chain_of(const aiScene& scene, const aiCamera& camera) {
  CameraChain chain{&camera, {}, {}};
  for (const aiNode* node = scene.mRootNode->FindNode(camera.mName); node != nullptr;
       node = node->mParent) {
    chain.nodes.push_back(node);
    chain.motions.push_back(motion_of(scene, *node));
  }
  return chain;
}

template <class Key>
void add_times(std::span<const Key> keys, double ticks_per_s, std::set<double>& times_s) {
  for (const Key& key : keys) {
    if (times_s.size() < kMostKeys) times_s.insert(key.mTime / ticks_per_s);
  }
}

std::set<double> key_times_s(const CameraChain& chain) {
  std::set<double> times_s;
  for (const NodeMotion& motion : chain.motions) {
    if (motion.channel == nullptr) continue;
    const aiNodeAnim& channel = *motion.channel;
    add_times(std::span<const aiVectorKey>(channel.mPositionKeys, channel.mNumPositionKeys),
              motion.ticks_per_s, times_s);
    add_times(std::span<const aiQuatKey>(channel.mRotationKeys, channel.mNumRotationKeys),
              motion.ticks_per_s, times_s);
  }
  if (times_s.empty()) times_s.insert(0.0);
  return times_s;
}

/// Returns the times of frames if the motion has a key for each frame. assimp adds keys to those of
/// an FBX file where an angle jumps by a turn, for instance from 180 to -180 degrees, and they are
/// off by degrees.
std::set<double> frame_times_s(const std::set<double>& times_s) {
  std::vector<double> steps_s;
  for (auto at = times_s.begin(), next = std::next(at); next != times_s.end(); ++at, ++next) {
    steps_s.push_back(*next - *at);
  }
  if (steps_s.size() < kFewestFrames) return times_s;
  std::ranges::nth_element(steps_s, steps_s.begin() + static_cast<long>(steps_s.size() / 2));
  const double step_s = steps_s[steps_s.size() / 2];
  std::set<double> frames_s;
  for (const double time_s : times_s) {
    const double frame = (time_s - *times_s.begin()) / step_s;
    if (std::abs(frame - std::round(frame)) < kOnFrame) frames_s.insert(time_s);
  }
  const bool is_regular =
      static_cast<double>(frames_s.size()) > kRegularShare * static_cast<double>(times_s.size());
  return is_regular ? frames_s : times_s;
}

Eigen::Vector3d vector_of(const aiVector3D& v) {
  return {value_of(v.x), value_of(v.y), value_of(v.z)};
}

std::string key_line(const CameraChain& chain, double time_s) {
  aiMatrix4x4 place;
  for (std::size_t i = 0; i < chain.nodes.size(); ++i) {
    place = local_at(*chain.nodes[i], chain.motions[i], time_s) * place;
  }
  const aiCamera& camera = *chain.camera;
  const Eigen::Vector3d eye = vector_of(place * camera.mPosition);
  const aiMatrix3x3 turn(place);
  // The columns of the camera's frame: it looks along -Z. A mirrored node keeps the picture
  // upright.
  const Eigen::Vector3d z = -vector_of(turn * camera.mLookAt).normalized();
  const Eigen::Vector3d x = vector_of(turn * camera.mUp).cross(z).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  const Eigen::Quaterniond q(axes);
  char line[400];
  std::snprintf(line, sizeof line, "key %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", time_s,
                eye.x(), eye.y(), eye.z(), q.w(), q.x(), q.y(), q.z());
  return line;
}

/// The angle of a camera of COLLADA without a name, which assimp does not read: its default, taken
/// for degrees.
constexpr double kUnreadAngle_rad = 0.25 * std::numbers::pi * std::numbers::pi / 180.0;
/// The rounding of that angle as a float, of which it is some units in the last place.
constexpr double kUnreadRounding_rad = 1e-8;

/// assimp means half of the angle across; its readers of COLLADA and FBX give the whole one.
/// Returns 0 if it did not read the angle.
double fov_x_rad(const aiCamera& camera, std::string_view format) {
  if (std::abs(static_cast<double>(camera.mHorizontalFOV) - kUnreadAngle_rad) < kUnreadRounding_rad)
    return 0.0;
  const bool is_whole = format.find("Collada") != std::string_view::npos ||
                        format.find("FBX") != std::string_view::npos;
  return (is_whole ? 1.0 : 2.0) * static_cast<double>(camera.mHorizontalFOV);
}

/// Returns 0 for what is no aspect of a picture; assimp leaves the number as it was if it reads
/// none.
double aspect_of(const aiCamera& camera) {
  const double aspect = value_of(camera.mAspect);
  constexpr double kWidest = 100.0;
  return aspect > 1.0 / kWidest && aspect < kWidest ? aspect : 0.0;
}

std::string one_line(std::string name) {
  for (char& c : name) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return name;
}

}  // namespace

std::string cameras_text(const aiScene& scene, std::string_view format) {
  std::string text;
  const bool is_fbx = format.find("FBX") != std::string_view::npos;
  for (const aiCamera* camera : std::span(scene.mCameras, scene.mNumCameras)) {
    const CameraChain chain = chain_of(scene, *camera);
    if (chain.nodes.empty()) continue;
    char lens[200];
    std::snprintf(lens, sizeof lens, "lens %.17g %.17g %.17g\n", fov_x_rad(*camera, format),
                  aspect_of(*camera), static_cast<double>(camera->mClipPlaneNear));
    text += "camera " + one_line(camera->mName.C_Str()) + "\n" + lens;
    text += "takes " + std::to_string(takes_of(scene, chain)) + "\n";
    const std::set<double> times_s = key_times_s(chain);
    for (const double time_s : is_fbx ? frame_times_s(times_s) : times_s) {
      text += key_line(chain, time_s);
    }
  }
  return text;
}

}  // namespace camway::scene
