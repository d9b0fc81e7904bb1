// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/cli_support/flag_checks.h"
#include "daemon/planning/result/path_faults.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/cameras/frame_rate.h"
#include "tools/cameras/path_samples.h"
#include "tools/cameras/sparse_keys.h"
#include "tools/camway/cameras/camera_remark.h"
#include "tools/camway/cameras/import_request.h"
#include "tools/camway/cameras/played_proof.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_response.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

/// Ten hours at 24 frames a second.
constexpr double kMostFrames = 1e6;

/// Which poses become keys of the written animation.
enum class KeyChoice { kDense, kSparse };
constexpr std::array<std::string_view, 2> names_of(KeyChoice) { return {"dense", "sparse"}; }

/// Rounds in which keys are added where what is played is not free. Each halves intervals.
constexpr int kMostRounds = 12;

struct ExportFlags {
  SceneFlags scene;
  std::string response;
  std::string request;
  std::string format;
  std::string out;
  std::optional<std::string> name;
  std::optional<double> fps;
  std::optional<CameraAxes> axes;
  std::optional<double> file_scale;
  std::optional<scene::UpAxis> file_up;
  std::optional<double> first_frame;
  std::optional<int> width_px;
  std::optional<int> height_px;
  KeyChoice keys = KeyChoice::kDense;
  std::optional<double> within_m;
  std::optional<double> within_deg;
  bool no_proof = false;
};

constexpr double kUsualRate = 24.0;
constexpr int kUsualWidth_px = 1920;

/// The path that is exported, its request, and the file to write.
struct ExportInput {
  double fps = kUsualRate;
  bool is_fps_known = false;
  /// Whether the poses are those of the keyframes, as neither the imported file nor the format has
  /// times.
  bool has_keyframes_only = false;
  FileMapping mapping;
  PathFile response;
  RequestFile request;
  const CameraFormat* format = nullptr;
  CameraWriteOptions options;
};

/// The path at its keyframes. Leaves out those whose time is unknown.
std::vector<TrackKey> keyframes_of(const PathFile& response) {
  std::vector<TrackKey> keys;
  for (const motion::Keyframe& keyframe : response.keyframes) {
    if (!std::isfinite(keyframe.time_s)) continue;
    keys.push_back({keyframe.time_s, response.path.pose(keyframe.time_s), std::nullopt});
  }
  return keys;
}

/// The stretches that corrections changed; none where the file is no whole response.
std::vector<CorrectedStretch> corrections_of(const std::string& text) {
  const base::Result<planning::PlanResult> response =
      parse_as<planning::PlanResult>(text, "response");
  std::vector<CorrectedStretch> stretches;
  if (!response) return stretches;
  for (const correction::Correction& each : response->corrections) {
    if (each.kind == correction::CorrectionKind::kNone) continue;
    const CorrectedStretch stretch{each.t_begin_s, each.t_end_s, each.moved_m};
    // One correction may be that of several collisions.
    const bool is_same = !stretches.empty() && stretches.back().t_begin_s == stretch.t_begin_s &&
                         stretches.back().t_end_s == stretch.t_end_s;
    if (!is_same) stretches.push_back(stretch);
  }
  return stretches;
}

/// How the file's poses differ from those of the request: as in the imported file, unless flags say
/// otherwise, or the format says what they are.
FileMapping mapping_of(const ExportFlags& flags, const CameraFormat& format,
                       const CameraRemark& remark) {
  const FormatTraits traits = traits_of(format);
  const bool is_same = remark.format == format.name;
  FileMapping mapping{traits.axes, traits.axes};
  if (is_same && remark.facts.is_euroc) mapping.file_axes = CameraAxes::kCv;
  if (is_same && remark.axes && traits.has_free_axes) mapping.file_axes = *remark.axes;
  if (flags.axes) mapping.file_axes = *flags.axes;
  if (is_same || traits.has_free_world) {
    mapping.scale = remark.scale;
    mapping.up = remark.up;
  }
  if (flags.file_scale) mapping.scale = *flags.file_scale;
  if (flags.file_up) mapping.up = *flags.file_up;
  return mapping;
}

