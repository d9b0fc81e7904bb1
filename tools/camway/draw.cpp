// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/motion/interpolate.h"
#include "daemon/scene/import.h"
#include "tools/camway/commands.h"
#include "tools/camway/scene_flags.h"
#include "tools/floor_plan.h"
#include "tools/json_io.h"

namespace camway::tools {
namespace {

constexpr std::size_t kDrawnSamples = 1500;

struct DrawFlags {
  SceneFlags scene;
  std::string request;
  std::string response;
  std::string picture;
  draw::SceneUp vertical = draw::SceneUp::kY;
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

ExitCode run_draw(const DrawFlags& flags) {
  const Parsed<planning::PlanRequest> request = read_plan_request(flags.request);
  if (!request.value) return invalid(request.error);
  const Parsed<planning::PlanResult> result = read_plan_response(flags.response);
  if (!result.value) return invalid(result.error);
  if (result.value->path.empty())
    return invalid(flags.response + ": segments: has no path to draw");
  const scene::ImportResult scene =
      scene::import_mesh(flags.scene.file, flags.scene.import_options());
  if (!scene.mesh) return invalid(scene.error);
  const std::filesystem::path picture(flags.picture);
  draw::PictureFiles files;
  (picture.extension() == ".svg" ? files.svg : files.png) = picture;
  const std::string error =
      draw_floor_plan(floor_plan(flags, *request.value, *result.value, *scene.mesh), files);
  return error.empty() ? ExitCode::kSuccess : invalid(error);
}

}  // namespace

void add_draw_command(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand(
      "draw", "Draw a response as a floor plan: scene, path before and after, collisions");
  const auto flags = std::make_shared<DrawFlags>();
  add_scene_flags(*command, flags->scene)->required();
  command->add_option("--request", flags->request, "Request file")->required()->type_name("FILE");
  command->add_option("--response", flags->response, "Response file of that request")
      ->required()
      ->type_name("FILE");
  command->add_option("--picture", flags->picture, "Picture to write: .svg or .png")
      ->required()
      ->type_name("FILE")
      ->check([](const std::string& file) {
        const std::filesystem::path extension = std::filesystem::path(file).extension();
        return extension == ".svg" || extension == ".png" ? std::string()
                                                          : file + ": is neither .svg nor .png";
      });
  command
      ->add_option("--vertical", flags->vertical,
                   "Axis that points up in the scene as read, --up included [y]")
      ->transform(CLI::CheckedTransformer(std::map<std::string, draw::SceneUp>{
                                              {"y", draw::SceneUp::kY}, {"z", draw::SceneUp::kZ}})
                      .description("y|z"))
      ->type_name("AXIS");
  command->footer(exit_code_help("") +
                  "\nExample: camway draw --scene scenes/office.obj --request "
                  "scenes/requests/office-graze-door.json --response out.json --picture out.svg");
  command->callback([flags, &exit_code] { exit_code = run_draw(*flags); });
}

}  // namespace camway::tools
