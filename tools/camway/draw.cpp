// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "daemon/base/named_enum.h"
#include "daemon/cli_support/flag_checks.h"
#include "daemon/scene/import/record/import_words.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "tools/answers/scene_record.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/review_file.h"
#include "tools/drawing/answer_plan.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/scene_plan.h"
#include "tools/drawing/side_by_side.h"
#include "tools/drawing/storeys.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"
#include "tools/json/json_text.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

struct DrawFlags {
  SceneFlags scene;
  std::string request;
  std::string response;
  std::string picture;
  std::optional<draw::SceneUp> vertical;
  bool is_side_by_side = false;
};

bool is_page(const std::filesystem::path& picture) { return picture.extension() == ".html"; }

draw::PictureFiles files_of(const DrawFlags& flags) {
  const std::filesystem::path picture(flags.picture);
  draw::PictureFiles files;
  (picture.extension() == ".svg" ? files.svg : files.png) = picture;
  return files;
}

ExitCode invalid(const std::string& error) {
  print_error(error);
  return ExitCode::kInvalidInput;
}

ExitCode drawn(const std::string& error) {
  return error.empty() ? ExitCode::kSuccess : invalid(error);
}

/// Returns a sentence if a flag says that the scene is to be read in another way than the response
/// names; else an empty text. The scene would be another one.
std::string why_contrary(const SceneReading& flags, const SceneReading& of_response,
                         const std::string& response) {
  std::string error;
  const auto compare = [&](const char* flag, const auto& given, const auto& used) {
    if (!error.empty() || !given || !used || *given == *used) return;
    const auto word = [](const auto& value) {
      if constexpr (base::NamedEnum<std::remove_cvref_t<decltype(value)>>) {
        return std::string(base::name_of(value));
      } else {
        return fmt::format("{}", value);
      }
    };
    error = fmt::format("{}: is {}, but {} was planned in the scene read with {}; leave it out",
                        flag, word(*given), response, word(*used));
  };
  compare("--scale", flags.scale, of_response.scale);
  compare("--up", flags.up, of_response.up);
  compare("--unknown", flags.unknown, of_response.unknown);
  compare("--voxel-m", flags.voxel_m, of_response.voxel_m);
  return error;
}

scene::SnapshotResult load_drawn(const DrawFlags& flags, const std::string& file,
                                 const SceneReading& reading) {
  scene::SnapshotOptions options;
  options.import = flags.scene.import_options(reading);
  return load_timed(file, file, options, user_cache(flags.scene)).result;
}

/// Returns the axis that points up in a scene without a request, and how it is known.
std::pair<draw::SceneUp, std::string> vertical_of_scene(const DrawFlags& flags,
                                                        const scene::Mesh& mesh) {
  if (flags.vertical) return {*flags.vertical, ""};
  const scene::UpAxis up = flags.scene.import_options().up;
  if (up == scene::UpAxis::kZToY) return {draw::SceneUp::kY, ""};
  if (up == scene::UpAxis::kYToZ) return {draw::SceneUp::kZ, ""};
  return {draw::up_of(mesh), "(as the faces show; --vertical decides)"};
}

/// Draws the plan of a scene alone.
ExitCode draw_scene_alone(const DrawFlags& flags) {
  if (flags.scene.file.empty()) return invalid("--scene or --request is required");
  if (is_page(flags.picture)) {
    return invalid(flags.picture + ": a page needs --request and --response");
  }
  const scene::SnapshotResult loaded = load_drawn(flags, flags.scene.file, {});
  if (!loaded.snapshot) return invalid(loaded.error);
  draw::ScenePlan plan;
  plan.title = as_utf8(std::filesystem::path(flags.scene.file).filename().string());
  plan.mesh = *loaded.snapshot->mesh.share();
  std::tie(plan.up, plan.remark) = vertical_of_scene(flags, plan.mesh);
  return drawn(draw::draw_scene_plan(plan, files_of(flags)));
}

/// Returns the axis that points up in the picture of a response.
draw::SceneUp vertical_of_response(const DrawFlags& flags, const ResponseFile& response,
                                   const RequestFile& request, const SceneReading& reading,
                                   const scene::Mesh& mesh) {
  if (flags.vertical) return *flags.vertical;
  if (response.vertical_axis) return *response.vertical_axis;
  const std::optional<draw::SceneUp> told =
      vertical_axis(flags.scene.import_options(reading).up, request);
  return told ? *told : draw::up_of(mesh);
}

