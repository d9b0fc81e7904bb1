// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "tools/cameras/camera_track.h"
#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// The order of a quaternion's components in a message.
enum class QuaternionOrder { kWxyz, kXyzw };
constexpr std::array<std::string_view, 2> names_of(QuaternionOrder) { return {"wxyz", "xyzw"}; }

enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };
constexpr std::array<std::string_view, 4> names_of(TimeUnit) { return {"s", "ms", "us", "ns"}; }

/// The place of the poses in a log. Members are named as `LcmSelector` takes them; three or four
/// names with commas between are the components one by one. A struct of three or four numbers
/// counts as these.
struct LogTrackOptions {
  std::string channel;             ///< empty: the only one in the log
  std::vector<std::string> types;  ///< files with the struct of its messages and those in it
  std::string position;
  std::string orientation;  ///< empty: never turned
  /// Order of its numbers, where their names say none; without it w, x, y, z, with a note.
  std::optional<QuaternionOrder> order;
  /// Empty: `utime` or `timestamp` if there is one for each pose; else the time of receipt, or for
  /// lists of poses none.
  std::string time;
  std::optional<double> fps;     ///< poses a second of lists without times
  std::optional<TimeUnit> unit;  ///< else the one that fits the times of receipt best
  CameraAxes axes = CameraAxes::kGl;
};

/// Returns whether a file begins as a log of lcm-logger does.
bool is_event_log(const std::filesystem::path& file);

/// Reads the poses on one channel of a log. A message may hold one pose or a list of them. Messages
/// that are not later than the one before are left out, as are those that cannot be read, both with
/// a note; so is the rest of a damaged log. Errors name the file and its channels or members.
base::Result<CameraTrack> read_log_track(const std::string& file, const LogTrackOptions& options);

}  // namespace camway::tools
