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

/// Ends the questions about scenes that are on their way, and those that each of their askers would
/// put next. Safe from any thread.
class SceneCancel {
 public:
  void cancel(Engine& engine);
  /// How often that was; grows before the questions hear of it.
  std::uint64_t count() const { return count_.load(); }

 private:
  std::atomic<std::uint64_t> count_ = 0;
};

/// What questions about scenes are asked with. All outlive the call.
struct SceneAsker {
  Context& context;
  Engine& engine;
  const SceneCancel& cancel;
};

/// Sends `upload` first, if there is one, then asks for what `request` says; client, request id and
/// deadline are set here. Waits for the answer; not for the engine's own thread.
SceneAnswer ask_scene(const SceneAsker& asker, scene_request_t request,
                      const std::vector<std::uint8_t>& upload = {});

/// Asks for a map until all of it is here.
SceneMap ask_scene_map(const SceneAsker& asker, const scene_request_t& request);

/// Asks for a list until all of it is here.
SceneAnswer ask_scene_list(const SceneAsker& asker, scene_request_t request);

}  // namespace camway
