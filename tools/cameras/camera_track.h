// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/motion/path/keyframe.h"

/// Camera paths of other programs.
namespace camway::tools {

/// A camera at an instant: metres, seconds, and the camera frame of `motion::Pose` (looks down -Z,
/// +Y up).
struct TrackKey {
  double time_s = 0.0;
  motion::Pose pose_W;
  std::optional<double> fov_y_rad;  ///< where the lens changes; full angles of view
  std::optional<double> fov_x_rad = std::nullopt;
};

/// The curve on which a program plays a track between two keys.
enum class Playback {
  kLinear,  ///< positions on a line, orientations by slerp on the shorter way
  kBlend,   ///< positions on a line, orientations blended component by component and normalised
  kCubic,   ///< glTF 2.0, appendix C.5: cubic Hermite splines, orientations normalised after it
};

/// Derivatives of a cubic track at a key, with respect to time.
struct KeyTangents {
  geometry::Vec3 position_in_m_per_s = geometry::Vec3::Zero();
  geometry::Vec3 position_out_m_per_s = geometry::Vec3::Zero();
  geometry::Vec4 orientation_in_per_s = geometry::Vec4::Zero();  ///< of w, x, y, z
  geometry::Vec4 orientation_out_per_s = geometry::Vec4::Zero();
};

/// The part of a file beside its motion and its lens that a file of the same kind has again.
struct FileFacts {
  std::optional<double> first_frame;  ///< the number of the first frame, where files count frames
  int width_px = 0;                   ///< of the picture; 0: not known
  int height_px = 0;
  std::vector<std::string> images;  ///< names of the pictures, one for each key
  double time_units = 1.0;          ///< number of time units of a table in a second
  double length_units = 1.0;        ///< number of length units of a table in a metre
  bool is_euroc = false;            ///< a table with the names of EuRoC
};

/// A camera path as a file holds it. A value type.
struct CameraTrack {
  std::string name;
  std::vector<TrackKey> keys;  ///< [Limit: times increase strictly; orientations of unit length]
  bool has_times = true;       ///< else the times are 0, 1, 2, ...
  Playback playback = Playback::kLinear;
  std::vector<KeyTangents> tangents;  ///< of each key if it is cubic; else empty
  std::optional<double> fps;
  std::optional<double> fov_x_rad;  ///< full angles of view
  std::optional<double> fov_y_rad;
  std::optional<double> aspect;  ///< width of the picture divided by its height
  std::optional<double> near_m;
  std::string why_no_fov;  ///< where the file's lens is not taken; else empty
  FileFacts facts;
  std::vector<std::string> notes;  ///< sentences for the user: what was assumed or left out
};

/// Returns why the track is none: no keys, a number that is not finite, times that do not increase,
/// an orientation of length zero, or an angle of view that no flat picture has. Empty if it is one.
/// Counts keys from 0.
std::string fault_of(const CameraTrack& track);

/// The pose of the track at a time, which is clamped to its keys, as its program plays it. Requires
/// a track without fault.
motion::Pose pose_at(const CameraTrack& track, double time_s);

/// The widest field of view of the keys, or that of the track; nothing if neither is known.
std::optional<double> widest_fov_x_rad(const CameraTrack& track);
std::optional<double> widest_fov_y_rad(const CameraTrack& track);

/// Returns the field of view across a picture of another width: tan(x/2) = aspect · tan(y/2).
double fov_across_rad(double fov_rad, double ratio);

}  // namespace camway::tools
