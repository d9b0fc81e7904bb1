// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/pose_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "tools/cameras/files/rotation_matrix.h"
#include "tools/cameras/files/text_rows.h"
#include "tools/cameras/formats/key_rows.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using Numbers = std::vector<double>;

/// Seconds since 1970 are fewer until the year 5138.
constexpr double kMostSeconds = 1e11;

constexpr double degrees_of(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

Quat normalized(double w, double x, double y, double z) {
  const Quat quat(w, x, y, z);
  return quat.norm() > 0.0 ? quat.normalized() : quat;
}

/// The digits of a number that has a fraction: those of its mantissa, or behind the point without
/// the zeros there at first. Of whole numbers none counts, they may be exact.
int digits_of(std::string_view word) {
  const std::size_t exponent = std::min(word.find_first_of("eE"), word.size());
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos) return 0;
  const std::string_view digits =
      exponent < word.size() ? word.substr(0, exponent) : word.substr(point);
  const std::size_t first = digits.find_first_of("123456789");
  if (first == std::string_view::npos) return 0;
  return static_cast<int>(
      std::ranges::count_if(digits.substr(first), [](char c) { return c >= '0' && c <= '9'; }));
}

/// The places of the rotation among the 12 numbers of a row of KITTI.
constexpr std::array<std::size_t, 9> kRotationPlaces = {0, 1, 2, 4, 5, 6, 8, 9, 10};

Eigen::Matrix3d rotation_in(const Numbers& n) {
  Eigen::Matrix3d rotation;
  rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  return rotation;
}

/// The most digits of a number in a rotation: programs leave out zeros at the end.
int rotation_digits(const std::vector<TextRow>& rows) {
  int digits = 0;
  for (const TextRow& row : rows) {
    for (const std::size_t place : kRotationPlaces) {
      if (place < row.words.size()) digits = std::max(digits, digits_of(row.words[place]));
    }
  }
  return digits > 0 ? digits : std::numeric_limits<int>::max();
}

/// Sets the times of KITTI's poses, which are in a text of their own.
std::string take_times(const std::string& text, CameraTrack& track) {
  const std::vector<TextRow> rows = rows_of(text);
  if (rows.size() != track.keys.size()) {
    return fmt::format("has {} poses, but there are {} times", track.keys.size(), rows.size());
  }
  Numbers numbers;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::string fault = read_row(rows[i], 1, 1, numbers);
    if (!fault.empty()) return "times: " + fault;
    track.keys[i].time_s = numbers[0];
    if (i > 0 && !(track.keys[i - 1].time_s < numbers[0])) {
      return fmt::format("times: line {}: is not later than the time before", rows[i].line);
    }
  }
  return "";
}

std::string quaternion_columns(const Quat& q, bool scalar_first, std::string_view separator) {
  return scalar_first ? number_row(std::array{q.w(), q.x(), q.y(), q.z()}, separator)
                      : number_row(std::array{q.x(), q.y(), q.z(), q.w()}, separator);
}

std::string position_columns(const Vec3& p, std::string_view separator) {
  return number_row(std::array{p.x(), p.y(), p.z()}, separator);
}

/// The unit of a table's positions that is written again.
std::string_view metre_column(const FileFacts& facts) {
  if (facts.length_units == 100.0) return "cm";
  return facts.length_units == 1000.0 ? "mm" : "m";
}

std::string_view second_column(const FileFacts& facts) {
  if (facts.time_units == 1e9) return "ns";
  if (facts.time_units == 1e6) return "us";
  return facts.time_units == 1e3 ? "ms" : "s";
}

/// The first line of a table, but for the lens.
std::string csv_names(const FileFacts& facts) {
  if (facts.is_euroc) {
    return "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],"
           "q_RS_z []";
  }
  const std::string_view unit = metre_column(facts);
  return fmt::format("time_{},x_{},y_{},z_{},qw,qx,qy,qz", second_column(facts), unit, unit, unit);
}

/// A time in the table's unit. Nanoseconds of a double are off by some hundred in this century, so
/// they are whole.
std::string time_text(double time_s, const FileFacts& facts) {
  if (second_column(facts) == "s") return number_text(time_s);
  const double time = time_s * facts.time_units;
  return second_column(facts) == "ns" ? fmt::format("{:.0f}", time) : number_text(time);
}

}  // namespace

base::Result<CameraTrack> read_tum(const CameraFile& file, const CameraReadOptions& options) {
  const CameraAxes axes = options.axes.value_or(CameraAxes::kCv);
  CameraTrack track;
  track.fps = options.fps;
  KeyRows keys(track);
  Numbers n;
  for (const TextRow& row : rows_of(file.bytes)) {
    std::string fault = read_row(row, 8, 8, n);
    if (fault.empty() && std::abs(n[0]) > kMostSeconds) {
      fault = fmt::format(
          "line {}: its time, {}, is too large for seconds, which TUM has; a table "
          "with a first line such as time_ns,x,y,z,qx,qy,qz,qw has any unit",
          row.line, row.words[0]);
    }
    if (fault.empty()) {
      const Quat orientation = with_other_axes(normalized(n[7], n[4], n[5], n[6]), axes);
      fault = keys.add({n[0], {Vec3(n[1], n[2], n[3]), orientation}, {}}, row.line);
    }
    if (!fault.empty()) return base::Failure{std::move(fault)};
  }
  keys.finish();
  return track;
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
  CameraTrack track;
  track.fps = options.fps;
  const std::vector<TextRow> rows = rows_of(file.bytes);
  const double slack = rotation_slack(rotation_digits(rows));
  Numbers n;
  for (const TextRow& row : rows) {
    std::string fault = read_row(row, 12, 12, n);
    if (!fault.empty()) return base::Failure{std::move(fault)};
    const Eigen::Matrix3d rotation = rotation_in(n);
    fault = rotation_fault(rotation, slack);
    if (!fault.empty()) {
      return base::Failure{
          fmt::format("line {}: its matrix, without numbers 4, 8 and 12, {}", row.line, fault)};
    }
    const auto frame = static_cast<double>(track.keys.size());
    track.keys.push_back(
        {frame, {Vec3(n[3], n[7], n[11]), with_other_axes(Quat(rotation).normalized(), axes)}, {}});
  }
  track.has_times = options.times.has_value() || options.fps.has_value();
  if (options.times) {
    std::string fault = take_times(*options.times, track);
    if (!fault.empty()) return base::Failure{std::move(fault)};
  } else if (options.fps) {
    for (TrackKey& key : track.keys) key.time_s /= *options.fps;
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

base::Result<std::string> write_csv(const CameraTrack& track, const CameraWriteOptions& options) {
  const FileFacts& facts = options.facts;
  const bool has_fov = options.has_lens() && !facts.is_euroc;
  std::string text = csv_names(facts);
  text += has_fov ? ",fov_x_deg,fov_y_deg\n" : "\n";
  const double length_units = metre_column(facts) == "m" ? 1.0 : facts.length_units;
  for (const TrackKey& key : track.keys) {
    text += time_text(key.time_s, facts) + ',' +
            position_columns(length_units * key.pose_W.position, ",") + ',' +
            quaternion_columns(key.pose_W.orientation, true, ",");
    if (has_fov) {
      text +=
          ',' +
          number_row(std::array{degrees_of(options.fov_x_rad), degrees_of(options.fov_y_rad)}, ",");
    }
    text += '\n';
  }
  return text;
}

}  // namespace camway::tools