/// The facts that the file shall have. Names of pictures and units of tables go with their format.
FileFacts facts_of(const ExportFlags& flags, const CameraFormat& format,
                   const CameraRemark& remark) {
  FileFacts facts = remark.facts;
  if (remark.format != format.name) {
    facts.images.clear();
    facts.is_euroc = false;
    facts.time_units = facts.length_units = 1.0;
  }
  if (flags.first_frame) facts.first_frame = flags.first_frame;
  if (flags.width_px || facts.width_px == 0) {
    facts.width_px = flags.width_px.value_or(kUsualWidth_px);
    facts.height_px = 0;
  }
  if (flags.height_px) facts.height_px = *flags.height_px;
  return facts;
}

CameraWriteOptions options_of(const ExportFlags& flags, const ExportInput& input,
                              const CameraRemark& remark) {
  CameraWriteOptions options;
  options.name = flags.name.value_or(remark.name.empty() ? "camera" : remark.name);
  const motion::Camera& camera = input.request.camera;
  options.fov_x_rad = camera.fov_x_rad;
  options.fov_y_rad = camera.fov_y_rad;
  options.near_m = camera.near_m * input.response.near_scale / input.mapping.scale;
  options.facts = facts_of(flags, *input.format, remark);
  options.width_px = options.facts.width_px;
  options.is_text = fs::path(flags.out).extension() == ".gltf";
  CameraTrack keyframes;
  keyframes.keys = keyframes_of(input.response);
  options.keyframes = as_in_file(keyframes, input.mapping).keys;
  return options;
}

/// Returns why the flags do not go with the format; empty if they do.
std::string format_fault(const ExportFlags& flags, const CameraFormat& format,
                         const RequestFile& request) {
  const FormatTraits traits = traits_of(format);
  if (traits.needs_lens && !(request.camera.fov_x_rad > 0.0)) {
    return source_of(flags.request) + ": camera: is missing, whose field of view " + flags.format +
           " needs; tum, kitti, csv, chan and mcap do not";
  }
  if (flags.axes && !traits.has_free_axes) {
    return "--camera-axes: " + flags.format + " has axes of its own";
  }
  if (flags.keys == KeyChoice::kSparse && !format.has_curves) {
    return "--keys sparse: " + flags.format + " has no curves between keys; gltf has";
  }
  return "";
}

base::Result<PathFile> read_path_file(const ExportFlags& flags, const std::string& answer) {
  base::Result<PathFile> response = parse_as<PathFile>(answer, source_of(flags.response));
  if (!response) return response;
  if (response->path.empty()) {
    return base::Failure{source_of(flags.response) + ": has no path"};
  }
  if (const auto fault = planning::find_fault(response->path.segments())) {
    return base::Failure{source_of(flags.response) + ": " + *fault};
  }
  return response;
}

/// Returns why the path has no such frames; empty if it has.
std::string frames_fault(const ExportFlags& flags, const ExportInput& input) {
  if (input.has_keyframes_only) return "";
  const double frames = frame_count(input.response.path, input.fps);
  const std::string source = source_of(flags.response);
  if (frames > kMostFrames) return fmt::format("{}: has more than {} frames", source, kMostFrames);
  if (frames < 2.0) {
    return fmt::format("{}: is shorter than a frame of {:g} a second: --fps must be higher", source,
                       input.fps);
  }
  return "";
}

