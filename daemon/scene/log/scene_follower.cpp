// SPDX-License-Identifier: MIT
#include "daemon/scene/log/scene_follower.h"

#include <exception>
#include <string_view>
#include <utility>
#include <variant>

#include "daemon/scene/log/removal_requests.h"

namespace camway::scene {
namespace {

std::string_view text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

SceneFollower::SceneFollower(SharedLog& log, DurableScenes& scenes, SceneStore& store, Warn warn,
                             Advanced advanced, Changed changed)
    : log_(log),
      scenes_(scenes),
      store_(store),
      warn_(std::move(warn)),
      advanced_(std::move(advanced)),
      changed_(std::move(changed)),
      position_(log.followed()) {
  log_.follow([this](const LogUpdate& update) { take(update); });
}

SceneFollower::~SceneFollower() { log_.stop_following(); }

// A scene that could not be followed stays as it is, which its revision tells. The next summary, or
// a new scene of that name, brings it up to date.
void SceneFollower::take(const LogUpdate& update) {
  const bool is_removal = update.kind == LogUpdate::Kind::kRemoval;
  std::string fault;
  try {
    if (is_removal) {
      store_.begin_above(update.entry.revision);
      store_.remember_removals(removals_in(text_of(update.entry.record)));
    }
    bool is_new = false;
    const StoreResult followed = store_.follow(update.scene, [&](const Snapshot* newest) {
      auto work = scenes_.read(update, newest, store_.limits().history);
      is_new = work && !std::holds_alternative<std::monostate>(*work);
      return work;
    });
    fault = followed.error;
    if (is_new && followed.snapshot && changed_) changed_(*followed.snapshot, is_removal);
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
