// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/cli_support/flag_checks.h"
#include "daemon/planning/request/validate.h"
#include "daemon/planning/stages/path_check.h"
#include "daemon/scene/import/record/import_words.h"
#include "tools/cameras/export/path_export.h"
#include "tools/cameras/export/written_lens.h"
#include "tools/cameras/formats/camera_format.h"
#include "tools/cameras/path_samples.h"
#include "tools/cameras/sparse_keys.h"
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
  ExportChoices choices;
  KeyChoice keys = KeyChoice::kDense;
  std::optional<double> within_m;
  std::optional<double> within_deg;
  bool no_proof = false;
};

/// The path that is exported, and its request.
struct ExportInput : PathExport {
  RequestFile request;
};

base::Result<ExportInput> read_input(const ExportFlags& flags) {
  base::Result<RequestFile> request = read_request(flags.request);
  if (!request) return base::Failure{request.error};
  if (const auto fault = planning::validate(*request)) {
    return base::Failure{source_of(flags.request) + ": " + fault->message};
  }
  const base::Result<std::string> answer = read_text(flags.response);
  if (!answer) return base::Failure{answer.error};
  const base::Result<std::string> text = read_text(flags.request);
  const ExportDocuments documents{text ? *text : std::string(), source_of(flags.request), *answer,
                                  source_of(flags.response)};
  const CameraFormat& format = *camera_format(flags.format);
  if (flags.keys == KeyChoice::kSparse && !format.has_curves) {
    return base::Failure{"--keys sparse: " + flags.format +
                         " has no curves between keys; gltf has"};
  }
  if (flags.keys == KeyChoice::kDense && (flags.within_m || flags.within_deg)) {
    return base::Failure{
        fmt::format("--within-{}: counts only with --keys sparse", flags.within_m ? "m" : "deg")};
  }
  base::Result<PathExport> path = path_export(*request, documents, format, flags.choices);
  if (!path) return base::Failure{path.error};
  path->options.is_text = fs::path(flags.out).extension() == ".gltf";
  return ExportInput{*std::move(path), *std::move(request)};
}

