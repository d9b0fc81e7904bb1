// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "tools/cameras/camera_track.h"

namespace camway::tools {

/// The frame of a camera in a file.
enum class CameraAxes {
  kGl,  ///< looks along -Z, +Y up: OpenGL, glTF, Blender, Nuke, nerfstudio
  kCv,  ///< looks along +Z, +Y down: OpenCV, COLMAP, KITTI, most trajectories of robots
};
constexpr std::array<std::string_view, 2> names_of(CameraAxes) { return {"gl", "cv"}; }

/// A file of a camera path, and the files beside it.
struct CameraFile {
  std::string name;  ///< for messages and for the name of the camera
  std::string bytes;
  /// Reads a file of that name in the folder of this one. Fails with the reason.
  std::function<base::Result<std::string>(const std::string& name)> open_beside;
};

/// How to read it. What a file states comes before what is assumed, and what is given here before
/// both.
struct CameraReadOptions {
  std::string camera;                ///< the one to read; empty: the only one, or the first
  std::string animation = {};        ///< of glTF, the one to read; empty: the first for each node
  std::optional<CameraAxes> axes;    ///< else those of the format
  std::optional<double> fps;         ///< of files that count frames [Limit: 0 < value]
  std::optional<std::string> times;  ///< text with a time in seconds in each line, for KITTI
};

/// A part of a path that a correction changed.
struct CorrectedStretch {
  double t_begin_s = 0.0;
  double t_end_s = 0.0;
  double moved_m = 0.0;
};

/// The content of a written file beside the poses.
struct CameraWriteOptions {
  std::string name = "camera";
  double fov_x_rad = 0.0;  ///< [Limit: 0 < value < pi; 0: there is no lens]
  double fov_y_rad = 0.0;
  double near_m = 0.1;
  int width_px =
      1920;  ///< of the picture; its height is in `facts`, or follows from the fields of view
  bool is_text = false;  ///< glTF as JSON that holds its buffer, not as `.glb`
  std::vector<CorrectedStretch> corrections = {};
  std::vector<TrackKey> keyframes = {};  ///< of the path, given ones and those of corrections
  FileFacts facts = {};                  ///< those of the file that the path came from
  /// Whether there is a lens; a body that is no camera has none.
  [[nodiscard]] bool has_lens() const { return fov_x_rad > 0.0 && fov_y_rad > 0.0; }
};

/// A file that belongs beside a written one.
struct CompanionFile {
  std::string name;
  std::string text;
};

/// A format of camera paths.
struct CameraFormat {
  std::string_view name;         ///< on the command line
  std::string_view extension;    ///< of written files, with the dot
  std::string_view description;  ///< for the help
  base::Result<CameraTrack> (*read)(const CameraFile&, const CameraReadOptions&);
  /// Writes a track that has a key for each frame; null if the format is only read.
  base::Result<std::string> (*write)(const CameraTrack&, const CameraWriteOptions&);
  /// The file that a reader needs beside it; null if it needs none.
  CompanionFile (*companion)(const CameraWriteOptions&) = nullptr;
  bool has_curves = false;  ///< `write` takes cubic tracks with few keys, too
};

/// The properties of a format that decide how a path is written in it.
struct FormatTraits {
  bool needs_lens = true;
  bool has_times = true;
  bool has_free_axes = true;   ///< files may have either camera frame; `--camera-axes` says which
  bool has_free_world = true;  ///< files may have any unit and any axis upwards
  bool has_picture = true;     ///< files state the size of the picture
  bool counts_frames = false;  ///< files number their frames
  CameraAxes axes = CameraAxes::kGl;  ///< those that files have unless someone says otherwise
};
FormatTraits traits_of(const CameraFormat& format);

/// All formats.
std::span<const CameraFormat> camera_formats();
/// The format of this name; null if there is none.
const CameraFormat* camera_format(std::string_view name);
/// The format that a file seems to be of, by its name and its content; null if none. Where a name
/// is common to several formats, the content counts.
const CameraFormat* format_of(const CameraFile& file);
/// Returns why a file is of no format, and what to do. Requires that `format_of` found none.
std::string why_no_format(const CameraFile& file);
/// Returns why no reader can read a file: it is empty, or not what all expect. Empty if one may.
std::string why_unreadable(const CameraFile& file);

/// Reads a track and checks it. The error names the file.
base::Result<CameraTrack> read_camera(const CameraFormat& format, const CameraFile& file,
                                      const CameraReadOptions& options);

/// The orientation of the camera frame that `motion::Pose` has, from that of a frame with other
/// axes, and back: the same half turn about X.
geometry::Quat with_other_axes(const geometry::Quat& orientation, CameraAxes axes);

/// The format's rate, the asked one, or 24 a second, with a note.
double frame_rate(const CameraReadOptions& options, std::optional<double> of_file,
                  std::vector<std::string>& notes);

/// A note for a file with several cameras, of which nobody asked for one.
std::string choice_note(const std::string& chosen, const std::string& names);

/// The height of the picture, in pixels: that of the file, else for pixels that are square.
int height_px(const CameraWriteOptions& options);

/// Sets the size of the picture, if both numbers are such.
void set_size(double width, double height, FileFacts& facts);

/// The name of the picture of a frame, which counts from 0: that of the file that the path came
/// from, if that had as many as there are `frames`.
std::string image_name(const CameraWriteOptions& options, std::size_t frame, std::size_t frames);

}  // namespace camway::tools
