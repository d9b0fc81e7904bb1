// SPDX-License-Identifier: MIT
#include "daemon/scene/log/scene_follower.h"

#include <exception>
#include <utility>

namespace camway::scene {

SceneFollower::SceneFollower(SharedLog& log, DurableScenes& scenes, SceneStore& store, Warn warn,
                             Advanced advanced)
    : log_(log),
      scenes_(scenes),
      store_(store),
      warn_(std::move(warn)),
      advanced_(std::move(advanced)),
      position_(log.followed()) {
  log_.follow([this](const LogUpdate& update) { take(update); });
}

SceneFollower::~SceneFollower() { log_.stop_following(); }

// A scene that could not be followed stays as it is, which its revision tells. The next summary, or
// a new scene of that name, brings it up to date.
void SceneFollower::take(const LogUpdate& update) {
  std::string fault;
  try {
    if (update.kind == LogUpdate::Kind::kRemoval) store_.begin_above(update.entry.revision);
    const StoreResult followed = store_.follow(update.scene, [&](const Snapshot* newest) {
      return scenes_.read(update, newest, store_.limits().history);
    });
    fault = followed.error;
  } catch (const std::exception& error) {
    fault = error.what();
  }
  if (!fault.empty() && warn_) {
    warn_("revision " + std::to_string(update.entry.revision) + " of scene '" + update.scene +
          "' cannot be made here: " + fault);
  }
  // The log is read again from its beginning after a loss of the connection.
  if (update.position <= position_) return;
  position_ = update.position;
  if (advanced_) advanced_(position_);
}

}  // namespace camway::scene
