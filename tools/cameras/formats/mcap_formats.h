// SPDX-License-Identifier: MIT
#pragma once

#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// MCAP with messages in JSON: poses in `foxglove.FrameTransform`, `foxglove.PoseInFrame`, and the
/// JSON of `geometry_msgs/PoseStamped` and `TransformStamped`. The camera's name is
/// `child_frame_id`, else the topic. The angles of view are those of `foxglove.CameraCalibration`.
/// The time of a pose is the log time. Refuses other encodings of messages, as CDR of ROS 2, and
/// compressed chunks. The camera's frame is an optical one (CV).
base::Result<CameraTrack> read_mcap(const CameraFile& file, const CameraReadOptions& options);

/// Writes a `foxglove.FrameTransform` for each frame, from the frame `world` to that of the
/// camera's name, an optical one; and, at the begin of the path, its `foxglove.CameraCalibration`,
/// all poses and the keyframes as `foxglove.PosesInFrame`. Times are nanoseconds of the track's
/// own time; they count from 0 if it begins before 0. Fails if two frames are less than a
/// nanosecond apart.
base::Result<std::string> write_mcap(const CameraTrack& track, const CameraWriteOptions& options);

}  // namespace camway::tools
