// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_SCENE_HISTORY_H
#define CAMWAY_C_SCENE_HISTORY_H

#include <camway/c/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/// A revision of a scene that can be restored, and the change that made it.
typedef struct camway_scene_revision {
  uint32_t struct_size;  ///< bytes that the library has set
  uint32_t reserved;
  int64_t revision;
  int64_t utime;              ///< time of the change, microseconds since 1970
  const char* operation;      ///< "load", "put", "move", "remove", "scan" or "restore"
  const char* object;         ///< object that was changed; "": the whole scene
  const char* client_id;      ///< client that made the change; "": the daemon read its files
  int64_t restored_revision;  ///< "restore": revision whose objects it has; else 0
} camway_scene_revision;

/// Number of revisions in the answer of `camway_scene_history`, oldest first, and one of them:
/// CAMWAY_INVALID beyond the end.
camway_status camway_scene_answer_num_revisions(const camway_scene_answer* answer, size_t* count);
camway_status camway_scene_answer_revision_at(const camway_scene_answer* answer, size_t index,
                                              camway_scene_revision* revision, size_t struct_size);

// The functions below wait, so handlers must not call them. `answer` may be NULL. It gets a handle
// if the status is CAMWAY_OK, else NULL.

/// Lists the revisions of a scene that can be restored, the newest included.
camway_status camway_scene_history(camway_client* client, const char* scene,
                                   camway_scene_answer** answer);

/// Makes a new revision of a scene with the objects of an earlier one. With `restore_as`, which may
/// be NULL, makes or replaces the scene of that name instead.
camway_status camway_scene_restore(camway_client* client, const char* scene, int64_t revision,
                                   const char* restore_as, camway_scene_answer** answer);

#ifdef __cplusplus
}
#endif

#endif
