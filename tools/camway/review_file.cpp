// SPDX-License-Identifier: MIT
#include "tools/camway/review_file.h"

#include <memory>
#include <utility>

#include "tools/camway/door_request.h"
#include "tools/json/json_response.h"
#include "tools/support/output_file.h"
#include "tools/view/here/planner_here.h"
#include "tools/view/page/embed/embedded_page.h"
#include "tools/view/review/review.h"

namespace camway::tools {
namespace {

/// Returns a scene that was read from a file, and its object, under another name: the page goes to
/// others, who need not know the folders here.
std::shared_ptr<const scene::Snapshot> renamed(const scene::Snapshot& snapshot,
                                               const std::string& name) {
  auto result = std::make_shared<scene::Snapshot>(snapshot);
  result->name = name;
  for (std::shared_ptr<const scene::SceneObject>& object : result->objects) {
    if (object->name != snapshot.name) continue;
    scene::SceneObject other = *object;
    other.name = name;
    object = std::make_shared<const scene::SceneObject>(std::move(other));
  }
  return result;
}

}  // namespace

std::string write_review(const scene::Snapshot& snapshot, const std::string& request_file,
                         const std::string& response_file, const std::string& page_file) {
  base::Result<DoorRequest> request = read_door_request(request_file);
  if (!request) return request.error;
  base::Result<std::string> answer = read_text(response_file);
  if (!answer) return answer.error;
  const auto result = parse_as<planning::PlanResult>(*answer, source_of(response_file));
  if (!result) return result.error;
  const std::string scene = place_name(snapshot.name);
  const std::unique_ptr<view::Backend> backend = view::plan_here(renamed(snapshot, scene));
  const auto meshes = std::make_shared<view::MeshDesk>(*backend);
  const view::ReviewOrder order{plan_order(*std::move(request), scene), *std::move(answer)};
  const view::ReviewFile made = view::make_review(order, view::embedded_page(), *backend, *meshes);
  return made.code == view::code::kOk ? write_file(page_file, made.html) : made.error;
}

}  // namespace camway::tools
