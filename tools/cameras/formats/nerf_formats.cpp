// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/nerf_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <nlohmann/json.hpp>

#include "tools/cameras/files/rotation_matrix.h"
#include "tools/json/json_document.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
using OrderedJson = nlohmann::ordered_json;
/// A 4 × 4 matrix by rows.
using Rows = std::array<double, 16>;

constexpr double degrees_of_nerf(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }
constexpr double radians_of_nerf(double angle_deg) { return angle_deg * std::numbers::pi / 180.0; }

/// Reads a matrix as 16 numbers, or as 3 or 4 rows of 4.
Rows rows_in(const Field& field) {
  Rows rows{};
  const std::size_t count = field.size();
  if (count == 16) {
    field.numbers(rows.data(), 16);
  } else if (count == 3 || count == 4) {
    for (std::size_t i = 0; i < count; ++i) field.element(i).numbers(&rows[4 * i], 4);
  } else {
    field.fail("must be 16 numbers, or 3 or 4 rows of 4");
  }
  return rows;
}

/// Scene scales of such programs are in the matrix as well: columns are normalised.
motion::Pose pose_in(const Field& field, CameraAxes axes) {
  const Rows m = rows_in(field);
  Eigen::Matrix3d rotation;
  rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  const std::string fault = take_scale(rotation);
  if (!fault.empty()) {
    field.fail(fault);
    return {};
  }
  return {Vec3(m[3], m[7], m[11]), with_other_axes(Quat(rotation).normalized(), axes)};
}

Rows rows_of_pose(const motion::Pose& pose) {
  const Eigen::Matrix3d r = pose.orientation.toRotationMatrix();
  const Vec3& p = pose.position;
  return {r(0, 0), r(0, 1), r(0, 2), p.x(), r(1, 0), r(1, 1), r(1, 2), p.y(),
          r(2, 0), r(2, 1), r(2, 2), p.z(), 0.0,     0.0,     0.0,     1.0};
}

Rows columns_of_pose(const motion::Pose& pose) {
  const Rows rows = rows_of_pose(pose);
  Rows columns{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) columns[4 * j + i] = rows[4 * i + j];
  }
  return columns;
}

std::optional<double> number_member(const Field& object, std::string_view key) {
  const std::optional<Field> member = object.optional_member(key);
  if (!member || member->is_null()) return std::nullopt;
  return member->number();
}

/// Reads a document by `read(root, track)`.
template <class Read>
base::Result<CameraTrack> read_json(const CameraFile& file, const Read& read) {
  const base::Result<nlohmann::json> document = parse_document(file.bytes, file.name);
  if (!document) return base::Failure{document.error.substr(file.name.size() + 2)};
  DocumentNotes notes;
  CameraTrack track;
  read(Field(*document, notes), track);
  if (!notes.error.empty()) return base::Failure{notes.error};
  return track;
}

/// Returns the vertical field of view of the largest picture with square pixels that lies within
/// the fields of view: nerfstudio has one focal length for both directions. A wider one would show
/// what was not proved.
double fov_of_square_pixels_rad(const CameraWriteOptions& options) {
  const double aspect = static_cast<double>(options.width_px) / height_px(options);
  return std::min(options.fov_y_rad, fov_across_rad(options.fov_x_rad, 1.0 / aspect));
}

std::string text_member(const Field& object, std::string_view key) {
  const std::optional<Field> member = object.optional_member(key);
  return member && !member->is_null() ? member->text() : "";
}

/// The angles of view of `transforms.json`, which it may have for all frames and for each.
struct ViewAngles {
  std::optional<double> x_rad;
  std::optional<double> y_rad;
};

/// Reads angles from an object; sizes and focal lengths that it lacks are those of `root`.
ViewAngles angles_in(const Field& object, const Field& root) {
  const auto number = [&](std::string_view key) {
    const auto own = number_member(object, key);
    return own ? own : number_member(root, key);
  };
  ViewAngles angles{number("camera_angle_x"), number("camera_angle_y")};
  const bool has_own = number_member(object, "fl_x") || number_member(object, "fl_y");
  const auto width = number("w");
  const auto height = number("h");
  const auto focal_x = number("fl_x");
  const auto focal_y = number("fl_y");
  if ((!angles.x_rad || has_own) && width && focal_x && *focal_x > 0.0) {
    angles.x_rad = 2.0 * std::atan(0.5 * *width / *focal_x);
  }
  const auto other = focal_y ? focal_y : focal_x;
  if ((!angles.y_rad || has_own) && height && other && *other > 0.0) {
    angles.y_rad = 2.0 * std::atan(0.5 * *height / *other);
  }
  return angles;
}

/// Why a camera model has no field of view as a flat picture has; empty if it is one.
std::string model_fault(const std::string& model) {
  for (const std::string_view kind : {"FISHEYE", "EQUIRECTANGULAR", "fisheye", "equirectangular",
                                      "VR180", "OMNIDIRECTIONAL", "omnidirectional"}) {
    if (model.find(kind) != std::string::npos) {
      return fmt::format("its camera is of the kind '{}', which is no flat picture", model);
    }
  }
  return "";
}

std::string model_fault_of(const Field& root) {
  const std::optional<Field> fisheye = root.optional_member("is_fisheye");
  if (fisheye && !fisheye->is_null() && fisheye->boolean()) return model_fault("fisheye");
  return model_fault(text_member(root, "camera_model"));
}

}  // namespace

