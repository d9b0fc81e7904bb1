// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "daemon/messages/scene.h"
#include "daemon/messages/text.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {
namespace {

using Answer = scene_response_t;

/// Appends the elements from index `first` on that fit into a message.
template <class Elements, class List, class Convert>
std::int32_t put_list(const Elements& elements, std::int32_t first, const Convert& convert,
                      const Answer& answer, List& list) {
  auto size = static_cast<std::size_t>(answer.getEncodedSize());
  for (std::size_t i = static_cast<std::size_t>(std::max(first, 0)); i < elements.size(); ++i) {
    auto element = convert(elements[i]);
    size += static_cast<std::size_t>(element._getEncodedSizeNoHash());
    if (size > wire::kMaxMessageBytes) break;
    list.push_back(std::move(element));
  }
  return static_cast<std::int32_t>(list.size());
}

}  // namespace

scene_response_t plain_scene_answer(const scene_request_t& request, std::int32_t status,
                                    std::string_view message) {
  scene_response_t answer{};
  answer.client_id = request.client_id;
  answer.request_id = request.request_id;
  answer.status = status;
  answer.message = messages::clipped(message, wire::kMaxTextBytes);
  return answer;
}

scene_response_t unknown_scene_answer(const scene_request_t& request,
                                      const scene::SceneStore& scenes) {
  return plain_scene_answer(
      request, Answer::STATUS_UNKNOWN_SCENE,
      fmt::format("scene: '{}' is unknown; {}", request.scene, scenes.summary()));
}

scene_response_t scene_list(const scene_request_t& request, const scene::SceneStore& scenes) {
  Answer answer = plain_scene_answer(request, Answer::STATUS_OK, "");
  const auto all = scenes.list();
  answer.first = request.first;
  answer.total = static_cast<std::int32_t>(all.size());
  answer.num_scenes = put_list(
      all, request.first, [](const auto& scene) { return messages::scene_info_of(*scene); }, answer,
      answer.scenes);
  return answer;
}

scene_response_t scene_description(const scene_request_t& request,
                                   const scene::SceneStore& scenes) {
  const auto snapshot = scenes.find(request.scene);
  if (!snapshot) return unknown_scene_answer(request, scenes);
  Answer answer = plain_scene_answer(request, Answer::STATUS_OK, "");
  answer.scene = messages::scene_info_of(*snapshot);
  answer.first = request.first;
  answer.total = static_cast<std::int32_t>(snapshot->objects.size());
  answer.num_objects = put_list(
      snapshot->objects, request.first,
      [](const auto& object) { return messages::object_on_wire(*object); }, answer, answer.objects);
  return answer;
}

scene_response_t scene_history(const scene_request_t& request, const scene::SceneStore& scenes) {
  const scene::SceneStore::Kept kept = scenes.kept(request.scene);
  if (!kept.newest) return unknown_scene_answer(request, scenes);
  Answer answer = plain_scene_answer(request, Answer::STATUS_OK, "");
  answer.scene = messages::scene_info_of(*kept.newest);
  answer.first = request.first;
  answer.total = static_cast<std::int32_t>(kept.revisions.size());
  answer.num_changes =
      put_list(kept.revisions, request.first, messages::change_on_wire, answer, answer.changes);
  return answer;
}

}  // namespace camway::service
