// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/colmap_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "daemon/scene/import/readers/tokens.h"
#include "tools/cameras/files/text_rows.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;

struct Image {
  std::string name;
  std::string camera;
  motion::Pose pose_W;
};

constexpr std::size_t kImageNumbers = 8;

/// Reads the line of an image. Returns why that is not possible.
std::string read_image(const TextRow& row, CameraAxes axes, Image& image) {
  if (row.words.size() < kImageNumbers + 2) {
    return fmt::format("line {}: has {} words, not 10", row.line, row.words.size());
  }
  TextRow numbers_only{row.line, {row.words.begin(), row.words.begin() + kImageNumbers}};
  std::vector<double> n;
  std::string fault = read_numbers(numbers_only, kImageNumbers, n);
  if (!fault.empty()) return fault;
  const Quat to_camera(n[1], n[2], n[3], n[4]);
  if (!(to_camera.norm() > 0.0)) return fmt::format("line {}: has no rotation", row.line);
  const Quat to_world = to_camera.normalized().conjugate();
  image.camera = row.words[kImageNumbers];
  image.name = row.words[kImageNumbers + 1];
  image.pose_W = {Vec3(-(to_world * Vec3(n[5], n[6], n[7]))), with_other_axes(to_world, axes)};
  return "";
}

/// Every second line that is no comment is one of points, which may be empty.
std::string read_images(std::string_view text, CameraAxes axes, std::vector<Image>& images) {
  text = scene::mesh_readers::without_bom(text);
  bool is_image = true;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string_view content =
        scene::mesh_readers::trimmed(scene::mesh_readers::take_line(text));
    if (content.starts_with('#')) continue;
    if (is_image) {
      std::vector<TextRow> rows = rows_of(content);
      if (rows.empty()) {
        if (scene::mesh_readers::is_blank(text)) break;
        return fmt::format("line {}: should have an image", line);
      }
      rows[0].line = line;
      std::string fault = read_image(rows[0], axes, images.emplace_back());
      if (!fault.empty()) return fault;
    }
    is_image = !is_image;
  }
  return "";
}

/// A lens of `cameras.txt`, distortion left aside.
struct Lens {
  double fov_x_rad = 0.0;
  double fov_y_rad = 0.0;
  std::string why_none;  ///< empty if it has the angles
};

constexpr std::array<std::string_view, 6> kTwoFocalLengths = {
    "PINHOLE", "OPENCV", "FULL_OPENCV", "OPENCV_FISHEYE", "FOV", "THIN_PRISM_FISHEYE"};

Lens lens_of(const TextRow& row) {
  const std::string_view model = row.words[1];
  if (model == "FOV" || model.ends_with("FISHEYE")) {
    return {0.0, 0.0, fmt::format("cameras.txt has the model {}, which is no flat picture", model)};
  }
  std::vector<double> n;
  const TextRow tail{row.line, {row.words.begin() + 2, row.words.end()}};
  std::string fault = read_numbers(tail, 3, n);
  const bool has_two = std::ranges::count(kTwoFocalLengths, model) > 0 && n.size() > 3;
  if (!fault.empty() || !(n[0] > 0.0 && n[1] > 0.0 && n[2] > 0.0) || (has_two && !(n[3] > 0.0))) {
    return {0.0, 0.0, fmt::format("line {} of cameras.txt has no usable lens", row.line)};
  }
  const double focal_y = has_two ? n[3] : n[2];
  return {2.0 * std::atan(0.5 * n[0] / n[2]), 2.0 * std::atan(0.5 * n[1] / focal_y), ""};
}

/// Gives each key the lens of its image. Returns why that is not possible.
std::string take_lenses(const std::string& cameras, const std::vector<Image>& images,
                        CameraTrack& track) {
  std::map<std::string, Lens, std::less<>> lenses;
  for (const TextRow& row : rows_of(cameras)) {
    if (row.words.size() >= 5) lenses.emplace(row.words[0], lens_of(row));
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto lens = lenses.find(images[i].camera);
    if (lens == lenses.end()) {
      return fmt::format("cameras.txt has no camera {}", images[i].camera);
    }
    if (!lens->second.why_none.empty()) return lens->second.why_none;
    track.keys[i].fov_x_rad = lens->second.fov_x_rad;
    track.keys[i].fov_y_rad = lens->second.fov_y_rad;
  }
  return "";
}

/// The size of the pictures of a camera of `cameras.txt`.
void read_size(const std::string& cameras, const std::string& id, FileFacts& facts) {
  for (const TextRow& row : rows_of(cameras)) {
    if (row.words.size() < 5 || row.words[0] != id) continue;
    std::vector<double> n;
    if (read_numbers({row.line, {row.words[2], row.words[3]}}, 2, n).empty()) {
      set_size(n[0], n[1], facts);
    }
    return;
  }
}

}  // namespace

base::Result<CameraTrack> read_colmap(const CameraFile& file, const CameraReadOptions& options) {
  std::vector<Image> images;
  std::string fault = read_images(file.bytes, options.axes.value_or(CameraAxes::kCv), images);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  std::ranges::stable_sort(images, {}, &Image::name);
  CameraTrack track;
  track.has_times = options.fps.has_value();
  track.fps = options.fps;
  for (std::size_t i = 0; i < images.size(); ++i) {
    track.keys.push_back(
        {static_cast<double>(i) / options.fps.value_or(1.0), images[i].pose_W, {}});
    track.facts.images.push_back(images[i].name);
  }
  if (images.empty() || !file.open_beside) return track;
  const base::Result<std::string> cameras = file.open_beside("cameras.txt");
  if (cameras) read_size(*cameras, images[0].camera, track.facts);
  track.why_no_fov =
      cameras ? take_lenses(*cameras, images, track) : "cameras.txt beside it " + cameras.error;
  if (!track.why_no_fov.empty()) {
    for (TrackKey& key : track.keys) key.fov_x_rad = key.fov_y_rad = std::nullopt;
  }
  return track;
}

CompanionFile colmap_cameras(const CameraWriteOptions& options) {
  const int height = height_px(options);
  const double width = options.width_px;
  const double focal_x = 0.5 * width / std::tan(0.5 * options.fov_x_rad);
  const double focal_y = 0.5 * height / std::tan(0.5 * options.fov_y_rad);
  return {"cameras.txt",
          fmt::format("# Camera list with one line of data per camera:\n"
                      "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
                      "1 PINHOLE {} {} {} {} {} {}\n",
                      options.width_px, height, focal_x, focal_y, 0.5 * width, 0.5 * height)};
}

base::Result<std::string> write_colmap(const CameraTrack& track,
                                       const CameraWriteOptions& options) {
  std::string text =
      "# Image list with two lines of data per image:\n"
      "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "#   POINTS2D[] as (X, Y, POINT3D_ID)\n";
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const motion::Pose& pose = track.keys[i].pose_W;
    const Quat to_camera = with_other_axes(pose.orientation, CameraAxes::kCv).conjugate();
    const Vec3 t = -(to_camera * pose.position);
    text += fmt::format(
        "{} {} {} 1 {}\n\n", i + 1,
        number_row(std::array{to_camera.w(), to_camera.x(), to_camera.y(), to_camera.z()}),
        number_row(std::array{t.x(), t.y(), t.z()}), image_name(options, i, track.keys.size()));
  }
  return text;
}

}  // namespace camway::tools
