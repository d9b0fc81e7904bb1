// SPDX-License-Identifier: MIT
#include "daemon/messages/scene.h"

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "daemon/messages/plan.h"
#include "daemon/messages/text.h"
#include "lcmtypes/wire/layout.h"

namespace camway::messages {

scene_info_t scene_info_of(const scene::Snapshot& snapshot) {
  scene_info_t info{};
  info.name = clipped(snapshot.name, wire::kMaxSceneNameBytes);
  info.revision = static_cast<std::int64_t>(snapshot.revision);
  info.digest = clipped(snapshot.digest, wire::kMaxDigestBytes);
  info.num_triangles = static_cast<std::int64_t>(snapshot.index.size());
  if (!snapshot.index.bounds().isEmpty()) {
    std::copy_n(snapshot.index.bounds().min().data(), 3, info.bounds_min_m);
    std::copy_n(snapshot.index.bounds().max().data(), 3, info.bounds_max_m);
  }
  info.body_bounds = to_wire(snapshot.options.bounds);
  if (snapshot.occupancy) info.occupancy_resolution_m = snapshot.occupancy->resolution_m();
  return info;
}

scene_object_t object_on_wire(const scene::SceneObject& object) {
  scene_object_t wire{};
  wire.name = clipped(object.name, wire::kMaxObjectNameBytes);
  wire.kind = scene::to_string(object.source->kind);
  wire.digest = object.digest;
  wire.num_triangles = static_cast<std::int64_t>(object.triangles);
  std::copy_n(object.placement.position_W().data(), 3, wire.position_m);
  std::copy_n(geometry::wxyz(object.placement.orientation_WO()).data(), 4, wire.orientation_wxyz);
  if (const geometry::Box& bounds = object.bounds_W; !bounds.isEmpty()) {
    std::copy_n(bounds.min().data(), 3, wire.bounds_min_m);
    std::copy_n(bounds.max().data(), 3, wire.bounds_max_m);
  }
  return wire;
}

scene_change_t change_on_wire(const scene::KeptRevision& kept) {
  using std::chrono::microseconds;
  scene_change_t wire{};
  wire.revision = static_cast<std::int64_t>(kept.revision);
  wire.utime = std::chrono::duration_cast<microseconds>(kept.note.when.time_since_epoch()).count();
  wire.operation = clipped(kept.note.operation, wire::kMaxOperationBytes);
  wire.object = clipped(kept.note.object, wire::kMaxObjectNameBytes);
  wire.client_id = kept.note.client;
  wire.restored_revision = static_cast<std::int64_t>(kept.note.restored_revision);
  return wire;
}

}  // namespace camway::messages
