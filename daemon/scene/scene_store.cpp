// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_store.h"

#include <cassert>
#include <utility>

namespace camway::scene {

void SceneStore::put(std::shared_ptr<const Snapshot> snapshot) {
  assert(snapshot);
  std::string name = snapshot->name;
  const std::lock_guard lock(mutex_);
  scenes_.insert_or_assign(std::move(name), std::move(snapshot));
}

bool SceneStore::remove(std::string_view name) {
  const std::lock_guard lock(mutex_);
  const auto position = scenes_.find(name);
  if (position == scenes_.end()) return false;
  scenes_.erase(position);
  return true;
}

std::shared_ptr<const Snapshot> SceneStore::find(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto position = scenes_.find(name);
  return position == scenes_.end() ? nullptr : position->second;
}

std::vector<std::shared_ptr<const Snapshot>> SceneStore::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<const Snapshot>> all;
  all.reserve(scenes_.size());
  for (const auto& [name, snapshot] : scenes_) all.push_back(snapshot);
  return all;
}

std::string SceneStore::summary() const {
  constexpr std::size_t kShown = 5;
  const std::vector<std::shared_ptr<const Snapshot>> all = list();
  if (all.empty()) return "there are no scenes";
  std::string text = "there are:";
  for (std::size_t i = 0; i < all.size() && i < kShown; ++i) text += " '" + all[i]->name + "'";
  if (all.size() > kShown) text += " and " + std::to_string(all.size() - kShown) + " more";
  return text;
}

}  // namespace camway::scene
