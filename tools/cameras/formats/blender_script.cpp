// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/blender_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/scene/import/readers/decimal.h"
#include "tools/cameras/files/text_rows.h"
#include "tools/json/json_document.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

constexpr std::string_view kKeysBegin = "\nKEYS = [\n";
constexpr std::string_view kKeysEnd = "\n]\n";
constexpr std::size_t kNumbersOfKey = 7;
constexpr double kMillimetresPerMetre = 1000.0;

// The limits of Blender's properties.
constexpr double kSensorWidth_mm = 36.0;  ///< as in the script
constexpr double kShortestLens_mm = 1.0;
constexpr int kFewestBlenderPixels = 4;
constexpr int kMostBlenderPixels = 65536;
constexpr double kLongestPixel = 200.0;

constexpr std::string_view kScriptHead =
    R"(# A camera path of Camway. Run it in Blender: Scripting > Open > Run, or blender --python FILE
import math

import bpy
)";

constexpr std::string_view kScriptBody = R"(
SENSOR_WIDTH_MM = 36.0


def fcurves_of(camera):
    data = camera.animation_data
    if not hasattr(data, "action_slot"):  # before Blender 4.4
        return data.action.fcurves
    return data.action.layers[0].strips[0].channelbag(data.action_slot).fcurves


def put_keys(camera, rows):
    for path, begin, end in (("location", 0, 3), ("rotation_quaternion", 3, 7)):
        setattr(camera, path, rows[0][begin:end])
        camera.keyframe_insert(path, frame=FIRST_FRAME)
        for index, curve in enumerate(c for c in fcurves_of(camera) if c.data_path == path):
            points = curve.keyframe_points
            points.add(len(rows) - 1)
            points.foreach_set("co", [x for i, row in enumerate(rows) for x in (FIRST_FRAME + i, row[begin + index])])
            for point in points:
                point.interpolation = "LINEAR"
            curve.update()


def make_camera(scene):
    data = bpy.data.cameras.new(NAME)
    data.sensor_fit, data.sensor_width = "HORIZONTAL", SENSOR_WIDTH_MM
    data.lens = 0.5 * SENSOR_WIDTH_MM / math.tan(0.5 * FOV_X)
    data.clip_start = NEAR
    camera = bpy.data.objects.new(NAME, data)
    camera.rotation_mode = "QUATERNION"
    scene.collection.objects.link(camera)
    put_keys(camera, [KEYS[i:i + 7] for i in range(0, len(KEYS), 7)])
    scene.camera = camera


def set_picture(scene):
    """Gives pixels the shape with which a picture of this size has both fields of view."""
    height = math.tan(0.5 * FOV_Y) / math.tan(0.5 * FOV_X) * WIDTH / HEIGHT  # of a pixel, by its width
    render = scene.render
    render.resolution_x, render.resolution_y = WIDTH, HEIGHT
    render.pixel_aspect_x, render.pixel_aspect_y = max(1.0, 1.0 / height), max(1.0, height)


def main():
    scene = bpy.context.scene
    scene.render.fps = max(1, round(FPS))
    scene.render.fps_base = scene.render.fps / FPS
    set_picture(scene)
    scene.frame_start, scene.frame_end = FIRST_FRAME, FIRST_FRAME + len(KEYS) // 7 - 1
    make_camera(scene)
    for words, time_s in MARKERS:
        scene.timeline_markers.new(words, frame=FIRST_FRAME + round((time_s - BEGIN_S) * FPS))


main()
)";

/// A text as Python and JSON both write it.
std::string quoted(const std::string& text) { return json_text(nlohmann::json(text)); }

std::string markers_text(const std::vector<CorrectedStretch>& corrections) {
  std::string text = "\n# Where corrections changed the path, in seconds.\nMARKERS = [\n";
  std::size_t number = 0;
  for (const CorrectedStretch& each : corrections) {
    ++number;
    text += fmt::format("    (\"corrected {} ({:.0f} mm)\", {}),\n    (\"end {}\", {}),\n", number,
                        kMillimetresPerMetre * each.moved_m, number_text(each.t_begin_s), number,
                        number_text(each.t_end_s));
  }
  return text + "]\n";
}

std::string keys_text(const CameraTrack& track) {
  std::string text = "\n# A row for each frame: x, y, z, and the quaternion w, x, y, z.";
  text += kKeysBegin;
  geometry::Vec4 before = geometry::wxyz(track.keys.front().pose_W.orientation);
  for (const TrackKey& key : track.keys) {
    const geometry::Vec3& p = key.pose_W.position;
    geometry::Vec4 q = geometry::wxyz(key.pose_W.orientation);
    // F-curves of the components must not go to the other side of the sphere.
    if (q.dot(before) < 0.0) q = -q;
    before = q;
    text +=
        "    " + number_row(std::array{p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]}, ", ") + ",\n";
  }
  return text + "]\n";
}

