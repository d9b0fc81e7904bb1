// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/camera_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <utility>

#include "tools/cameras/formats/blender_script.h"
#include "tools/cameras/formats/chan_format.h"
#include "tools/cameras/formats/colmap_format.h"
#include "tools/cameras/formats/gltf_formats.h"
#include "tools/cameras/formats/mcap_formats.h"
#include "tools/cameras/formats/nerf_formats.h"
#include "tools/cameras/formats/pose_tables.h"
#include "tools/cameras/formats/scene_file_format.h"

namespace camway::tools {
namespace {

constexpr double kUsualRate = 24.0;
constexpr double kMostPixels = 1e6;  // of a side of the picture

constexpr std::array<CameraFormat, 12> kFormats = {{
    {"gltf", ".glb", "glTF 2.0, an animated camera", read_gltf, write_gltf, nullptr, true},
    {"blender", ".py", "script that makes the camera in Blender", read_blender_script,
     write_blender_script},
    {"fbx", ".fbx", "FBX, an animated camera", read_scene_file, nullptr},
    {"collada", ".dae", "COLLADA, an animated camera", read_scene_file, nullptr},
    {"mcap", ".mcap", "MCAP with messages in JSON, for Foxglove", read_mcap, write_mcap},
    {"tum", ".txt", "TUM trajectory: t x y z qx qy qz qw", read_tum, write_tum},
    {"csv", ".csv", "table with named columns; EuRoC", read_csv, write_csv},
    {"kitti", ".txt", "KITTI poses: 3 x 4 matrices", read_kitti, write_kitti},
    {"chan", ".chan", "Nuke channels", read_chan, write_chan},
    {"nerfstudio", ".json", "nerfstudio's camera_path.json", read_nerfstudio, write_nerfstudio},
    {"transforms", ".json", "transforms.json of instant-ngp and others", read_transforms,
     write_transforms},
    {"colmap", ".txt", "COLMAP's images.txt", read_colmap, write_colmap, colmap_cameras},
}};

}  // namespace

std::span<const CameraFormat> camera_formats() { return kFormats; }

const CameraFormat* camera_format(std::string_view name) {
  const auto found = std::ranges::find(kFormats, name, &CameraFormat::name);
  return found == kFormats.end() ? nullptr : &*found;
}

base::Result<CameraTrack> read_camera(const CameraFormat& format, const CameraFile& file,
                                      const CameraReadOptions& options) {
  if (std::string why = why_unreadable(file); !why.empty()) {
    return base::Failure{file.name + ": " + why};
  }
  base::Result<CameraTrack> track = format.read(file, options);
  std::string fault = track ? fault_of(*track) : track.error;
  if (!fault.empty()) return base::Failure{file.name + ": " + fault};
  if (track->name.empty()) track->name = std::filesystem::path(file.name).stem().string();
  return track;
}

geometry::Quat with_other_axes(const geometry::Quat& orientation, CameraAxes axes) {
  return axes == CameraAxes::kGl ? orientation
                                 : geometry::Quat(orientation * geometry::Quat(0, 1, 0, 0));
}

double frame_rate(const CameraReadOptions& options, std::optional<double> of_file,
                  std::vector<std::string>& notes) {
  if (options.fps) return *options.fps;
  if (of_file && *of_file > 0.0) return *of_file;
  notes.emplace_back("the file states no rate of frames: 24 a second are assumed (--fps)");
  return kUsualRate;
}

std::string choice_note(const std::string& chosen, const std::string& names) {
  return "camera '" + chosen +
         "' was taken of several, the first that moves (--camera names one): " + names;
}

FormatTraits traits_of(const CameraFormat& format) {
  FormatTraits traits;
  const auto is = [&](std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, format.name) != names.end();
  };
  traits.needs_lens = !is({"tum", "kitti", "csv", "chan", "mcap"});
  traits.has_times = !is({"kitti", "transforms", "colmap"});
  traits.has_free_axes = !is({"gltf", "blender"});
  traits.has_free_world = !is({"gltf"});
  traits.has_picture = !is({"gltf", "tum", "kitti", "csv", "chan"});
  traits.counts_frames = is({"blender", "chan"});
  if (is({"tum", "kitti", "colmap", "mcap"})) traits.axes = CameraAxes::kCv;
  return traits;
}

void set_size(double width, double height, FileFacts& facts) {
  if (!(width >= 1.0 && width <= kMostPixels && height >= 1.0 && height <= kMostPixels)) return;
  facts.width_px = static_cast<int>(std::lround(width));
  facts.height_px = static_cast<int>(std::lround(height));
}

std::string image_name(const CameraWriteOptions& options, std::size_t frame, std::size_t frames) {
  if (options.facts.images.size() == frames) return options.facts.images[frame];
  return fmt::format("frame_{:06}.png", frame + 1);
}

int height_px(const CameraWriteOptions& options) {
  if (options.facts.height_px > 0) return options.facts.height_px;
  const double ratio = std::tan(0.5 * options.fov_y_rad) / std::tan(0.5 * options.fov_x_rad);
  // A field of view of nearly half a turn in one direction alone has more rows than an int counts.
  return static_cast<int>(std::lround(std::clamp(options.width_px * ratio, 1.0, kMostPixels)));
}

}  // namespace camway::tools
