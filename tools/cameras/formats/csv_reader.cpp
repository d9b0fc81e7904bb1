// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "daemon/scene/import/readers/decimal.h"
#include "daemon/scene/import/readers/tokens.h"
#include "tools/cameras/formats/csv_columns.h"
#include "tools/cameras/formats/key_rows.h"
#include "tools/cameras/formats/pose_tables.h"

namespace camway::tools {
namespace {

namespace readers = scene::mesh_readers;
using geometry::Quat;
using geometry::Vec3;

// Times without a unit. A camera that has no pose for so long would be a strange one.
constexpr double kLongestStep_s = 1e3;
constexpr double kLeastStep_ns = 1e5;  ///< a tenth of a millisecond
/// Seconds since 1970 are fewer than this until the year 5138.
constexpr double kLeastMilliseconds = 1e11;
constexpr double kLeastMicroseconds = 1e14;
constexpr double kLeastNanoseconds = 1e17;

/// A row of a table: the fields and the number of the line.
struct CsvRow {
  std::vector<std::string_view> fields;
  std::size_t line = 0;
};

/// Reads numbers, all with points or all with commas.
class NumberReader {
 public:
  /// Reads a field, in the unit of its column. Sets `fault` if it is no number.
  double read(const CsvRow& row, const CsvColumn& column, std::string& fault) {
    const std::string_view field = row.fields[column.index];
    std::string text(field);
    const std::size_t comma = text.find(',');
    if (comma != std::string::npos) {
      if (comma_line_ == 0) comma_line_ = row.line;
      text[comma] = '.';
    }
    if (field.find('.') != std::string_view::npos && point_line_ == 0) point_line_ = row.line;
    const double number = readers::parse_decimal(text);
    if (!fault.empty()) return 0.0;
    if (!std::isfinite(number)) {
      fault = fmt::format("line {}: '{}' is no number", row.line, field);
    } else if (comma_line_ != 0 && point_line_ != 0) {
      fault = fmt::format(
          "line {}: '{}' is unclear: numbers have decimal commas in line {}, and "
          "points in line {}",
          row.line, field, comma_line_, point_line_);
    }
    return number / column.units;
  }
  [[nodiscard]] bool has_commas() const { return comma_line_ != 0; }

 private:
  std::size_t comma_line_ = 0;  ///< the first with one; 0: none
  std::size_t point_line_ = 0;
};

/// Splits a line. Returns why it is no row of the table.
std::string take_row(std::string_view content, const PoseColumns& columns, CsvRow& row) {
  row.fields = csv_fields(content, columns.separator);
  while (row.fields.size() > columns.count && row.fields.back().empty()) row.fields.pop_back();
  if (row.fields.size() == columns.count) return "";
  const bool is_longer = columns.separator == ',' && row.fields.size() > columns.count;
  return fmt::format("line {}: has {} fields, but line {} names {} columns{}", row.line,
                     row.fields.size(), columns.line, columns.count,
                     is_longer ? ": decimal commas need ';' between fields" : "");
}

TrackKey key_of(const CsvRow& row, const PoseColumns& columns, CameraAxes axes,
                NumberReader& numbers, std::string& fault) {
  const auto read = [&](const CsvColumn& column) { return numbers.read(row, column, fault); };
  TrackKey key;
  key.time_s = read(columns.time);
  const auto& p = columns.position;
  key.pose_W.position = {read(p[0]), read(p[1]), read(p[2])};
  const auto& q = columns.orientation;
  Quat orientation(read(q[0]), read(q[1]), read(q[2]), read(q[3]));
  if (orientation.norm() > 0.0) orientation.normalize();
  key.pose_W.orientation = with_other_axes(orientation, axes);
  if (columns.fov_x) key.fov_x_rad = read(*columns.fov_x);
  if (columns.fov_y) key.fov_y_rad = read(*columns.fov_y);
  return key;
}

/// Returns the units in a second of times whose column states none, or 0 if that is not clear.
double time_units_of(const std::vector<TrackKey>& keys) {
  const double last = std::abs(keys.back().time_s);
  if (last >= kLeastNanoseconds) return 1e9;
  if (last >= kLeastMicroseconds) return 1e6;
  if (last >= kLeastMilliseconds) return 1e3;
  const double step = keys.size() > 1 ? keys[1].time_s - keys[0].time_s : 0.0;
  if (step < kLongestStep_s) return 1.0;
  return step > kLeastStep_ns ? 1e9 : 0.0;
}

std::string take_time_unit(CameraTrack& track) {
  const double units = time_units_of(track.keys);
  if (units == 0.0) {
    return fmt::format(
        "its times have no unit and are {:g} apart: name the column time_s, time_ms, time_us or "
        "time_ns",
        track.keys[1].time_s - track.keys[0].time_s);
  }
  if (units == 1.0) return "";
  for (TrackKey& key : track.keys) key.time_s /= units;
  const std::string_view name =
      units == 1e9 ? "nanoseconds" : (units == 1e6 ? "microseconds" : "milliseconds");
  track.notes.push_back(fmt::format("times have no unit, and are taken as {} by their size", name));
  return "";
}

std::string read_table(std::string_view text, const PoseColumns& columns, CameraAxes axes,
                       CameraTrack& track) {
  NumberReader numbers;
  KeyRows keys(track);
  CsvRow row{{}, columns.line};
  std::string fault;
  while (!text.empty() && fault.empty()) {
    const std::string_view content = readers::trimmed(readers::take_line(text));
    ++row.line;
    if (content.empty() || content.starts_with('#')) continue;
    fault = take_row(content, columns, row);
    if (!fault.empty()) break;
    const TrackKey key = key_of(row, columns, axes, numbers, fault);
    if (fault.empty()) fault = keys.add(key, row.line);
  }
  keys.finish();
  if (numbers.has_commas()) track.notes.emplace_back("numbers have decimal commas");
  return fault;
}

}  // namespace

bool has_pose_columns(const CameraFile& file) {
  std::string_view text = file.bytes;
  return static_cast<bool>(take_pose_columns(text));
}

base::Result<CameraTrack> read_csv(const CameraFile& file, const CameraReadOptions& options) {
  std::string_view text = file.bytes;
  const base::Result<PoseColumns> columns = take_pose_columns(text);
  if (!columns) return base::Failure{columns.error};
  CameraTrack track;
  track.fps = options.fps;
  const CameraAxes axes =
      options.axes.value_or(columns->is_euroc ? CameraAxes::kCv : CameraAxes::kGl);
  std::string fault = read_table(text, *columns, axes, track);
  if (fault.empty() && !columns->has_time_unit && !track.keys.empty()) {
    fault = take_time_unit(track);
  }
  if (!fault.empty()) return base::Failure{std::move(fault)};
  if (!columns->unclear_fov.empty()) {
    track.why_no_fov = fmt::format(
        "column '{}' is not read, as it is not named fov_x_deg or fov_y_deg", columns->unclear_fov);
  }
  if (columns->is_euroc) {
    track.notes.emplace_back("poses are those of the IMU, taken as a camera that looks along +Z");
  }
  return track;
}

}  // namespace camway::tools
