// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <string>
#include <string_view>

#include "tools/cameras/formats/camera_format.h"

/// Files of camera paths in memory.
namespace camway::testing {

using tools::CameraFile;
using tools::CameraReadOptions;
using tools::CameraTrack;
using tools::TrackKey;

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// Texts by the names of their files.
using Files = std::map<std::string, std::string>;

/// A file, and those beside it.
inline CameraFile file_of(const std::string& name, const std::string& bytes,
                          const Files& others = {}) {
  return {name, bytes, [others](const std::string& other) -> base::Result<std::string> {
            const auto found = others.find(other);
            if (found == others.end()) return base::Failure{"is not there"};
            return found->second;
          }};
}

/// Reads a file named f, which must be without fault.
inline CameraTrack sound(std::string_view format, const std::string& text,
                         const CameraReadOptions& options = {}, const Files& others = {}) {
  const auto track =
      tools::read_camera(*tools::camera_format(format), file_of("f", text, others), options);
  EXPECT_EQ(track.error, "");
  return track ? *track : CameraTrack{};
}

/// The error of a file named f.
inline std::string error_of(std::string_view format, const std::string& text,
                            const CameraReadOptions& options = {}) {
  return tools::read_camera(*tools::camera_format(format), file_of("f", text), options).error;
}

/// The direction in which the camera looks, and that of the top of its picture.
inline geometry::Vec3 look(const TrackKey& key) {
  return key.pose_W.orientation * -geometry::Vec3::UnitZ();
}
inline geometry::Vec3 top(const TrackKey& key) {
  return key.pose_W.orientation * geometry::Vec3::UnitY();
}

inline void expect_near(const geometry::Vec3& a, const geometry::Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-6) << a.transpose();
}

}  // namespace camway::testing
