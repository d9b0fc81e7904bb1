// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/camway/replay/session.h"

namespace camway::tools {

/// The scene that a recorded request was planned in.
struct FoundScene {
  /// Null if the daemon had no such scene, or for a reason in `why_not`.
  std::shared_ptr<const scene::Snapshot> snapshot;
  std::string why_not;      ///< why the scene cannot be rebuilt; empty if it can
  bool is_damaged = false;  ///< with `why_not`: what was recorded of the scene is damaged
};

/// Finds the scenes that recorded requests were planned in.
class ReplayScenes {
 public:
  virtual ~ReplayScenes() = default;

  /// Returns the revision of the scene that the answer of `request` names; if it has no answer, the
  /// newest one that is known.
  /// Thread-safe. Requests in the order of the session cost least.
  [[nodiscard]] virtual FoundScene snapshot_of(const RecordedRequest& request) = 0;

  /// Returns whether anything is known of a scene of that name.
  [[nodiscard]] virtual bool knows(const std::string& name) const = 0;
};

/// Scenes by their names in the requests, for sessions in which no scene changed.
using Scenes = std::map<std::string, std::shared_ptr<const scene::Snapshot>>;

class NamedScenes final : public ReplayScenes {
 public:
  explicit NamedScenes(Scenes scenes) : scenes_(std::move(scenes)) {}

  [[nodiscard]] FoundScene snapshot_of(const RecordedRequest& request) override;
  [[nodiscard]] bool knows(const std::string& name) const override {
    return scenes_.contains(name);
  }

 private:
  const Scenes scenes_;
};

/// Asks the sources that know a scene of the name one after the other, until one has it; else the
/// reason of the first counts. A scene that none knows, and that the daemon knew, counts as
/// damaged.
class SceneChain final : public ReplayScenes {
 public:
  void add(std::unique_ptr<ReplayScenes> scenes) { all_.push_back(std::move(scenes)); }

  [[nodiscard]] FoundScene snapshot_of(const RecordedRequest& request) override;
  [[nodiscard]] bool knows(const std::string& name) const override;

 private:
  std::vector<std::unique_ptr<ReplayScenes>> all_;
};

/// Whether the daemon answered that it has no such scene.
bool scene_was_unknown(const RecordedRequest& request);

/// Returns the names of scenes that requests of `session` need and that `scenes` does not know, in
/// order. A request that the daemon answered with an unknown scene needs none.
std::vector<std::string> missing_scenes(const Session& session, const ReplayScenes& scenes);

}  // namespace camway::tools
