// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/pose_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "tools/cameras/formats/text_rows.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using Numbers = std::vector<double>;

constexpr double kNanosecondsPerSecond = 1e9;
/// No camera waits for a day between two poses; in nanoseconds this is a tenth of a millisecond.
constexpr double kLongestStep_s = 1e5;

constexpr double degrees_of(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }
constexpr double radians_of(double angle_deg) { return angle_deg * std::numbers::pi / 180.0; }

Quat normalized(double w, double x, double y, double z) {
  const Quat quat(w, x, y, z);
  return quat.norm() > 0.0 ? quat.normalized() : quat;
}

/// Reads all rows as keys, each by `take(numbers, row)`.
template <class Take>
base::Result<CameraTrack> read_rows(const CameraFile& file, const CameraReadOptions& options,
                                    std::size_t least, const Take& take) {
  CameraTrack track;
  track.fps = options.fps;
  Numbers numbers;
  for (const TextRow& row : rows_of(file.bytes)) {
    std::string fault = read_numbers(row, least, numbers);
    if (!fault.empty()) return base::Failure{std::move(fault)};
    track.keys.push_back(take(numbers, track.keys.size()));
  }
  return track;
}

std::string quaternion_columns(const Quat& q, bool scalar_first, std::string_view separator) {
  return scalar_first ? number_row(std::array{q.w(), q.x(), q.y(), q.z()}, separator)
                      : number_row(std::array{q.x(), q.y(), q.z(), q.w()}, separator);
}

std::string position_columns(const Vec3& p, std::string_view separator) {
  return number_row(std::array{p.x(), p.y(), p.z()}, separator);
}

/// The columns of a table that matter; its width where one is missing.
struct Columns {
  std::array<std::size_t, 3> position{};
  std::array<std::size_t, 4> orientation{};  ///< w, x, y, z
  std::size_t time = 0;
  std::array<std::size_t, 2> fov{};  ///< across and up, in degrees
  double time_unit_s = 0.0;          ///< 0: not stated
  bool is_euroc = false;
};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return lower;
}

struct ColumnName {
  std::string name;
  std::string unit;
};

/// "p_RS_R_x [m]" and "x_m" and "pos_x" are x.
std::vector<ColumnName> column_names(std::string_view line) {
  std::vector<ColumnName> names;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(",;\t"), line.size());
    std::string name = lower_case(line.substr(0, end));
    line.remove_prefix(std::min(end + 1, line.size()));
    std::string unit;
    if (const std::size_t open = name.find('['); open != std::string::npos) {
      unit = name.substr(open + 1, std::min(name.find(']'), name.size()) - open - 1);
      name.resize(open);
    }
    const auto is_kept = [](char c) { return c != ' ' && c != '"' && c != '#'; };
    std::string kept;
    std::ranges::copy_if(name, std::back_inserter(kept), is_kept);
    names.push_back({std::move(kept), std::move(unit)});
  }
  return names;
}

bool is_one_of(const std::string& name, std::span<const std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

constexpr std::array<std::string_view, 7> kTimeNames = {"time",  "t",       "timestamp",   "time_s",
                                                        "stamp", "time_ns", "timestamp_ns"};
constexpr std::array<std::array<std::string_view, 6>, 3> kPositionNames = {
    {{"x", "tx", "px", "x_m", "pos_x", "p_rs_r_x"},
     {"y", "ty", "py", "y_m", "pos_y", "p_rs_r_y"},
     {"z", "tz", "pz", "z_m", "pos_z", "p_rs_r_z"}}};
constexpr std::array<std::array<std::string_view, 4>, 4> kOrientationNames = {
    {{"qw", "q_w", "rot_w", "q_rs_w"},
     {"qx", "q_x", "rot_x", "q_rs_x"},
     {"qy", "q_y", "rot_y", "q_rs_y"},
     {"qz", "q_z", "rot_z", "q_rs_z"}}};
constexpr std::array<std::string_view, 2> kFovNames = {"fov_x_deg", "fov_y_deg"};

std::optional<Columns> columns_of(std::string_view line) {
  const std::vector<ColumnName> names = column_names(line);
  const auto find = [&](std::span<const std::string_view> wanted) {
    const auto found = std::ranges::find_if(
        names, [&](const ColumnName& each) { return is_one_of(each.name, wanted); });
    return static_cast<std::size_t>(found - names.begin());
  };
  Columns columns;
  bool is_complete = true;
  for (std::size_t i = 0; i < 3; ++i) columns.position[i] = find(kPositionNames[i]);
  for (std::size_t i = 0; i < 4; ++i) columns.orientation[i] = find(kOrientationNames[i]);
  for (std::size_t i = 0; i < 2; ++i) columns.fov[i] = find({&kFovNames[i], 1});
  columns.time = find(kTimeNames);
  for (const std::size_t at : columns.position) is_complete = is_complete && at < names.size();
  for (const std::size_t at : columns.orientation) is_complete = is_complete && at < names.size();
  if (!is_complete || columns.time == names.size()) return std::nullopt;
  const ColumnName& time = names[columns.time];
  if (time.unit == "ns" || time.name.ends_with("_ns"))
    columns.time_unit_s = 1.0 / kNanosecondsPerSecond;
  if (time.unit == "s" || time.name.ends_with("_s")) columns.time_unit_s = 1.0;
  columns.is_euroc = names[columns.position[0]].name == "p_rs_r_x";
  return columns;
}

/// The line with the names, and the rest; nothing if there is none.
std::optional<std::pair<Columns, std::string_view>> find_columns(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const std::optional<Columns> columns = columns_of(line);
    if (columns) return std::pair{*columns, text};
    if (!line.starts_with('#')) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

base::Result<CameraTrack> read_tum(const CameraFile& file, const CameraReadOptions& options) {
  const CameraAxes axes = options.axes.value_or(CameraAxes::kCv);
  return read_rows(file, options, 8, [&](const Numbers& n, std::size_t) {
    const Quat orientation = normalized(n[7], n[4], n[5], n[6]);
    return TrackKey{n[0], {Vec3(n[1], n[2], n[3]), with_other_axes(orientation, axes)}, {}};
  });
}

base::Result<std::string> write_tum(const CameraTrack& track, const CameraWriteOptions&) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const TrackKey& key : track.keys) {
    const Quat orientation = with_other_axes(key.pose_W.orientation, CameraAxes::kCv);
    text += number_text(key.time_s) + ' ' + position_columns(key.pose_W.position, " ") + ' ' +
            quaternion_columns(orientation, false, " ") + '\n';
  }
  return text;
}

