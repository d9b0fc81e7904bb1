// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

/// Tables of poses, a line each.
namespace camway::tools {

/// TUM RGB-D: `t tx ty tz qx qy qz qw`, seconds, camera (CV) to world.
base::Result<CameraTrack> read_tum(const CameraFile& file, const CameraReadOptions& options);
base::Result<std::string> write_tum(const CameraTrack& track, const CameraWriteOptions& options);

/// KITTI odometry: 12 numbers in a line, the rows of a 3 × 4 matrix, camera (CV) to world; times
/// are in a file of their own.
base::Result<CameraTrack> read_kitti(const CameraFile& file, const CameraReadOptions& options);
base::Result<std::string> write_kitti(const CameraTrack& track, const CameraWriteOptions& options);

/// A table whose first line names its columns: time, x, y, z and the quaternion in any order, with
/// or without prefixes, and with units in brackets or at the end; EuRoC's ground truth is one.
/// Fields are between commas, semicolons or tabs, as many as there are names. Decimal commas are
/// read if all numbers have them. Times without a unit that are larger than seconds can be are
/// fractions of seconds, by their size. Axes of the camera are GL, those of EuRoC are the body's,
/// taken as CV.
base::Result<CameraTrack> read_csv(const CameraFile& file, const CameraReadOptions& options);
/// Writes `time_s,x_m,y_m,z_m,qw,qx,qy,qz,fov_x_deg,fov_y_deg`, GL.
base::Result<std::string> write_csv(const CameraTrack& track, const CameraWriteOptions& options);

/// Returns whether the first line that has words, and is no remark, names the columns of a pose, or
/// a remark before it does.
bool has_pose_columns(const CameraFile& file);

}  // namespace camway::tools