base::Result<ExportInput> read_input(const ExportFlags& flags) {
  base::Result<RequestFile> request = read_request(flags.request);
  if (!request) return base::Failure{request.error};
  if (const auto fault = planning::validate(*request)) {
    return base::Failure{source_of(flags.request) + ": " + fault->message};
  }
  const base::Result<std::string> answer = read_text(flags.response);
  if (!answer) return base::Failure{answer.error};
  base::Result<PathFile> response = read_path_file(flags, *answer);
  if (!response) return base::Failure{response.error};
  const base::Result<std::string> text = read_text(flags.request);
  const CameraRemark remark = text ? camera_remark(*text) : CameraRemark{};
  ExportInput input;
  input.format = camera_format(flags.format);
  if (std::string fault = format_fault(flags, *input.format, *request); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  input.request = *std::move(request);
  input.response = *std::move(response);
  input.fps = flags.fps ? *flags.fps : remark.fps.value_or(kUsualRate);
  input.is_fps_known = flags.fps || remark.fps;
  if (!input.is_fps_known && !remark.has_times && !traits_of(*input.format).has_times) {
    input.has_keyframes_only = keyframes_of(input.response).size() > 1;
  }
  input.mapping = mapping_of(flags, *input.format, remark);
  input.options = options_of(flags, input, remark);
  input.options.corrections = corrections_of(*answer);
  if (std::string fault = frames_fault(flags, input); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  return input;
}

/// Says what the file has that the path has not.
void print_mapping(const ExportFlags& flags, const ExportInput& input) {
  const FormatTraits traits = traits_of(*input.format);
  std::string words =
      !input.has_keyframes_only
          ? fmt::format("{:.6g} frames a second{}", input.fps,
                        input.is_fps_known ? "" : ", as none are known (--fps)")
          : fmt::format("{} poses without times, those of the keyframes (--fps: frames)",
                        keyframes_of(input.response).size());
  if (flags.format == "chan" || flags.format == "blender") {
    words += fmt::format(", from frame {:g}", input.options.facts.first_frame.value_or(1.0));
  }
  if (traits.has_free_axes) {
    words += fmt::format(", camera axes {}", base::name_of(input.mapping.file_axes));
  }
  if (input.mapping.scale != 1.0) words += fmt::format(", {:g} m a unit", input.mapping.scale);
  if (input.mapping.up != scene::UpAxis::kAsInFile) {
    words += fmt::format(", up {} undone", base::name_of(input.mapping.up));
  }
  print_error(flags.out + ": " + words);
}

/// Reads what was written back, as its consumer would.
base::Result<CameraTrack> read_back(const ExportInput& input, const std::string& name,
                                    const std::string& bytes, const CameraTrack& written) {
  CameraFile file{name, bytes, {}};
  file.open_beside = [&](const std::string& other) -> base::Result<std::string> {
    if (input.format->companion == nullptr) return base::Failure{"is not there"};
    const CompanionFile companion = input.format->companion(input.options);
    if (companion.name != other) return base::Failure{"is not there"};
    return companion.text;
  };
  CameraReadOptions options;
  options.fps = written.fps;
  options.axes = input.mapping.file_axes;
  base::Result<CameraTrack> played = read_camera(*input.format, file, options);
  if (!played) return played;
  place_as_scene(*played, input.mapping.scale, input.mapping.up);
  if (!played->has_times && played->keys.size() == written.keys.size()) {
    for (std::size_t i = 0; i < written.keys.size(); ++i) {
      played->keys[i].time_s = written.keys[i].time_s;
    }
  }
  return played;
}

ExitCode fail(const std::string& error) {
  print_error(error);
  return ExitCode::kInvalidInput;
}

base::Result<ProofScene> load_scene(const ExportFlags& flags, const ExportInput& input) {
  auto body = motion::Body::make(planning::body_shape(input.request, input.response.near_scale));
  if (!body) return base::Failure{source_of(flags.request) + ": body: " + body.error};
  const std::string file = flags.scene.file_for(flags.request, input.request);
  if (file.empty()) {
    return base::Failure{
        source_of(flags.request) +
        ": scene: is missing, and there is no --scene; --no-proof exports without"};
  }
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options(input.request.reading);
  const scene::SnapshotResult loaded =
      load_timed(file, file, options, user_cache(flags.scene)).result;
  if (!loaded.snapshot) return base::Failure{loaded.error};
  if (!input.response.scene_digest.empty() &&
      input.response.scene_digest != loaded.snapshot->digest) {
    print_error("warning: " + source_of(flags.response) + " was made for another scene");
  }
  const geometry::Bounds bounds = input.request.options.bounds.within(input.response.bounds);
  return ProofScene{input.request, *std::move(body), loaded.snapshot, bounds};
}

/// Says what the proof came to. Returns whether there is nothing more to say.
std::optional<ExitCode> report_proof(const ExportFlags& flags, const PlayedProof& proof,
                                     const std::string& keys) {
  if (proof.search.certificate.certified) {
    print_error(fmt::format("{}: proved free as played between its {}; clearance {:.3g} m",
                            flags.out, keys, proof.search.certificate.clearance_lower_bound_m));
    return ExitCode::kSuccess;
  }
  if (!proof.search.complete) {
    print_error(
        fmt::format("{}: the deadline came before all that is played was proved", flags.out));
    return ExitCode::kNegative;
  }
  for (const collision::CollisionInterval& each : proof.search.collisions) {
    print_error(
        fmt::format("{}: as played between its {}, it is too near to the scene from "
                    "{:.6g} s to {:.6g} s",
                    flags.out, keys, each.t_begin_s, each.t_end_s));
  }
  return std::nullopt;
}

/// Says whether what is played is free, and otherwise where it is not and at which rate it would
/// be.
ExitCode prove(const ExportFlags& flags, const ExportInput& input, const CameraTrack& played) {
  const base::Result<ProofScene> scene = load_scene(flags, input);
  if (!scene) return fail(scene.error);
  const auto said = report_proof(flags, prove_played(played, *scene),
                                 fmt::format("{} frames", played.keys.size()));
  if (said) return *said;
  const std::optional<double> rate = free_rate(input.response.path, input.fps, *scene);
  print_error(rate ? fmt::format("--fps {:g} would be free", *rate)
                   : "no rate up to 32 times as high would be free");
  return ExitCode::kNegative;
}

std::string write_files(const ExportFlags& flags, const ExportInput& input,
                        const std::string& bytes) {
  std::string error = write_file(flags.out, bytes);
  if (!error.empty() || input.format->companion == nullptr) return error;
  const CompanionFile companion = input.format->companion(input.options);
  return write_file(fs::path(flags.out).replace_filename(companion.name), companion.text);
}

/// A track as a file, and as a program plays that file.
struct WrittenTrack {
  std::string bytes;
  CameraTrack played;
};

/// Writes a track and reads it back. Without one, the exit code says what went wrong, which was
/// printed.
std::variant<ExitCode, WrittenTrack> written_track(const ExportFlags& flags,
                                                   const ExportInput& input,
                                                   const CameraTrack& track) {
  const base::Result<std::string> bytes =
      input.format->write(as_in_file(track, input.mapping), input.options);
  if (!bytes) return fail(flags.out + ": " + bytes.error);
  base::Result<CameraTrack> played = read_back(input, flags.out, *bytes, track);
  if (!played || played->keys.size() != track.keys.size()) {
    print_error(flags.out + ": cannot be read back: " + played.error);
    return ExitCode::kOurFault;
  }
  return WrittenTrack{*bytes, *std::move(played)};
}

/// The poses at the frames. A frame that is a keyframe but for the rounding of a file's times has
/// the keyframe's time, so that the pose is that of the keyframe however fast the camera is.
CameraTrack dense_track(const ExportInput& input) {
  std::vector<double> times_s;
  for (const TrackKey& key : keyframes_of(input.response)) times_s.push_back(key.time_s);
  const motion::Path& path = input.response.path;
  if (input.has_keyframes_only) return poses_at(path, times_s);
  CameraTrack track = frames_of(path, input.fps, path.begin_s());
  std::vector<double> frames_s;
  for (const TrackKey& key : track.keys) {
    const auto after = std::ranges::lower_bound(times_s, key.time_s - kOnFrame / input.fps);
    const bool is_keyframe = after != times_s.end() && *after <= key.time_s + kOnFrame / input.fps;
    frames_s.push_back(std::min(is_keyframe ? *after : key.time_s, path.end_s()));
  }
  track = poses_at(path, frames_s);
  track.fps = input.fps;
  return track;
}

ExitCode export_dense(const ExportFlags& flags, const ExportInput& input) {
  const auto result = written_track(flags, input, dense_track(input));
  if (const auto* const code = std::get_if<ExitCode>(&result)) return *code;
  const auto& written = std::get<WrittenTrack>(result);
  const std::string error = write_files(flags, input, written.bytes);
  if (!error.empty()) return fail(error);
  if (flags.no_proof) return ExitCode::kSuccess;
  return prove(flags, input, written.played);
}

SparseKeys few_keys(const ExportFlags& flags, const ExportInput& input) {
  SparseKeys keys(input.response.path, input.fps);
  ThinningTolerance tolerance;
  if (flags.within_m) tolerance.position_m = *flags.within_m;
  if (flags.within_deg) tolerance.turn_rad = radians(*flags.within_deg);
  keys.keep_within(tolerance);
  return keys;
}

/// Adds keys where what is played collides. Returns whether there was a time to add.
bool add_keys(SparseKeys& keys, const PlayedProof& proof, double offset_s) {
  bool has_added = false;
  for (const collision::CollisionInterval& each : proof.search.collisions) {
    has_added = keys.add_near(each.t_begin_s + offset_s, each.t_end_s + offset_s) || has_added;
  }
  return has_added;
}

void print_sparse(const ExportFlags& flags, const ExportInput& input, const SparseKeys& keys,
                  const CameraTrack& played, double offset_s) {
  const SparseKeys::Difference off = keys.difference(played, offset_s);
  print_error(
      fmt::format("{}: {} keys for {:.0f} frames; within {:.2g} m and {:.2g} degrees of "
                  "the path",
                  flags.out, played.keys.size(), frame_count(input.response.path, input.fps),
                  off.position_m, degrees(off.turn_rad)));
}

/// Writes few keys on curves, and adds some where what is played of them is not free.
ExitCode export_sparse(const ExportFlags& flags, const ExportInput& input) {
  std::optional<ProofScene> scene;
  if (!flags.no_proof) {
    base::Result<ProofScene> loaded = load_scene(flags, input);
    if (!loaded) return fail(loaded.error);
    scene = *std::move(loaded);
  }
  SparseKeys keys = few_keys(flags, input);
  for (int round = 0;; ++round) {
    const CameraTrack track = keys.track();
    const auto result = written_track(flags, input, track);
    if (const auto* const code = std::get_if<ExitCode>(&result)) return *code;
    const auto& written = std::get<WrittenTrack>(result);
    // A file may count its times from 0.
    const double offset_s = track.keys.front().time_s - written.played.keys.front().time_s;
    std::optional<PlayedProof> proof;
    if (scene) proof = prove_played(written.played, *scene);
    const bool is_settled =
        !proof || proof->search.certificate.certified || !proof->search.complete;
    if (!is_settled && round < kMostRounds && add_keys(keys, *proof, offset_s)) continue;
    const std::string error = write_files(flags, input, written.bytes);
    if (!error.empty()) return fail(error);
    print_sparse(flags, input, keys, written.played, offset_s);
    if (!proof) return ExitCode::kSuccess;
    return report_proof(flags, *proof, fmt::format("{} keys", track.keys.size()))
        .value_or(ExitCode::kNegative);
  }
}

ExitCode run_export(const ExportFlags& flags) {
  const base::Result<ExportInput> input = read_input(flags);
  if (!input) return fail(input.error);
  print_mapping(flags, *input);
  return flags.keys == KeyChoice::kSparse ? export_sparse(flags, *input)
                                          : export_dense(flags, *input);
}

void add_key_flags(CLI::App& command, ExportFlags& flags) {
  cli_support::add_choice(command, "--keys", flags.keys, base::named_values<KeyChoice>(),
                          "dense: a key for each frame; sparse: few keys, on cubic splines");
  command
      .add_option("--within-m", flags.within_m,
                  "With sparse keys, farthest that they may be played from the path [0.005]")
      ->check(cli_support::above_0());
  command.add_option("--within-deg", flags.within_deg, "Farthest that it may be turned [0.2]")
      ->check(cli_support::above_0());
}

void add_mapping_flags(CLI::App& command, ExportFlags& flags) {
  command
      .add_option("--width", flags.width_px,
                  "Width of the picture, in pixels [of the imported file, else 1920]")
      ->check(cli_support::whole_number(1, 100'000));
  command
      .add_option("--height", flags.height_px,
                  "Its height [of the imported file, else such that pixels are square]")
      ->check(cli_support::whole_number(1, 100'000));
  command
      .add_option("--first-frame", flags.first_frame,
                  "Number of the first frame, of chan and blender [of the imported file, else 1]")
      ->check(cli_support::whole_number(-1'000'000'000, 1'000'000'000));
  const auto set_axes = [&flags](const std::string& axes) {
    flags.axes = axes == "cv" ? CameraAxes::kCv : CameraAxes::kGl;
  };
  command
      .add_option_function<std::string>("--camera-axes", set_axes,
                                        "gl: looks along -Z, +Y up; cv: along +Z, +Y down [of the "
                                        "imported file, else by the format]")
      ->check(cli_support::one_of({"gl", "cv"}));
  command
      .add_option("--file-scale", flags.file_scale,
                  "Metres per unit of the written file [of the imported file, else 1]")
      ->check(cli_support::above_0());
  command
      .add_option_function<std::string>(
          "--file-up",
          [&flags](const std::string& up) {
            for (const auto& [name, value] : base::named_values<scene::UpAxis>()) {
              if (name == up) flags.file_up = value;
            }
          },
          "The turn of axes from the written file to the scene, which is undone [of the imported "
          "file, else none]")
      ->check(cli_support::one_of({"as-in-file", "z-to-y", "y-to-z"}));
}

}  // namespace

void add_export_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<ExportFlags>();
  CLI::App* command = app.add_subcommand(
      "export", "Write a path as a camera file of another program, and prove what it will play");
  command->add_option("response", flags->response, "Response file, or any with \"segments\"")
      ->required();
  command->add_option("--request", flags->request, "Its request: scene, camera and options")
      ->required()
      ->type_name("FILE");
  std::vector<std::string> names;
  for (const CameraFormat& format : camera_formats()) {
    if (format.write != nullptr) names.emplace_back(format.name);
  }
  command->add_option("--format", flags->format, "What to write")
      ->required()
      ->check(cli_support::one_of(names));
  command->add_option("--out", flags->out, "File to write")->required()->type_name("FILE");
  command->add_option("--fps", flags->fps, "Frames a second [those of the imported file, else 24]")
      ->check(cli_support::above_0());
  command->add_option("--name", flags->name, "Name of the camera [that of the imported file]");
  add_mapping_flags(*command, *flags);
  add_key_flags(*command, *flags);
  command->add_flag("--no-proof", flags->no_proof, "Do not prove what is played");
  add_request_scene_flags(*command, flags->scene);
  command->footer(
      "The file is in the world of the file that the request was imported from: its rate, unit, "
      "axes, "
      "first frame,\nand pictures, unless flags say otherwise. It has a pose for each frame up to "
      "the "
      "last that is not after the end; with --keys sparse, glTF has as few keys as stay within "
      "--within-m and\n--within-deg of the path, with its derivatives as tangents, and more where "
      "the "
      "path would not be free.\nThe file is read back, and the path that a program plays of "
      "it,\non straight lines and by slerp between frames, on splines between sparse keys, is "
      "proved "
      "again. Where that is not "
      "free, the\nfile is written all the same, and the exit code is 3.\n" +
      exit_code_help("what is played between the frames is not free") +
      "\nExample: camway export out.json --request scenes/requests/office-graze-door.json --format "
      "gltf --out shot.glb");
  command->callback([flags, &exit_code] { exit_code = run_export(*flags); });
}

}  // namespace camway::tools
