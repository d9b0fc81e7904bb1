// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "tools/view/backend.h"
#include "tools/view/display/glb_cache.h"
#include "tools/view/work_pool.h"

namespace camway::view {

/// The file of a mesh for a page, or why there is none.
struct GlbAnswer {
  std::shared_ptr<const std::string> glb;  ///< null exactly if there is an error
  int code = code::kOk;
  std::string error = {};  ///< a sentence
};

/// Takes a file: called once at most, on any thread. Must neither throw nor wait.
using GlbDone = std::function<void(GlbAnswer)>;

/// Makes files of the meshes of a backend, on threads of its own, and keeps those that were asked
/// for last. Must be kept by a `std::shared_ptr`. Thread-safe.
class MeshDesk : public std::enable_shared_from_this<MeshDesk> {
 public:
  /// Keeps a reference to `backend`.
  explicit MeshDesk(Backend& backend);

  /// Makes the file of the object of `scene` with that digest (`mesh_glb`). Nothing comes once the
  /// desk is gone.
  void ask(const std::string& scene, const std::string& digest, GlbDone done);
  /// Waits for the file. Not for threads of the backend.
  GlbAnswer wait_for(const std::string& scene, const std::string& digest);

  /// Runs other work with meshes on a thread of the desk. Drops it once the desk was stopped.
  void post(WorkPool::Work work) { pool_.post(std::move(work)); }
  /// Waits for the work that runs, and drops the rest.
  void stop() { pool_.stop(); }

 private:
  [[nodiscard]] GlbAnswer made(const std::string& digest, const MeshAnswer& answer);

  Backend& backend_;
  GlbCache cache_;
  WorkPool pool_;  ///< destroyed first
};

}  // namespace camway::view