/// The file that belongs beside the written one, with its place; nothing if the format has none.
std::optional<CompanionFile> companion_of(const ExportFlags& flags, const ExportInput& input) {
  if (input.format->companion == nullptr) return std::nullopt;
  CompanionFile companion = input.format->companion(input.options);
  companion.name = fs::path(flags.out).replace_filename(companion.name).string();
  return companion;
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
  if (traits.counts_frames) {
    words += fmt::format(", from frame {:g}", input.options.facts.first_frame.value_or(1.0));
  }
  if (traits.has_free_axes) {
    words += fmt::format(", camera axes {}", base::name_of(input.mapping.file_axes));
  }
  if (input.mapping.scale != 1.0) words += fmt::format(", {:g} m a unit", input.mapping.scale);
  if (input.mapping.up != scene::UpAxis::kAsInFile) {
    words += fmt::format(", up {} undone", base::name_of(input.mapping.up));
  }
  if (const auto companion = companion_of(flags, input)) {
    words += ", the lens in " + companion->name;
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
ExitCode prove(const ExportFlags& flags, const ExportInput& input, const ProofScene& scene,
               const CameraTrack& played) {
  const auto said = report_proof(flags, prove_played(played, scene),
                                 fmt::format("{} frames", played.keys.size()));
  if (said) return *said;
  const std::optional<double> rate = free_rate(input.response.path, input.fps, scene);
  print_error(rate ? fmt::format("--fps {:g} would be free", *rate)
                   : "no rate up to 32 times as high would be free");
  return ExitCode::kNegative;
}

/// A track as a file, and as a program plays that file.
struct WrittenTrack {
  std::string bytes;
  CameraTrack played;
};

/// Writes the files, and says what they do not show of the request's fields of view. Returns why
/// they are not written; empty if they are.
std::string write_files(const ExportFlags& flags, const ExportInput& input,
                        const WrittenTrack& written) {
  // The proof is about the request's fields of view, so no program may see more.
  const WrittenLens lens = written_lens(written.played, *input.format, input.options);
  if (!lens.fault.empty()) return flags.out + ": " + lens.fault;
  if (!lens.remark.empty()) print_error("note: " + lens.remark);
  std::string error = write_file(flags.out, written.bytes);
  if (!error.empty()) return error;
  const auto companion = companion_of(flags, input);
  return companion ? write_file(companion->name, companion->text) : "";
}

/// Writes a track and reads it back. Without one, the exit code says what went wrong, which was
/// printed.
std::variant<ExitCode, WrittenTrack> written_track(const ExportFlags& flags,
                                                   const ExportInput& input,
                                                   const CameraTrack& track) {
  const base::Result<std::string> bytes = written_file(input, track);
  if (!bytes) return fail(flags.out + ": " + bytes.error);
  base::Result<CameraTrack> played = read_back(input, flags.out, *bytes, track);
  if (!played || played->keys.size() != track.keys.size()) {
    print_error(flags.out + ": cannot be read back: " + played.error);
    return ExitCode::kOurFault;
  }
  return WrittenTrack{*bytes, *std::move(played)};
}

ExitCode export_dense(const ExportFlags& flags, const ExportInput& input) {
  const auto result = written_track(flags, input, dense_track(input));
  if (const auto* const code = std::get_if<ExitCode>(&result)) return *code;
  const auto& written = std::get<WrittenTrack>(result);
  std::optional<ProofScene> scene;
  if (!flags.no_proof) {
    // Before the file: one that is there looks proved.
    base::Result<ProofScene> loaded = load_scene(flags, input);
    if (!loaded) return fail(loaded.error);
    scene = *std::move(loaded);
  }
  const std::string error = write_files(flags, input, written);
  if (!error.empty()) return fail(error);
  return scene ? prove(flags, input, *scene, written.played) : ExitCode::kSuccess;
}

SparseKeys few_keys(const ExportFlags& flags, const ExportInput& input) {
  SparseKeys keys(input.response.path, input.fps);
  ThinningTolerance tolerance;
  if (flags.within_m) tolerance.position_m = *flags.within_m;
  if (flags.within_deg) tolerance.turn_rad = radians(*flags.within_deg);
  // A rate that someone said is lost where keys are between frames.
  if (!input.is_fps_known || !keys.keep_frames_within(tolerance)) keys.keep_within(tolerance);
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
  if (input.is_fps_known && !keys.are_on_frames()) {
    print_error(
        fmt::format("note: not all keys are on frames, so the file has no rate of {:g} a "
                    "second: those do not suffice",
                    input.fps));
  }
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
    const std::string error = write_files(flags, input, written);
    if (!error.empty()) return fail(error);
    print_sparse(flags, input, keys, written.played, offset_s);
    if (!proof) return ExitCode::kSuccess;
    return report_proof(flags, *proof, fmt::format("{} keys", track.keys.size()))
        .value_or(ExitCode::kNegative);
  }
}

/// Returns why a file cannot be written beside that of the path; empty if it can. Nobody named it,
/// so it replaces nothing: a model of the user, or the lens of another path in the folder.
std::string why_no_companion(const ExportFlags& flags, const CompanionFile& companion,
                             const std::vector<std::string>& inputs) {
  std::error_code ignored;
  const std::string name = fs::path(companion.name).filename().string();
  if (fs::path(flags.out).filename() == name ||
      fs::equivalent(flags.out, companion.name, ignored)) {
    return fmt::format("--out: {} is where {} has the lens; the poses need another name", flags.out,
                       flags.format);
  }
  if (!fs::exists(fs::symlink_status(companion.name, ignored))) {
    return why_unwritable(companion.name, inputs);
  }
  const base::Result<std::string> text = read_text(companion.name);
  if (text && *text == companion.text) return "";
  return fmt::format(
      "{}: is there already, and is not the lens of this path; {} needs this name "
      "beside {}, so write to another folder, or remove it",
      companion.name, flags.format, flags.out);
}

/// Returns why the files of the path cannot be written; empty if they can.
std::string why_no_files(const ExportFlags& flags, const ExportInput& input) {
  const std::vector<std::string> inputs = {flags.response, flags.request,
                                           flags.scene.file_for(flags.request, input.request)};
  std::string fault = why_unwritable(flags.out, inputs);
  const auto companion = companion_of(flags, input);
  return fault.empty() && companion ? why_no_companion(flags, *companion, inputs) : fault;
}

ExitCode run_export(const ExportFlags& flags) {
  const base::Result<ExportInput> input = read_input(flags);
  if (!input) return fail(input.error);
  if (const std::string fault = why_no_files(flags, *input); !fault.empty()) return fail(fault);
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
      .add_option("--width", flags.choices.width_px,
                  "Width of the picture, in pixels [of the imported file, else 1920]")
      ->check(cli_support::whole_number(1, 100'000));
  command
      .add_option("--height", flags.choices.height_px,
                  "Its height [of the imported file, else such that pixels are square]; its pixels "
                  "have the shape that the fields of view need")
      ->check(cli_support::whole_number(1, 100'000));
  command
      .add_option("--first-frame", flags.choices.first_frame,
                  "Number of the first frame, of chan and blender [of the imported file, else 1]")
      ->check(cli_support::whole_number(-1'000'000'000, 1'000'000'000));
  const auto set_axes = [&flags](const std::string& axes) {
    flags.choices.axes = axes == "cv" ? CameraAxes::kCv : CameraAxes::kGl;
  };
  command
      .add_option_function<std::string>("--camera-axes", set_axes,
                                        "gl: looks along -Z, +Y up; cv: along +Z, +Y down [of the "
                                        "imported file, else by the format]")
      ->check(cli_support::one_of({"gl", "cv"}));
  command
      .add_option("--file-scale", flags.choices.scale,
                  "Metres per unit of the written file [of the imported file, else 1]")
      ->check(cli_support::above_0());
  command
      .add_option_function<std::string>(
          "--file-up",
          [&flags](const std::string& up) {
            for (const auto& [name, value] : base::named_values<scene::UpAxis>()) {
              if (name == up) flags.choices.up = value;
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
  command
      ->add_option("--fps", flags->choices.fps,
                   "Frames a second [those of the imported file, else 24]")
      ->check(cli_support::above_0());
  command->add_option("--name", flags->choices.name,
                      "Name of the camera [that of the imported file]");
  add_mapping_flags(*command, *flags);
  add_key_flags(*command, *flags);
  command->add_flag("--no-proof", flags->no_proof, "Do not prove what is played");
  add_request_scene_flags(*command, flags->scene);
  command->footer(
      "The file is in the world of the file that the request was imported from: its rate, unit, "
      "axes, first frame,\nand pictures, unless flags say otherwise. It has a pose for each frame "
      "up to the last that is not after the end; with --keys sparse, glTF has as few keys as stay "
      "within --within-m and\n--within-deg of the path, with its derivatives as tangents, and more "
      "where the path would not be free.\nThe file is read back, and the path that a program plays "
      "of it,\non straight lines and by slerp between frames, on splines between sparse keys, is "
      "proved again. Where that is not free, the\nfile is written all the same, and the exit code "
      "is 3.\n" +
      exit_code_help("what is played between the frames is not free") +
      "\nExample: camway export out.json --request scenes/requests/office-graze-door.json --format "
      "gltf --out shot.glb");
  command->callback([flags, &exit_code] { exit_code = run_export(*flags); });
}

}  // namespace camway::tools
