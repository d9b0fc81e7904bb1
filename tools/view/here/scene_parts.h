// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/view/backend.h"

namespace camway::view {

/// Returns the mesh of the first object of that digest, in the frame of the object. Shares that of
/// an object with one part.
MeshAnswer object_mesh(const scene::Snapshot& snapshot, std::string_view digest);

/// Digests of meshes in the frames of their objects. Each is made once for a source, which an
/// object keeps when it is moved. Thread-safe.
class MeshDigests {
 public:
  /// Returns the digest; empty for an occupancy map, whose mesh is another one after each scan.
  std::string of(const std::shared_ptr<const scene::ObjectSource>& source);

 private:
  struct Kept {
    std::weak_ptr<const scene::ObjectSource> source;  ///< another source may have its address later
    std::string digest;
  };
  std::mutex mutex_;
  std::map<const scene::ObjectSource*, Kept> kept_;
};

/// Returns triangles of the scene, as `Backend::triangles` does.
Answer scene_triangles(const scene::Snapshot& snapshot, const std::vector<std::int64_t>& indices);

}  // namespace camway::view
