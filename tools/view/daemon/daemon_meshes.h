// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/view/backend.h"

namespace camway::view {

/// A scene of a daemon as it was rebuilt here, or why there is none.
struct RebuiltScene {
  std::shared_ptr<const scene::Snapshot> snapshot;  ///< null exactly if there is an error
  /// Whether an occupancy map is part of it, whose inside is not here: the triangles are all there,
  /// but a path must not be proved against them alone.
  bool lacks_inside = false;
  int code = code::kOk;
  std::string error = {};
};

/// Fetches triangles of a daemon's scenes, and keeps those of objects by their digests.
/// Thread-safe; calls wait for the daemon.
class DaemonMeshes {
 public:
  /// Keeps a reference to `client`.
  explicit DaemonMeshes(Client& client) : client_(client) {}

  /// Returns the mesh of an object, as `Backend::mesh` does.
  MeshAnswer mesh(const std::string& scene, const std::string& digest);

  /// Returns whether the mesh of the object with this digest is here.
  [[nodiscard]] bool keeps(const std::string& digest) { return find(digest).source != nullptr; }

  /// Returns a name of the mesh of an object in its own frame, as the object is described now.
  /// Moves do not change it if the mesh was here before the move: then the daemon's digest proves
  /// that it is the same one, which is kept under the new digest. Empty for occupancy maps.
  std::string mesh_digest(const SceneInfo& scene, const SceneObject& object);

  /// Returns a scene as it is now, with all of its objects where they are. Its digest, and those of
  /// its objects, are checked against the daemon's.
  RebuiltScene rebuilt(const std::string& scene);

  /// Returns the mesh of the scene that was rebuilt last if it has this digest; null otherwise.
  [[nodiscard]] std::shared_ptr<const scene::Mesh> known(const std::string& scene_digest) const;

 private:
  struct Fetched {
    std::shared_ptr<const scene::ObjectSource> source;  ///< null on an error
    bool has_inside = false;
    std::int64_t scene_triangles = 0;  ///< of the scene in which it was found
    Status status = Status::kOk;
    std::string error = {};
  };
  struct Kept {
    std::string digest;
    std::string digest_before;  ///< before the last move, which may still be asked for
    Fetched object;
    [[nodiscard]] bool has(const std::string& asked) const {
      return !asked.empty() && (digest == asked || digest_before == asked);
    }
  };
  /// An object as it was described last.
  struct Described {
    std::string digest;
    Pose pose;
    std::string mesh_digest;
  };

  Fetched fetch(const std::string& scene, const std::string& digest);
  [[nodiscard]] Fetched find(const std::string& digest);
  void keep(const std::string& digest, const Fetched& object);
  /// Returns whether an object is the one that had another digest, in another place.
  bool is_moved(const std::string& digest_before, const SceneInfo& scene,
                const SceneObject& object);
  void rename(const std::string& digest_before, const std::string& digest);
  RebuiltScene rebuild(const SceneAnswer& described, bool& is_outdated);

  Client& client_;
  mutable std::mutex mutex_;  ///< guards what is below
  std::list<Kept> kept_;      ///< the one asked for last first
  std::uint64_t bytes_ = 0;
  std::map<std::pair<std::string, std::string>, Described> described_;  ///< by scene and object
  RebuiltScene last_;
};

}  // namespace camway::view
