// SPDX-License-Identifier: MIT
#include "tools/cameras/camera_track.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <sstream>

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using geometry::Vec4;

/// A plane before the camera has no wider picture than half a turn.
bool is_angle_of_view(std::optional<double> angle_rad) {
  return !angle_rad || (*angle_rad > 0.0 && *angle_rad < std::numbers::pi);
}

std::string fault_of_angles(std::optional<double> fov_x_rad, std::optional<double> fov_y_rad) {
  for (const std::optional<double> angle_rad : {fov_x_rad, fov_y_rad}) {
    if (is_angle_of_view(angle_rad)) continue;
    std::ostringstream text;
    text << "its field of view is " << *angle_rad * 180.0 / std::numbers::pi
         << " degrees, but that of a flat picture is between 0 and 180";
    return text.str();
  }
  return "";
}

std::string fault_of(const TrackKey& key) {
  if (!std::isfinite(key.time_s)) return "its time is not finite";
  if (!key.pose_W.position.allFinite()) return "its position is not finite";
  const double length = key.pose_W.orientation.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return "its orientation has no direction";
  return fault_of_angles(key.fov_x_rad, key.fov_y_rad);
}

/// A cubic Hermite spline between two values (glTF 2.0, appendix C.5), `u` in [0, 1].
template <class Vector>
Vector hermite(const Vector& from, const Vector& out, const Vector& in, const Vector& to,
               double step_s, double u) {
  const double u2 = u * u;
  const double u3 = u2 * u;
  return Vector((2.0 * u3 - 3.0 * u2 + 1.0) * from + step_s * (u3 - 2.0 * u2 + u) * out +
                (-2.0 * u3 + 3.0 * u2) * to + step_s * (u3 - u2) * in);
}

motion::Pose pose_between(const CameraTrack& track, std::size_t i, double u) {
  const motion::Pose& from = track.keys[i].pose_W;
  const motion::Pose& to = track.keys[i + 1].pose_W;
  if (track.playback == Playback::kLinear) {
    return {Vec3((1.0 - u) * from.position + u * to.position),
            from.orientation.slerp(u, to.orientation)};
  }
  if (track.playback == Playback::kBlend) {
    const Vec4 blend =
        (1.0 - u) * geometry::wxyz(from.orientation) + u * geometry::wxyz(to.orientation);
    return {Vec3((1.0 - u) * from.position + u * to.position),
            geometry::from_wxyz(blend).normalized()};
  }
  const double step_s = track.keys[i + 1].time_s - track.keys[i].time_s;
  const KeyTangents& out = track.tangents[i];
  const KeyTangents& in = track.tangents[i + 1];
  const Vec4 orientation =
      hermite<Vec4>(geometry::wxyz(from.orientation), out.orientation_out_per_s,
                    in.orientation_in_per_s, geometry::wxyz(to.orientation), step_s, u);
  return {hermite<Vec3>(from.position, out.position_out_m_per_s, in.position_in_m_per_s,
                        to.position, step_s, u),
          geometry::from_wxyz(orientation).normalized()};
}

}  // namespace

std::string fault_of(const CameraTrack& track) {
  if (track.keys.empty()) return "it has no poses";
  if (std::string fault = fault_of_angles(track.fov_x_rad, track.fov_y_rad); !fault.empty()) {
    return fault;
  }
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    std::string fault = fault_of(track.keys[i]);
    if (fault.empty() && i > 0 && !(track.keys[i - 1].time_s < track.keys[i].time_s)) {
      fault = "its time is not later than that of the pose before";
    }
    if (!fault.empty()) return "pose " + std::to_string(i) + ": " + fault;
  }
  return "";
}

motion::Pose pose_at(const CameraTrack& track, double time_s) {
  const std::vector<TrackKey>& keys = track.keys;
  const auto later = std::ranges::upper_bound(keys, time_s, {}, &TrackKey::time_s);
  if (later == keys.begin()) return keys.front().pose_W;
  if (later == keys.end()) return keys.back().pose_W;
  const auto i = static_cast<std::size_t>(later - keys.begin()) - 1;
  const double u = (time_s - keys[i].time_s) / (keys[i + 1].time_s - keys[i].time_s);
  return pose_between(track, i, u);
}

std::optional<double> widest_fov_x_rad(const CameraTrack& track) {
  std::optional<double> widest = track.fov_x_rad;
  for (const TrackKey& key : track.keys) {
    if (key.fov_x_rad) widest = std::max(widest.value_or(0.0), *key.fov_x_rad);
  }
  return widest;
}

std::optional<double> widest_fov_y_rad(const CameraTrack& track) {
  std::optional<double> widest = track.fov_y_rad;
  for (const TrackKey& key : track.keys) {
    if (key.fov_y_rad) widest = std::max(widest.value_or(0.0), *key.fov_y_rad);
  }
  return widest;
}

double fov_across_rad(double fov_rad, double ratio) {
  return 2.0 * std::atan(ratio * std::tan(0.5 * fov_rad));
}

}  // namespace camway::tools
