// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/planning/result/path_faults.h"
#include "tools/cameras/files/text_rows.h"
#include "tools/cameras/path_samples.h"
#include "tools/camway/common/commands.h"
#include "tools/json/json_response.h"

namespace camway::tools {
namespace {

struct SampleFlags {
  std::string response;
  double fps = 24.0;
  bool json = false;
};

/// Much more than anyone reads; a program that wants more evaluates the segments.
constexpr double kMostSamples = 1e7;

base::Result<motion::Path> read_path(const SampleFlags& flags) {
  const base::Result<PathFile> response = read_as<PathFile>(flags.response);
  if (!response) return base::Failure{response.error};
  const std::string source = source_of(flags.response);
  if (response->path.empty()) return base::Failure{source + ": has no path"};
  if (const auto fault = planning::find_fault(response->path.segments())) {
    return base::Failure{source + ": " + *fault};
  }
  if (frame_count(response->path, flags.fps) > kMostSamples) {
    return base::Failure{fmt::format("{}: has more than {} frames", source, kMostSamples)};
  }
  return response->path;
}

void print_json(const TrackKey& key, bool is_last) {
  const geometry::Vec3& p = key.pose_W.position;
  const geometry::Quat& q = key.pose_W.orientation;
  fmt::print("  {{\"time\": {}, \"position\": [{}], \"orientation\": [{}]}}{}\n", key.time_s,
             number_row(std::array{p.x(), p.y(), p.z()}, ", "),
             number_row(std::array{q.w(), q.x(), q.y(), q.z()}, ", "), is_last ? "" : ",");
}

void print_table(const TrackKey& key) {
  const geometry::Vec3& p = key.pose_W.position;
  const geometry::Quat& q = key.pose_W.orientation;
  fmt::print(
      "{}\n",
      number_row(std::array{key.time_s, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}, ","));
}

ExitCode run_sample(const SampleFlags& flags) {
  const base::Result<motion::Path> path = read_path(flags);
  if (!path) {
    print_error(path.error);
    return ExitCode::kInvalidInput;
  }
  const CameraTrack frames = frames_of(*path, flags.fps, path->begin_s());
  fmt::print("{}\n", flags.json ? "[" : "time_s,x_m,y_m,z_m,qw,qx,qy,qz");
  for (const TrackKey& key : frames.keys) {
    if (flags.json) {
      print_json(key, &key == &frames.keys.back());
    } else {
      print_table(key);
    }
  }
  if (flags.json) fmt::print("]\n");
  return ExitCode::kSuccess;
}

}  // namespace

void add_sample_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<SampleFlags>();
  CLI::App* command =
      app.add_subcommand("sample", "Print the poses of a path at its frames, as a table or JSON");
  command->add_option("response", flags->response, "Response file, or any with \"segments\"")
      ->required();
  command->add_option("--fps", flags->fps, "Frames a second")
      ->check(cli_support::above_0())
      ->capture_default_str();
  command->add_flag("--json", flags->json, "Print JSON");
  command->footer(
      "Times are those of the path. The last pose is that of the last frame that is not after its "
      "end.\n" +
      exit_code_help("") + "\nExample: camway sample out.json --fps 2");
  command->callback([flags, &exit_code] { exit_code = run_sample(*flags); });
}

}  // namespace camway::tools
