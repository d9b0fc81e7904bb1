// SPDX-License-Identifier: MIT
#pragma once

#include <camway/scene.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include <camway/scene_request_t.hpp>

#include "client/engine/context.h"
#include "client/engine/engine.h"

namespace camway {

/// Cancels calls about scenes. A call may send several requests in turn; it compares `count()` with
/// the value at its begin to see whether it was cancelled between two of them. Thread-safe.
class SceneCancel {
 public:
  /// Cancels the requests that are pending, and the calls that they belong to.
  void cancel(Engine& engine);
  /// Returns how often `cancel` was called. It is incremented before the requests are cancelled.
  std::uint64_t count() const { return count_.load(); }

 private:
  std::atomic<std::uint64_t> count_ = 0;
};

/// The objects that a call about scenes uses. All must outlive the call.
struct SceneAsker {
  Context& context;
  Engine& engine;
  const SceneCancel& cancel;
};

/// Sends `upload`, if it is not empty, then `request`, and waits for the answer. Sets the request's
/// client id, request id, time and deadline. Not for the engine's own thread.
SceneAnswer ask_scene(const SceneAsker& asker, scene_request_t request,
                      const std::vector<std::uint8_t>& upload = {});

/// Exports a map and fetches all its pages. Not for the engine's own thread.
SceneMap ask_scene_map(const SceneAsker& asker, const scene_request_t& request);

/// Requests the triangles of an object and fetches all their pages. Not for the engine's own
/// thread.
SceneTriangles ask_triangles(const SceneAsker& asker, const scene_request_t& request);

/// Requests a list until all of it has come. Not for the engine's own thread.
SceneAnswer ask_scene_list(const SceneAsker& asker, scene_request_t request);

}  // namespace camway
