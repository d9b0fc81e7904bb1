// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/cli_support/flag_checks.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/cameras/export/file_mapping.h"
#include "tools/cameras/formats/camera_file.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/cameras/frame_rate.h"
#include "tools/cameras/path_samples.h"
#include "tools/cameras/track_thinning.h"
#include "tools/camway/cameras/import_request.h"
#include "tools/camway/cameras/log_track.h"
#include "tools/camway/cameras/scene_fit.h"
#include "tools/camway/common/commands.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_document.h"
#include "tools/json/json_request.h"
#include "tools/json/json_text.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

struct ImportFlags {
  std::string file;
  std::string format;
  std::string times;
  CameraReadOptions read;
  LogTrackOptions log;
  std::string scene;
  double scale = 1.0;
  std::optional<double> camera_scale;
  scene::UpAxis up = scene::UpAxis::kAsInFile;
  ImportLens lens;
  std::string body;
  bool all = false;
  std::optional<std::size_t> every;
  std::optional<double> within_m;
  std::optional<double> within_deg;
  std::string request;

  /// The scale of the camera file, which may have another unit than the scene.
  [[nodiscard]] double scale_of_camera() const { return camera_scale.value_or(scale); }
};

/// Takes the rate of frames from the times where the file states none.
void measure_rate(CameraTrack& track) {
  if (track.fps || !track.has_times) return;
  std::vector<double> times_s;
  for (const TrackKey& key : track.keys) times_s.push_back(key.time_s);
  track.fps = rate_of_times(times_s);
  track.notes.push_back(
      track.fps
          ? fmt::format("its times are {:.6g} frames a second, which export writes again (--fps)",
                        *track.fps)
          : "its times are on the frames of no rate: export writes 24 frames a second, or --fps");
}

/// Logs are no files of cameras: they are recognised by their first bytes, and may be larger than
/// memory.
constexpr CameraFormat kLogFormat{"lcm", ".lcmlog", "log of lcm-logger, poses of one channel",
                                  nullptr, nullptr};

base::Result<CameraTrack> read_log(const ImportFlags& flags) {
  if (!flags.format.empty() && flags.format != kLogFormat.name) {
    return base::Failure{fmt::format("--format: {} is a log of lcm-logger, which is read as {}",
                                     flags.file, kLogFormat.name)};
  }
  if (flags.log.types.empty() || flags.log.position.empty()) {
    return base::Failure{flags.file +
                         ": is a log of lcm-logger: --type names the .lcm file of its messages, "
                         "--position their member with the position"};
  }
  if (flags.log.orientation.empty() && flags.body.empty()) {
    return base::Failure{flags.file +
                         ": --orientation names the member with the quaternion; only a --body can "
                         "do without"};
  }
  LogTrackOptions options = flags.log;
  options.axes = flags.read.axes.value_or(CameraAxes::kGl);
  options.fps = flags.read.fps;
  base::Result<CameraTrack> track = read_log_track(flags.file, options);
  if (track && flags.body.empty() && !flags.read.axes) {
    track->notes.emplace_back("the camera is taken to look along -Z, +Y up (--camera-axes)");
  }
  return track;
}

std::string flag_of_logs(const ImportFlags& flags) {
  const LogTrackOptions& log = flags.log;
  if (flags.format == kLogFormat.name) return "--format";
  if (!log.channel.empty()) return "--channel";
  if (!log.types.empty()) return "--type";
  if (!log.position.empty()) return "--position";
  if (!log.orientation.empty()) return "--orientation";
  return log.time.empty() ? "" : "--time";
}

base::Result<CameraTrack> read_camera_track(const ImportFlags& flags, const CameraFormat*& format) {
  const base::Result<CameraFile> file = camera_file(flags.file);
  if (!file) return base::Failure{file.error};
  if (const std::string flag = flag_of_logs(flags); !flag.empty()) {
    return base::Failure{flag + ": " + flags.file + " is no log of lcm-logger"};
  }
  if (const std::string why = why_unreadable(*file); !why.empty()) {
    return base::Failure{flags.file + ": " + why};
  }
  format = flags.format.empty() ? format_of(*file) : camera_format(flags.format);
  if (format == nullptr) {
    return base::Failure{flags.file + ": " + why_no_format(*file)};
  }
  CameraReadOptions options = flags.read;
  // A body has the frame that its file has.
  if (!flags.body.empty() && !options.axes) options.axes = CameraAxes::kGl;
  if (!flags.times.empty()) {
    const base::Result<std::string> times = read_text(flags.times);
    if (!times) return base::Failure{times.error};
    options.times = *times;
  }
  base::Result<CameraTrack> track = read_camera(*format, *file, options);
  if (!track && flags.format.empty()) {
    return base::Failure{
        fmt::format("{} (read as {}; --format names another)", track.error, format->name)};
  }
  return track;
}

