// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>

#include "client/c/handles.h"
#include "client/c/scene_calls.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

camway_scene_revision revision_of(const SceneRevision& from) {
  camway_scene_revision revision{};
  revision.revision = from.revision;
  revision.utime = from.utime;
  revision.operation = from.operation.c_str();
  revision.object = from.object.c_str();
  revision.client_id = from.client_id.c_str();
  revision.restored_revision = from.restored_revision;
  return revision;
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_scene_answer_num_revisions(const camway_scene_answer* answer, size_t* count) {
  return guarded([&] { return write_count(Handles::all().find(answer)->revisions.size(), count); });
}

camway_status camway_scene_answer_revision_at(const camway_scene_answer* answer, size_t index,
                                              camway_scene_revision* revision, size_t struct_size) {
  return guarded([&] {
    const auto found = Handles::all().find(answer);
    write_sized(revision_of(item_of(found->revisions, index)), revision, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_scene_history(camway_client* client, const char* scene,
                                   camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.scene_history(text_of(scene, "scene"));
  });
}

camway_status camway_scene_restore(camway_client* client, const char* scene, int64_t revision,
                                   const char* restore_as, camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.restore_scene(text_of(scene, "scene"), revision, optional_text(restore_as));
  });
}
