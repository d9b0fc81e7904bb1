// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
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
#include "daemon/planning/stages/path_check.h"
#include "tools/cameras/export/path_export.h"
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
  std::optional<std::string> name;
  std::optional<double> fps;
  int width_px = 1920;
  KeyChoice keys = KeyChoice::kDense;
  std::optional<double> within_m;
  std::optional<double> within_deg;
  bool no_proof = false;
};

/// The path that is exported, its request, and the file to write.
struct ExportInput {
  double fps = 0.0;
  PathFile response;
  RequestFile request;
  const CameraFormat* format = nullptr;
  CameraWriteOptions options;
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
  base::Result<PathExport> path = path_export(*request, documents, flags.fps);
  if (!path) return base::Failure{path.error};
  const CameraFormat* const format = camera_format(flags.format);
  if (flags.keys == KeyChoice::kSparse && !format->has_curves) {
    return base::Failure{"--keys sparse: " + flags.format +
                         " has no curves between keys; gltf has"};
  }
  CameraWriteOptions options = std::move(path->options);
  if (flags.name) options.name = *flags.name;
  options.width_px = flags.width_px;
  options.is_text = fs::path(flags.out).extension() == ".gltf";
  return ExportInput{path->fps, std::move(path->response), *std::move(request), format,
                     std::move(options)};
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
  return read_camera(*input.format, file, options);
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
  const base::Result<std::string> bytes = input.format->write(track, input.options);
  if (!bytes) return fail(flags.out + ": " + bytes.error);
  base::Result<CameraTrack> played = read_back(input, flags.out, *bytes, track);
  if (!played || played->keys.size() != track.keys.size()) {
    print_error(flags.out + ": cannot be read back: " + played.error);
    return ExitCode::kOurFault;
  }
  return WrittenTrack{*bytes, *std::move(played)};
}

ExitCode export_dense(const ExportFlags& flags, const ExportInput& input) {
  const auto result = written_track(
      flags, input, frames_of(input.response.path, input.fps, input.response.path.begin_s()));
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
  command->add_option("--width", flags->width_px, "Width of the picture, in pixels")
      ->check(cli_support::whole_number(1, 100'000))
      ->capture_default_str();
  add_key_flags(*command, *flags);
  command->add_flag("--no-proof", flags->no_proof, "Do not prove what is played");
  add_request_scene_flags(*command, flags->scene);
  command->footer(
      "The file has a pose for each frame; with --keys sparse, glTF has as few keys as stay within "
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