base::Result<CameraTrack> read_track(const ImportFlags& flags, const CameraFormat*& format) {
  const bool is_log = is_event_log(flags.file);
  if (is_log) format = &kLogFormat;
  base::Result<CameraTrack> track = is_log ? read_log(flags) : read_camera_track(flags, format);
  if (track && track->keys.size() < 2) {
    return base::Failure{flags.file + ": has one pose; a path needs two"};
  }
  if (track) measure_rate(*track);
  return track;
}

/// Poses without times have no path between them to compare with.
ThinnedTrack choose_keyframes(const ImportFlags& flags, const CameraTrack& track) {
  if (flags.all || (!track.has_times && !flags.every)) return every(track, 1);
  if (flags.every) return every(track, *flags.every);
  ThinningTolerance tolerance;
  if (flags.within_m) tolerance.position_m = *flags.within_m;
  if (flags.within_deg) tolerance.turn_rad = radians(*flags.within_deg);
  return thinned(track, tolerance);
}

/// The scene's file as the request names it: relative to the request's folder.
std::string scene_in_request(const ImportFlags& flags) {
  if (flags.scene.empty() || flags.request == "-") return flags.scene;
  std::error_code error;
  const fs::path folder = fs::absolute(flags.request, error).parent_path();
  const fs::path relative = fs::absolute(flags.scene, error).lexically_relative(folder);
  return relative.empty() ? flags.scene : relative.string();
}

void print_summary(const ImportFlags& flags, const CameraFormat& format, const CameraTrack& track,
                   std::size_t poses, const ThinnedTrack& kept) {
  const std::string rate = track.fps ? fmt::format(", {:g} frames a second", *track.fps) : "";
  print_error(fmt::format("{}: {}, camera '{}': {} poses{}", flags.file, format.name, track.name,
                          poses, rate));
  for (const std::string& note : track.notes) print_error("note: " + note);
  if (!track.has_times) {
    print_error(fmt::format("{}: {} keyframes without times; --fps gives times", flags.request,
                            kept.kept.size()));
    return;
  }
  print_error(fmt::format(
      "{}: {} keyframes; the path through them is within {:.2g} m and {:.2g} degrees of all poses",
      flags.request, kept.kept.size(), kept.largest_position_m, degrees(kept.largest_turn_rad)));
}

ExitCode refuse_file(const std::string& error) {
  print_error(error);
  return ExitCode::kInvalidInput;
}

/// The remark from which `export` writes such a file again.
CameraRemark remark_of(const ImportFlags& flags, const CameraFormat& format,
                       const CameraTrack& track) {
  CameraRemark remark;
  remark.name = track.name;
  remark.format = format.name;
  remark.fps = track.fps;
  remark.has_times = track.has_times;
  remark.axes = flags.read.axes;
  if (!flags.body.empty() && !remark.axes) remark.axes = CameraAxes::kGl;
  remark.scale = flags.scale_of_camera();
  remark.up = flags.up;
  remark.facts = track.facts;
  return remark;
}

bool states_lens(const CameraTrack& track, const ImportLens& lens) {
  return lens.fov_x_deg || lens.fov_y_deg || widest_fov_x_rad(track) || widest_fov_y_rad(track);
}

/// Whether files of a format say what a unit is.
bool states_unit(const CameraFormat& format) {
  return format.name == "gltf" || format.name == "fbx" || format.name == "collada";
}

/// The moving thing. A body needs no lens, but keeps that of its file.
base::Result<RequestBody> body_of(const ImportFlags& flags, CameraTrack& track) {
  RequestBody body;
  if (!flags.body.empty()) {
    body.shape = nlohmann::ordered_json::parse(flags.body, nullptr, false);
    if (!body.shape.is_object()) {
      return base::Failure{"--body must be JSON as in a request: {\"type\": \"box\", ...}"};
    }
  }
  if (!flags.body.empty() && !states_lens(track, flags.lens)) return body;
  const base::Result<RequestCamera> camera = camera_of(track, flags.lens);
  if (!camera) return base::Failure{flags.file + ": " + camera.error};
  body.camera = *camera;
  return body;
}

/// Warns where the user's choice of keyframes lost the motion.
void warn_of_loss(const ThinnedTrack& kept) {
  constexpr double kManyTimes = 10.0;
  const ThinningTolerance usual;
  if (kept.largest_position_m <= kManyTimes * usual.position_m &&
      kept.largest_turn_rad <= kManyTimes * usual.turn_rad) {
    return;
  }
  print_error(fmt::format(
      "warning: the path through the keyframes is another one than the file's: up to {:.2g} m and "
      "{:.2g} degrees off; more keyframes follow it (--within-m and --within-deg, not --every)",
      kept.largest_position_m, degrees(kept.largest_turn_rad)));
}

