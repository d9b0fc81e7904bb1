// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/motion/spline/interpolate.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/review_file.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/side_by_side.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

constexpr std::size_t kDrawnSamples = 1500;

struct DrawFlags {
  SceneFlags scene;
  std::string request;
  std::string response;
  std::string picture;
  draw::SceneUp vertical = draw::SceneUp::kY;
  bool is_side_by_side = false;
};

std::vector<motion::Keyframe> given_keyframes(const planning::PlanResult& result) {
  std::vector<motion::Keyframe> given = result.keyframes;
  std::erase_if(given, [](const motion::Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted;
  });
  return given;
}

draw::FloorPlan floor_plan(const DrawFlags& flags, const planning::PlanRequest& request,
                           const planning::PlanResult& result, const scene::Mesh& mesh) {
  draw::FloorPlan plan;
  plan.title = std::filesystem::path(flags.response).stem().string();
  plan.subtitle = fmt::format("{}: {}", planning::to_string(result.status), result.message);
  plan.mesh = mesh;
  plan.up = flags.vertical;
  plan.corners_C = motion::near_corners_C(request.camera);
  plan.keyframes = result.keyframes;
  plan.before = draw::sample(motion::interpolate(given_keyframes(result)), kDrawnSamples);
  plan.after = draw::sample(result.path, kDrawnSamples);
  plan.collisions = result.collisions;
  plan.remaining_collisions = result.remaining_collisions;
  return plan;
}

ExitCode invalid(const std::string& error) {
  print_error(error);
  return ExitCode::kInvalidInput;
}

/// Warns if the path was made for another scene than the one that is drawn.
void warn_of_another_scene(const DrawFlags& flags, const scene::Snapshot& snapshot) {
  const base::Result<PathFile> response = read_as<PathFile>(flags.response);
  if (!response || response->scene_digest.empty()) return;
  if (response->scene_digest == snapshot.digest) return;
  print_error(fmt::format(
      "warning: {}: was made for another scene: its scene_digest is {}, that of {} is {}",
      source_of(flags.response), response->scene_digest, snapshot.name, snapshot.digest));
}

ExitCode run_draw(const DrawFlags& flags) {
  if (const std::string fault = why_unwritable(flags.picture); !fault.empty()) {
    return invalid(fault);
  }
  const base::Result<RequestFile> request = read_request(flags.request);
  if (!request) return invalid(request.error);
  const base::Result<planning::PlanResult> result = read_as<planning::PlanResult>(flags.response);
  if (!result) return invalid(result.error);
  if (result->path.empty())
    return invalid(source_of(flags.response) + ": segments: has no path to draw");
  const std::string scene_file = flags.scene.file_for(flags.request, *request);
  if (scene_file.empty()) {
    return invalid(source_of(flags.request) + ": scene: is missing, and there is no --scene");
  }
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options(request->reading);
  const scene::SnapshotResult loaded =
      load_timed(scene_file, scene_file, options, user_cache(flags.scene)).result;
  if (!loaded.snapshot) return invalid(loaded.error);
  warn_of_another_scene(flags, *loaded.snapshot);
  if (std::filesystem::path(flags.picture).extension() == ".html") {
    const std::string error =
        write_review(*loaded.snapshot, flags.request, flags.response, flags.picture);
    return error.empty() ? ExitCode::kSuccess : invalid(error);
  }
  const std::filesystem::path picture(flags.picture);
  draw::PictureFiles files;
  (picture.extension() == ".svg" ? files.svg : files.png) = picture;
  const std::shared_ptr<const scene::Mesh> mesh = loaded.snapshot->mesh.share();
  const draw::FloorPlan plan = floor_plan(flags, *request, *result, *mesh);
  const std::string error = flags.is_side_by_side ? draw::draw_side_by_side(plan, files)
                                                  : draw::draw_floor_plan(plan, files);
  return error.empty() ? ExitCode::kSuccess : invalid(error);
}

}  // namespace

void add_draw_command(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand(
      "draw", "Draw a response as a floor plan: scene, path before and after, collisions");
  const auto flags = std::make_shared<DrawFlags>();
  add_request_scene_flags(*command, flags->scene);
  command->add_option("--request", flags->request, "Request file")->required()->type_name("FILE");
  command->add_option("--response", flags->response, "Response file of that request")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--picture", flags->picture,
                   "Picture to write: .svg or .png; or .html, a page to look around in")
      ->required()
      ->type_name("FILE")
      ->check([](const std::string& file) {
        const std::filesystem::path extension = std::filesystem::path(file).extension();
        const bool is_known = extension == ".svg" || extension == ".png" || extension == ".html";
        return is_known ? std::string() : file + ": is neither .svg nor .png nor .html";
      });
  static constexpr std::array<std::pair<std::string_view, draw::SceneUp>, 2> kVerticals{
      {{"y", draw::SceneUp::kY}, {"z", draw::SceneUp::kZ}}};
  cli_support::add_choice(*command, "--vertical", flags->vertical, kVerticals,
                          "Axis that points up in the scene as read, --up included [y]")
      ->type_name("AXIS");
  command->add_flag("--side-by-side", flags->is_side_by_side,
                    "Draw two small plans, before and after, without details");
  command->footer(exit_code_help("") +
                  "\nExample: camway draw --request "
                  "scenes/requests/office-graze-door.json --response out.json --picture out.svg");
  command->callback([flags, &exit_code] { exit_code = run_draw(*flags); });
}

}  // namespace camway::tools