/// Returns why Blender, which clamps numbers without a word, would show another picture; empty if
/// it would not.
std::string picture_fault(const CameraWriteOptions& options) {
  const double tan_x = std::tan(0.5 * options.fov_x_rad);
  if (0.5 * kSensorWidth_mm < kShortestLens_mm * tan_x) {
    return fmt::format(
        "Blender has no lens shorter than {} mm, so no fov_x above {:.5g} degrees",
        kShortestLens_mm,
        360.0 / std::numbers::pi * std::atan(0.5 * kSensorWidth_mm / kShortestLens_mm));
  }
  const int height = height_px(options);
  for (const int side : {options.width_px, height}) {
    if (side >= kFewestBlenderPixels && side <= kMostBlenderPixels) continue;
    return fmt::format(
        "Blender has pictures of {} to {} pixels a side, not of {} x {} (--width, --height)",
        kFewestBlenderPixels, kMostBlenderPixels, options.width_px, height);
  }
  const double shape = std::tan(0.5 * options.fov_y_rad) / tan_x * options.width_px / height;
  if (std::max(shape, 1.0 / shape) <= kLongestPixel) return "";
  return fmt::format(
      "Blender has no pixels more than {} times as long as wide, which {} x {} of them would be in "
      "these fields of view (--width, --height)",
      kLongestPixel, options.width_px, height);
}

/// The number after "\nNAME = "; nothing if there is none.
std::optional<double> assigned_number(std::string_view script, std::string_view name) {
  const std::string begin = fmt::format("\n{} = ", name);
  const std::size_t at = script.find(begin);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view rest = script.substr(at + begin.size());
  const double number = scene::mesh_readers::parse_decimal(rest.substr(0, rest.find('\n')));
  if (!std::isfinite(number)) return std::nullopt;
  return number;
}

std::string assigned_text(std::string_view script, std::string_view name) {
  const std::string begin = fmt::format("\n{} = ", name);
  const std::size_t at = script.find(begin);
  if (at == std::string_view::npos) return "";
  const std::string_view rest = script.substr(at + begin.size());
  const auto text = parse_document(rest.substr(0, rest.find('\n')), "");
  return text && text->is_string() ? text->get<std::string>() : "";
}

/// Blender keeps single precision.
double as_float(double number) { return static_cast<double>(static_cast<float>(number)); }

std::optional<double> positive(std::optional<double> number) {
  return number && *number > 0.0 ? number : std::nullopt;
}

/// Reads the size of the picture, `WIDTH, HEIGHT = 1920, 1080`.
void read_size(std::string_view script, CameraTrack& track) {
  constexpr std::string_view kBegin = "\nWIDTH, HEIGHT = ";
  const std::size_t at = script.find(kBegin);
  if (at == std::string_view::npos) return;
  const std::string_view rest = script.substr(at + kBegin.size());
  std::vector<double> n;
  const std::vector<TextRow> rows = rows_of(rest.substr(0, rest.find('\n')));
  if (rows.size() == 1 && read_numbers(rows[0], 2, n).empty()) set_size(n[0], n[1], track.facts);
}

/// The key in a row of numbers. Not normalised: Blender normalises what it blends.
TrackKey key_of_row(const std::vector<double>& n, double time_s) {
  return {time_s,
          {geometry::Vec3(as_float(n[0]), as_float(n[1]), as_float(n[2])),
           geometry::Quat(as_float(n[3]), as_float(n[4]), as_float(n[5]), as_float(n[6]))},
          std::nullopt};
}

}  // namespace

base::Result<std::string> write_blender_script(const CameraTrack& track,
                                               const CameraWriteOptions& options) {
  if (!track.fps) return base::Failure{"a script for Blender needs a rate of frames"};
  if (std::string fault = picture_fault(options); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  std::string text(kScriptHead);
  text += "\nNAME = " + quoted(options.name);
  text += fmt::format("\nFIRST_FRAME = {:.0f}", options.facts.first_frame.value_or(1.0));
  text += fmt::format("\nFPS = {}\nBEGIN_S = {}\nWIDTH, HEIGHT = {}, {}", number_text(*track.fps),
                      number_text(track.keys.front().time_s), options.width_px, height_px(options));
  text += fmt::format("\nFOV_X = {}\nFOV_Y = {}\nNEAR = {}\n", number_text(options.fov_x_rad),
                      number_text(options.fov_y_rad), number_text(options.near_m));
  text += markers_text(options.corrections);
  text += keys_text(track);
  text += kScriptBody;
  return text;
}

base::Result<CameraTrack> read_blender_script(const CameraFile& file,
                                              const CameraReadOptions& options) {
  const std::string_view script = file.bytes;
  const std::size_t begin = script.find(kKeysBegin);
  const std::optional<double> fps = positive(assigned_number(script, "FPS"));
  if (begin == std::string_view::npos || !fps)
    return base::Failure{"is no script of camway export"};
  std::string_view rows = script.substr(begin + kKeysBegin.size());
  const std::size_t end = rows.find(kKeysEnd);
  if (end == std::string_view::npos) return base::Failure{"ends within its keys"};
  rows = rows.substr(0, end);
  CameraTrack track;
  track.name = assigned_text(script, "NAME");
  track.fps = options.fps ? options.fps : fps;
  track.playback = Playback::kBlend;
  track.fov_x_rad = positive(assigned_number(script, "FOV_X"));
  track.fov_y_rad = positive(assigned_number(script, "FOV_Y"));
  track.near_m = positive(assigned_number(script, "NEAR"));
  track.facts.first_frame = assigned_number(script, "FIRST_FRAME");
  read_size(script, track);
  const double begin_s = assigned_number(script, "BEGIN_S").value_or(0.0);
  std::vector<double> numbers;
  for (const TextRow& row : rows_of(rows)) {
    const std::string error = read_numbers(row, kNumbersOfKey, numbers);
    if (!error.empty()) return base::Failure{"KEYS: " + error};
    const double time_s = begin_s + static_cast<double>(track.keys.size()) / *track.fps;
    track.keys.push_back(key_of_row(numbers, time_s));
  }
  return track;
}

}  // namespace camway::tools