/// Warns of what the first plan would stumble over.
void warn_of_scene(const ImportFlags& flags, const CameraFormat& format, const CameraTrack& track,
                   const ThinnedTrack& kept) {
  if (flags.scene.empty()) return;
  PlacedPath path{flags.file, states_unit(format), flags.scale_of_camera(), {}};
  for (const std::size_t i : kept.kept) path.keyframes_W.push_back(track.keys[i].pose_W.position);
  scene::ImportOptions options;
  options.scale = flags.scale;
  options.up = flags.up;
  for (const std::string& words : scene_warnings(flags.scene, options, path)) {
    print_error("warning: " + words);
  }
}

ExitCode run_import(const ImportFlags& flags) {
  std::error_code error_code;
  if (!flags.scene.empty() && !fs::exists(flags.scene, error_code)) {
    return refuse_file("--scene: " + flags.scene + " does not exist");
  }
  if (fs::is_directory(flags.scene, error_code)) {
    return refuse_file("--scene: " + flags.scene + " is a folder, not a scene file");
  }
  if (flags.request != "-") {
    std::vector<std::string> inputs = {flags.file, flags.scene, flags.body, flags.times};
    inputs.insert(inputs.end(), flags.log.types.begin(), flags.log.types.end());
    const std::string fault = why_unwritable(flags.request, inputs);
    if (!fault.empty()) return refuse_file(fault);
  }
  if (const std::string name = scene_in_request(flags); as_utf8(name) != name) {
    return refuse_file("--scene: " + name +
                       " is a name that is not UTF-8, which no request can hold");
  }
  const CameraFormat* format = nullptr;
  base::Result<CameraTrack> track = read_track(flags, format);
  if (!track) return refuse_file(track.error);
  place_as_scene(*track, flags.scale_of_camera(), flags.up);
  const base::Result<RequestBody> body = body_of(flags, *track);
  if (!body) return refuse_file(body.error);
  // The user counts poses of the file. Else the path is compared where a person sees it, at frames:
  // keys may be far apart, on curves between them.
  const bool counts_poses = flags.all || flags.every.has_value();
  const CameraTrack compared = counts_poses ? *track : with_frames_between(*track);
  const ThinnedTrack kept = choose_keyframes(flags, compared);
  const std::string text = json_text(request_json(compared, kept, *body,
                                                  {scene_in_request(flags), flags.scale, flags.up},
                                                  remark_of(flags, *format, *track)),
                                     2) +
                           "\n";
  if (const auto request = parse_as<RequestFile>(text, flags.request); !request) {
    return refuse_file(request.error);
  }
  print_summary(flags, *format, compared, track->keys.size(), kept);
  if (flags.every) warn_of_loss(kept);
  warn_of_scene(flags, *format, compared, kept);
  if (flags.request == "-") {
    fmt::print("{}", text);
    return ExitCode::kSuccess;
  }
  const std::string error = write_file(flags.request, text);
  return error.empty() ? ExitCode::kSuccess : refuse_file(error);
}

void add_file_flags(CLI::App& command, ImportFlags& flags) {
  command.add_option("file", flags.file, "File with the camera path")->required();
  std::vector<std::string> names;
  for (const CameraFormat& format : camera_formats()) names.emplace_back(format.name);
  names.emplace_back(kLogFormat.name);
  command.add_option("--format", flags.format, "Format of the file, if its name does not say it")
      ->check(cli_support::one_of(names));
  command.add_option("--camera", flags.read.camera, "Name of the camera [the animated one]");
  command.add_option("--animation", flags.read.animation,
                     "Name of the animation of a glTF file [the first that moves the camera]");
  command.add_option("--times", flags.times, "File with a time in seconds in each line, for KITTI")
      ->type_name("FILE");
  command
      .add_option("--fps", flags.read.fps,
                  "Frames a second of a file that counts frames, or of a log's poses without times")
      ->check(cli_support::above_0());
  const auto set_axes = [&flags](const std::string& axes) {
    flags.read.axes = axes == "cv" ? CameraAxes::kCv : CameraAxes::kGl;
  };
  command
      .add_option_function<std::string>(
          "--camera-axes", set_axes,
          "gl: looks along -Z, +Y up; cv: along +Z, +Y down [by the format]")
      ->check(cli_support::one_of({"gl", "cv"}));
}