/// Draws a response in its scene.
ExitCode draw_response(const DrawFlags& flags) {
  const base::Result<RequestFile> request = read_request(flags.request);
  if (!request) return invalid(request.error);
  const base::Result<ResponseFile> response = read_as<ResponseFile>(flags.response);
  if (!response) return invalid(response.error);
  const std::string source = source_of(flags.response);
  if (response->path.empty()) return invalid(source + ": segments: has no path to draw");
  if (const std::string error = why_contrary(flags.scene.reading, response->scene_reading, source);
      !error.empty()) {
    return invalid(error);
  }
  const std::string scene_file = flags.scene.file_for(flags.request, *request);
  if (scene_file.empty()) {
    return invalid(source_of(flags.request) + ": scene: is missing, and there is no --scene");
  }
  // A response of an earlier release does not say how its scene was read.
  const SceneReading& reading =
      response->scene_reading.up ? response->scene_reading : request->reading;
  const scene::SnapshotResult loaded = load_drawn(flags, scene_file, reading);
  if (!loaded.snapshot) return invalid(loaded.error);
  const scene::Snapshot& snapshot = *loaded.snapshot;
  if (const std::string error =
          another_scene(source, response->scene_digest, snapshot.name, snapshot.digest);
      !error.empty()) {
    return invalid(error);
  }
  if (is_page(flags.picture)) {
    return drawn(write_review(snapshot, flags.request, flags.response, flags.picture));
  }
  draw::FloorPlan plan = draw::plan_of_answer(*request, *response, *snapshot.mesh.share());
  plan.title = as_utf8(std::filesystem::path(flags.response).stem().string());
  plan.up = vertical_of_response(flags, *response, *request, reading, plan.mesh);
  return drawn(flags.is_side_by_side ? draw::draw_side_by_side(plan, files_of(flags))
                                     : draw::draw_floor_plan(plan, files_of(flags)));
}

ExitCode run_draw(const DrawFlags& flags) {
  const std::vector<std::string> inputs = {flags.scene.file, flags.request, flags.response};
  if (const std::string fault = why_unwritable(flags.picture, inputs); !fault.empty()) {
    return invalid(fault);
  }
  if (is_page(flags.picture) && (flags.is_side_by_side || flags.vertical)) {
    return invalid(fmt::format("--{}: is for plans, .svg or .png; {} would be a page",
                               flags.is_side_by_side ? "side-by-side" : "vertical", flags.picture));
  }
  return flags.request.empty() ? draw_scene_alone(flags) : draw_response(flags);
}

constexpr char kDrawFooter[] =
    "With --scene alone the plan of the scene is drawn, with axes, to choose keyframes from. A "
    "response is\ndrawn in the scene that it was planned in: the options of reading that it names "
    "count, a flag that says\nanother one is refused, and so is a scene with another "
    "scene_digest. A response that names none was\nmade by an earlier release or a daemon; the "
    "request's options count then. --vertical only turns the\npicture, and counts before the "
    "vertical_axis of the response. Keyframes count from 0, as in messages;\nthose that were "
    "inserted have no number.\n";

}  // namespace

void add_draw_command(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand(
      "draw", "Draw a response, or a scene, as a floor plan of each storey: paths, collisions");
  const auto flags = std::make_shared<DrawFlags>();
  add_request_scene_flags(*command, flags->scene);
  CLI::Option* const response =
      command->add_option("--response", flags->response, "Response file of the request")
          ->type_name("FILE");
  CLI::Option* const request =
      command->add_option("--request", flags->request, "Request file; needs --response")
          ->type_name("FILE")
          ->needs(response);
  response->needs(request);
  command
      ->add_option(
          "-o,--picture", flags->picture,
          "Picture to write: .svg or .png; or .html, a page to look around in, of a response")
      ->required()
      ->type_name("FILE")
      ->check([](const std::string& file) {
        const std::filesystem::path extension = std::filesystem::path(file).extension();
        const bool is_known = extension == ".svg" || extension == ".png" || extension == ".html";
        return is_known ? std::string() : file + ": is neither .svg nor .png nor .html";
      });
  cli_support::add_choice(*command, "--vertical", flags->vertical,
                          base::named_values<scene::VerticalAxis>(),
                          "Axis that points up in the scene as read, --up included [the "
                          "response's, else what the request or the faces of the scene show]")
      ->type_name("AXIS");
  command
      ->add_flag("--side-by-side", flags->is_side_by_side,
                 "Draw two small plans, before and after, without details")
      ->needs(response);
  command->footer(std::string(kDrawFooter) + exit_code_help("") +
                  "\nExample: camway draw --request "
                  "scenes/requests/office-graze-door.json --response out.json --picture out.svg");
  command->callback([flags, &exit_code] { exit_code = run_draw(*flags); });
}

}  // namespace camway::tools