base::Result<CameraTrack> read_kitti(const CameraFile& file, const CameraReadOptions& options) {
  const CameraAxes axes = options.axes.value_or(CameraAxes::kCv);
  base::Result<CameraTrack> track =
      read_rows(file, options, 12, [&](const Numbers& n, std::size_t i) {
        Eigen::Matrix3d rotation;
        rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
        return TrackKey{
            static_cast<double>(i),
            {Vec3(n[3], n[7], n[11]), with_other_axes(Quat(rotation).normalized(), axes)},
            {}};
      });
  if (!track) return track;
  track->has_times = options.times.has_value() || options.fps.has_value();
  if (options.times) {
    const std::vector<TextRow> rows = rows_of(*options.times);
    if (rows.size() != track->keys.size()) {
      return base::Failure{
          fmt::format("has {} poses, but there are {} times", track->keys.size(), rows.size())};
    }
    Numbers numbers;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      std::string fault = read_numbers(rows[i], 1, numbers);
      if (!fault.empty()) return base::Failure{"times: " + fault};
      track->keys[i].time_s = numbers[0];
    }
  } else if (options.fps) {
    for (TrackKey& key : track->keys) key.time_s /= *options.fps;
  }
  return track;
}

base::Result<std::string> write_kitti(const CameraTrack& track, const CameraWriteOptions&) {
  std::string text;
  for (const TrackKey& key : track.keys) {
    const Eigen::Matrix3d r =
        with_other_axes(key.pose_W.orientation, CameraAxes::kCv).toRotationMatrix();
    const Vec3& p = key.pose_W.position;
    text += number_row(std::array{r(0, 0), r(0, 1), r(0, 2), p.x(), r(1, 0), r(1, 1), r(1, 2),
                                  p.y(), r(2, 0), r(2, 1), r(2, 2), p.z()}) +
            '\n';
  }
  return text;
}

bool has_pose_columns(const CameraFile& file) { return find_columns(file.bytes).has_value(); }

base::Result<CameraTrack> read_csv(const CameraFile& file, const CameraReadOptions& options) {
  const auto found = find_columns(file.bytes);
  if (!found) {
    return base::Failure{
        "its first line names no columns time, x, y, z, qw, qx, qy and qz, or the like"};
  }
  const auto& [columns, text] = *found;
  std::size_t width = columns.time + 1;
  for (const std::size_t at : columns.position) width = std::max(width, at + 1);
  for (const std::size_t at : columns.orientation) width = std::max(width, at + 1);
  const CameraAxes axes =
      options.axes.value_or(columns.is_euroc ? CameraAxes::kCv : CameraAxes::kGl);
  CameraFile rows = file;
  rows.bytes = text;
  base::Result<CameraTrack> track =
      read_rows(rows, options, width, [&](const Numbers& n, std::size_t) {
        const auto& p = columns.position;
        const auto& q = columns.orientation;
        const Quat orientation = normalized(n[q[0]], n[q[1]], n[q[2]], n[q[3]]);
        TrackKey key{n[columns.time],
                     {Vec3(n[p[0]], n[p[1]], n[p[2]]), with_other_axes(orientation, axes)},
                     {}};
        if (columns.fov[1] < n.size()) key.fov_y_rad = radians_of(n[columns.fov[1]]);
        return key;
      });
  if (!track || track->keys.empty()) return track;
  const bool seem_ns =
      track->keys.size() > 1 && track->keys[1].time_s - track->keys[0].time_s > kLongestStep_s;
  const double unit_s = columns.time_unit_s != 0.0 ? columns.time_unit_s
                                                   : (seem_ns ? 1.0 / kNanosecondsPerSecond : 1.0);
  if (unit_s != 1.0) {
    for (TrackKey& key : track->keys) key.time_s /= kNanosecondsPerSecond;
    track->notes.emplace_back("times are nanoseconds");
  }
  if (columns.is_euroc) {
    track->notes.emplace_back("poses are those of the IMU, taken as a camera that looks along +Z");
  }
  return track;
}

base::Result<std::string> write_csv(const CameraTrack& track, const CameraWriteOptions& options) {
  std::string text = "time_s,x_m,y_m,z_m,qw,qx,qy,qz,fov_x_deg,fov_y_deg\n";
  for (const TrackKey& key : track.keys) {
    text +=
        number_text(key.time_s) + ',' + position_columns(key.pose_W.position, ",") + ',' +
        quaternion_columns(key.pose_W.orientation, true, ",") + ',' +
        number_row(std::array{degrees_of(options.fov_x_rad), degrees_of(options.fov_y_rad)}, ",") +
        '\n';
  }
  return text;
}

}  // namespace camway::tools
