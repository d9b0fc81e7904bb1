// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"
#include "daemon/scene/snapshot/scene_change.h"

namespace camway::scene {

/// An object of a scene in the log: its content is a blob (`source_record.h`).
struct RecordedObject {
  std::string name;
  BlobId source{};
  Placement placement;
};

/// A `SceneChange` in the log.
struct RecordedChange {
  SceneChange::Kind kind = SceneChange::Kind::kPut;
  std::string object;
  std::optional<BlobId> source;  ///< set for kPut
  Placement placement;
};

/// The changes that led to a revision.
struct RecordedRevision {
  KeptRevision made;
  std::vector<RecordedChange> changes;
};

/// A scene as it was at its oldest kept revision, and its changes since then: what `SceneHistory`
/// holds, with ids in place of contents. A value type.
struct RecordedScene {
  ObjectOptions options;
  KeptRevision oldest;
  std::vector<RecordedObject> objects;  ///< at `oldest`, in the order of their names
  std::vector<RecordedRevision> revisions;

  [[nodiscard]] std::uint64_t newest_revision() const {
    return revisions.empty() ? oldest.revision : revisions.back().made.revision;
  }
  /// The blobs that this names, each once.
  [[nodiscard]] std::vector<BlobId> needs() const;
  /// Forgets the oldest revisions until `revision` is the oldest, or the newest one is reached.
  void forget_before(std::uint64_t revision);
};

/// The records of the log, in CBOR (RFC 8949): an entry is a whole scene or one revision of it, a
/// summary is a whole scene.
Bytes change_record_of(const RecordedScene& scene);
Bytes change_record_of(const RecordedRevision& revision);

using ChangeRecord = std::variant<RecordedScene, RecordedRevision>;
/// Reads a record, whatever the bytes are. Fails if they are none.
base::Result<ChangeRecord> change_record_from(const Bytes& bytes);

/// Reads summary and entries of a scene. Fails if they do not fit together, with `damaged_scene`.
base::Result<RecordedScene> recorded_scene_of(const LoggedScene& logged);

/// The failure to read a scene of the log.
base::Failure damaged_scene(const std::string& name, const std::string& reason);

}  // namespace camway::scene