base::Result<CameraTrack> read_nerfstudio(const CameraFile& file,
                                          const CameraReadOptions& options) {
  return read_json(file, [&](const Field& root, CameraTrack& track) {
    const Field path = root.member("camera_path");
    const std::size_t count = path.size();
    std::optional<double> fps = number_member(root, "fps");
    const std::optional<double> seconds = number_member(root, "seconds");
    if (!fps && seconds && *seconds > 0.0) fps = static_cast<double>(count) / *seconds;
    track.fps = frame_rate(options, fps, track.notes);
    const CameraAxes axes = options.axes.value_or(CameraAxes::kGl);
    track.why_no_fov = model_fault(text_member(root, "camera_type"));
    for (std::size_t i = 0; i < count && !root.failed(); ++i) {
      const Field each = path.element(i);
      TrackKey key{static_cast<double>(i) / *track.fps,
                   pose_in(each.member("camera_to_world"), axes), std::nullopt};
      const auto fov = number_member(each, "fov");
      if (fov && track.why_no_fov.empty()) key.fov_y_rad = radians_of_nerf(*fov);
      track.keys.push_back(key);
    }
    const auto width = number_member(root, "render_width");
    const auto height = number_member(root, "render_height");
    if (width && height && *width > 0.0 && *height > 0.0) track.aspect = *width / *height;
    if (width && height) set_size(*width, *height, track.facts);
  });
}

base::Result<std::string> write_nerfstudio(const CameraTrack& track,
                                           const CameraWriteOptions& options) {
  const double fps = track.fps.value_or(24.0);
  const double fov_deg = degrees_of_nerf(fov_of_square_pixels_rad(options));
  const int height = height_px(options);
  const double aspect = static_cast<double>(options.width_px) / height;
  OrderedJson json;
  OrderedJson keyframes = OrderedJson::array();
  OrderedJson path = OrderedJson::array();
  for (const TrackKey& key : track.keys) {
    const std::string matrix = OrderedJson(columns_of_pose(key.pose_W)).dump();
    const double since_s = key.time_s - track.keys.front().time_s;
    const double whole_s = track.keys.back().time_s - track.keys.front().time_s;
    const double share = whole_s > 0.0 ? since_s / whole_s : 0.0;
    const std::string properties = json_text(OrderedJson::array(
        {OrderedJson::array({"FOV", fov_deg}), OrderedJson::array({"NAME", options.name}),
         OrderedJson::array({"TIME", share})}));
    keyframes.push_back(
        {{"matrix", matrix}, {"fov", fov_deg}, {"aspect", aspect}, {"properties", properties}});
    path.push_back(
        {{"camera_to_world", rows_of_pose(key.pose_W)}, {"fov", fov_deg}, {"aspect", aspect}});
  }
  json["camera_type"] = "perspective";
  json["render_height"] = height;
  json["render_width"] = options.width_px;
  json["fps"] = fps;
  json["seconds"] = static_cast<double>(track.keys.size()) / fps;
  json["smoothness_value"] = 0;
  json["is_cycle"] = false;
  json["keyframes"] = std::move(keyframes);
  json["camera_path"] = std::move(path);
  return json_text(json, 1) + "\n";
}

base::Result<CameraTrack> read_transforms(const CameraFile& file,
                                          const CameraReadOptions& options) {
  return read_json(file, [&](const Field& root, CameraTrack& track) {
    track.why_no_fov = model_fault_of(root);
    const bool is_flat = track.why_no_fov.empty();
    const auto width = number_member(root, "w");
    const auto height = number_member(root, "h");
    if (width && height && *width > 0.0 && *height > 0.0) track.aspect = *width / *height;
    set_size(width.value_or(0.0), height.value_or(0.0), track.facts);
    const Field frames = root.member("frames");
    const CameraAxes axes = options.axes.value_or(CameraAxes::kGl);
    track.has_times = options.fps.has_value();
    track.fps = options.fps;
    for (std::size_t i = 0; i < frames.size() && !root.failed(); ++i) {
      const Field frame = frames.element(i);
      const ViewAngles angles = is_flat ? angles_in(frame, root) : ViewAngles{};
      const std::optional<Field> image = frames.element(i).optional_member("file_path");
      track.facts.images.push_back(image ? image->text() : "");
      track.keys.push_back({static_cast<double>(i) / options.fps.value_or(1.0),
                            pose_in(frame.member("transform_matrix"), axes), angles.y_rad,
                            angles.x_rad});
    }
    // Pictures without names get new ones.
    if (std::ranges::count(track.facts.images, "") > 0) track.facts.images.clear();
  });
}

base::Result<std::string> write_transforms(const CameraTrack& track,
                                           const CameraWriteOptions& options) {
  const int height = height_px(options);
  OrderedJson frames = OrderedJson::array();
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const Rows m = rows_of_pose(track.keys[i].pose_W);
    OrderedJson matrix = OrderedJson::array();
    for (std::size_t row = 0; row < 4; ++row) {
      matrix.push_back({m[4 * row], m[4 * row + 1], m[4 * row + 2], m[4 * row + 3]});
    }
    frames.push_back(
        {{"file_path", image_name(options, i, track.keys.size())}, {"transform_matrix", matrix}});
  }
  OrderedJson json;
  json["camera_angle_x"] = options.fov_x_rad;
  json["camera_angle_y"] = options.fov_y_rad;
  json["fl_x"] = 0.5 * options.width_px / std::tan(0.5 * options.fov_x_rad);
  json["fl_y"] = 0.5 * height / std::tan(0.5 * options.fov_y_rad);
  json["w"] = options.width_px;
  json["h"] = height;
  json["frames"] = std::move(frames);
  return json_text(json, 1) + "\n";
}

}  // namespace camway::tools