void add_log_flags(CLI::App& command, LogTrackOptions& log) {
  command.add_option("--channel", log.channel,
                     "Channel of a log that has the poses [the only one]");
  command
      .add_option(
          "--type", log.types,
          "File .lcm with the struct of a log's messages; may stand several times, for structs in "
          "it that are not in files beside it")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--position", log.position,
                  "Member of a log's message with the position, an array or a struct of three "
                  "numbers: pos, pose.pos, poses[0].pos; or x,y,z; each element of a list is a "
                  "pose")
      ->type_name("MEMBER");
  command
      .add_option("--orientation", log.orientation, "Member of a log's message with the quaternion")
      ->type_name("MEMBER");
  cli_support::add_choice(
      command, "--quaternion", log.order, base::named_values<QuaternionOrder>(),
      "Order of the numbers of a quaternion in a log, if their names do not say it [wxyz]");
  command
      .add_option("--time", log.time,
                  "Member of a log's message with the time [utime or timestamp if there is one for "
                  "each pose, else the time when the message was received; none for lists of "
                  "poses]")
      ->type_name("MEMBER");
  const auto set_unit = [&log](const std::string& name) {
    log.unit = base::value_of<TimeUnit>(name);
  };
  command
      .add_option_function<std::string>("--time-unit", set_unit,
                                        "Unit of --time [the one that fits the log's times]")
      ->check(cli_support::one_of({"s", "ms", "us", "ns"}));
}

void add_scene_flags_of_import(CLI::App& command, ImportFlags& flags) {
  command.add_option("--scene", flags.scene, "Scene file that the request names")
      ->type_name("FILE");
  command.add_option("--scale", flags.scale, "Metres per unit of this file and of the scene")
      ->check(cli_support::above_0())
      ->capture_default_str();
  command
      .add_option("--camera-scale", flags.camera_scale,
                  "Metres per unit of this file alone, where the scene has another unit [--scale]")
      ->check(cli_support::above_0());
  cli_support::add_choice(command, "--up", flags.up, base::named_values<scene::UpAxis>(),
                          "Turn the axes of this file and of the scene");
}

void add_lens_flags(CLI::App& command, ImportFlags& flags) {
  const CLI::Validator angle = cli_support::number_in(
      {"above 0 and below 180", [](double deg) { return deg > 0.0 && deg < 180.0; }});
  command.add_option("--fov-x-deg", flags.lens.fov_x_deg, "Full horizontal angle of view")
      ->check(angle);
  command.add_option("--fov-y-deg", flags.lens.fov_y_deg, "Full vertical angle of view")
      ->check(angle);
  command.add_option("--aspect", flags.lens.aspect, "Width of the picture divided by its height")
      ->check(cli_support::above_0());
  command.add_option("--near-m", flags.lens.near_m, "Near distance")->check(cli_support::above_0());
  command
      .add_option("--body", flags.body,
                  "Body of the request, as JSON; the poses are those of the body, and no field of "
                  "view is needed [the camera]")
      ->type_name("JSON");
}

void add_keyframe_flags(CLI::App& command, ImportFlags& flags) {
  CLI::Option* const all = command.add_flag("--all", flags.all, "Make every pose a keyframe");
  CLI::Option* const every =
      command.add_option("--every", flags.every, "Make every N-th pose a keyframe")
          ->check(cli_support::whole_number(1, 1'000'000))
          ->excludes(all);
  command
      .add_option("--within-m", flags.within_m,
                  "Largest distance of the path from a pose, metres [0.005]")
      ->check(cli_support::above_0())
      ->excludes(all)
      ->excludes(every);
  command
      .add_option("--within-deg", flags.within_deg,
                  "Largest turn of the path from a pose, degrees [0.2]")
      ->check(cli_support::above_0())
      ->excludes(all)
      ->excludes(every);
}

std::string formats_help() {
  std::string text = "Formats:\n";
  for (const CameraFormat& format : camera_formats()) {
    text += fmt::format("  {:<12}{}\n", format.name, format.description);
  }
  text += fmt::format("  {:<12}{}\n", kLogFormat.name, kLogFormat.description);
  return text;
}

}  // namespace

void add_import_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<ImportFlags>();
  CLI::App* command = app.add_subcommand(
      "import", "Make a request with few keyframes from a camera path of another program");
  add_file_flags(*command, *flags);
  add_log_flags(*command, flags->log);
  add_scene_flags_of_import(*command, *flags);
  add_lens_flags(*command, *flags);
  add_keyframe_flags(*command, *flags);
  command->add_option("--request", flags->request, "Request to write; - is standard output")
      ->required()
      ->type_name("FILE");
  command->footer(
      formats_help() + exit_code_help("") +
      "\nExample: camway import shot.glb --scene scenes/office.obj --request shot.json");
  command->callback([flags, &exit_code] { exit_code = run_import(*flags); });
}

}  // namespace camway::tools
