// SPDX-License-Identifier: MIT
#pragma once

#include <camway/camway.h>
#include <camway/client.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "client/c/handles.h"
#include "client/c/scene_shapes.h"

/// Calls about scenes, and the lists of their answers.
namespace camway::c {

/// Returns the status of an answer, and gives a handle of it to the caller, who may want none.
inline camway_status hand_over_scene(SceneAnswer found, camway_scene_answer** answer) {
  const camway_status status = returned(found.status, found.error);
  if (status == CAMWAY_OK && answer != nullptr) {
    *answer = Handles::all().add<camway_scene_answer>(
        std::make_shared<const SceneAnswer>(std::move(found)));
  }
  return status;
}

/// Runs a call about scenes: `call` returns the answer of a client.
template <class Call>
camway_status ask_about_scenes(camway_client* client, camway_scene_answer** answer,
                               const Call& call) noexcept {
  return guarded([&] {
    if (answer != nullptr) *answer = nullptr;
    return hand_over_scene(call(*Handles::all().find(client)), answer);
  });
}

/// Adds an object: `shape` returns it.
template <class Shape>
camway_status put(camway_client* client, const char* scene, const char* object, const Shape& shape,
                  const camway_pose* pose, camway_scene_answer** answer) noexcept {
  return ask_about_scenes(client, answer, [&](Client& found) {
    return found.put_object(text_of(scene, "scene"), text_of(object, "object"), shape(),
                            pose_of(pose));
  });
}

template <class List>
const auto& item_of(const List& list, std::size_t index) {
  if (index < list.size()) return list[index];
  throw Refusal{CAMWAY_INVALID, "index: is " + std::to_string(index) + ", and there are " +
                                    std::to_string(list.size())};
}

inline camway_status write_count(std::size_t size, std::size_t* count) {
  require(count, "count");
  *count = size;
  return CAMWAY_OK;
}

}  // namespace camway::c
