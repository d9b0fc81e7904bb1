// SPDX-License-Identifier: MIT
#include "tools/camway/replay/scenes/replay_scenes.h"

#include <algorithm>
#include <optional>
#include <set>

#include "lcmtypes/wire/channels.h"

namespace camway::tools {

bool scene_was_unknown(const RecordedRequest& request) {
  return request.answer && request.answer->result &&
         request.answer->result->status == plan_response_t::STATUS_UNKNOWN_SCENE;
}

std::vector<std::string> missing_scenes(const Session& session, const ReplayScenes& scenes) {
  std::set<std::string> missing;
  for (const RecordedRequest& request : session.requests) {
    if (request.request && !scenes.knows(request.scene) && !scene_was_unknown(request)) {
      missing.insert(request.scene);
    }
  }
  return {missing.begin(), missing.end()};
}

FoundScene NamedScenes::snapshot_of(const RecordedRequest& request) {
  const auto found = scenes_.find(request.scene);
  return {found == scenes_.end() ? nullptr : found->second, {}};
}

FoundScene SceneChain::snapshot_of(const RecordedRequest& request) {
  std::optional<FoundScene> fault;
  for (const auto& scenes : all_) {
    if (!scenes->knows(request.scene)) continue;
    FoundScene found = scenes->snapshot_of(request);
    if (found.why_not.empty()) return found;
    // A later source may have what is missing or damaged in this one.
    if (!fault) fault = std::move(found);
  }
  if (fault) return *std::move(fault);
  if (scene_was_unknown(request)) return {};
  return {nullptr, "scene '" + wire::printable(request.scene) + "' is not in the session", true};
}

bool SceneChain::knows(const std::string& name) const {
  return std::ranges::any_of(all_, [&](const auto& scenes) { return scenes->knows(name); });
}

}  // namespace camway::tools
