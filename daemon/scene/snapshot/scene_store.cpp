// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/scene_store.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include "daemon/scene/mirror/scene_mirror.h"

namespace camway::scene {
namespace {

StoreResult cancelled() { return {nullptr, StoreFault::kCancelled, "it was cancelled"}; }

StoreResult not_in_history(std::string_view scene, std::uint64_t revision,
                           const SceneHistory& history) {
  const std::vector<KeptRevision> kept = history.revisions();
  return {nullptr, StoreFault::kInvalid,
          "revision: " + std::to_string(revision) + " of scene '" + std::string(scene) +
              "' is not kept; " + std::to_string(kept.front().revision) + " to " +
              std::to_string(kept.back().revision) + " are"};
}

}  // namespace

SceneStore::ChangeLock::ChangeLock(SceneStore& store, std::string_view scene) : store_(store) {
  std::unique_lock lock(store_.mutex_);
  store_.turn_ended_.wait(lock, [&] { return !store_.changing_.contains(scene); });
  scene_ = store_.changing_.emplace(scene).first;
}

SceneStore::ChangeLock::~ChangeLock() {
  {
    const std::lock_guard lock(store_.mutex_);
    store_.changing_.erase(scene_);
  }
  store_.turn_ended_.notify_all();
}

SceneStore::Usage SceneStore::usage_of(const Snapshot& snapshot) {
  return {1, snapshot.index.size(),
          snapshot.occupancy ? snapshot.occupancy->statistics().memory_bytes : 0};
}

std::uint64_t SceneStore::next_revision(std::string_view scene) const {
  const std::lock_guard lock(mutex_);
  const auto found = scenes_.find(scene);
  return 1 + (found == scenes_.end() ? highest_removed_ : found->second.newest->revision);
}

SceneStore::Usage SceneStore::usage_before(std::string_view scene) const {
  const auto found = scenes_.find(scene);
  return found == scenes_.end() ? Usage{} : found->second.usage;
}

std::optional<StoreResult> SceneStore::over_limit(const Snapshot& next, const Usage& usage) const {
  const Usage before = usage_before(next.name);
  const auto over = [&](Limit limit, const std::string& what) {
    return StoreResult{nullptr, StoreFault::kLimit, "scene '" + next.name + "': " + what, limit};
  };
  if (next.objects.size() > limits_.objects) {
    return over(Limit::kObjects, "more than " + std::to_string(limits_.objects) + " objects");
  }
  if (total_.scenes - before.scenes + usage.scenes > limits_.scenes) {
    return over(Limit::kScenes, "there are " + std::to_string(limits_.scenes) + " scenes already");
  }
  if (total_.triangles - before.triangles + usage.triangles > limits_.triangles) {
    return over(Limit::kTriangles, "with it there would be more than " +
                                       std::to_string(limits_.triangles) +
                                       " triangles in all scenes");
  }
  if (total_.occupancy_bytes - before.occupancy_bytes + usage.occupancy_bytes >
      limits_.occupancy_bytes) {
    return over(Limit::kOccupancyBytes,
                "with it the occupancy maps of all scenes would take more than " +
                    std::to_string(limits_.occupancy_bytes) + " bytes");
  }
  return std::nullopt;
}

void SceneStore::count(const Usage& before, const Usage& after) {
  total_.scenes += after.scenes - before.scenes;
  total_.triangles += after.triangles - before.triangles;
  total_.occupancy_bytes += after.occupancy_bytes - before.occupancy_bytes;
}

std::optional<StoreResult> SceneStore::reserve(const Snapshot& next, const Usage& usage,
                                               const ChangeTicket& ticket) {
  const std::lock_guard lock(mutex_);
  if (std::optional<StoreResult> over = over_limit(next, usage)) return over;
  if (!ticket.try_commit()) return cancelled();
  count(usage_before(next.name), usage);
  return std::nullopt;
}

StoreResult SceneStore::not_kept(const Snapshot& next, const Usage& usage, std::string reason) {
  const std::lock_guard lock(mutex_);
  count(usage, usage_before(next.name));
  return {nullptr, StoreFault::kNotKept, std::move(reason)};
}

StoreResult SceneStore::publish(Entry entry) {
  const std::shared_ptr<const Snapshot> newest = entry.newest;
  std::optional<Entry> old;  // destroyed after the lock is released, since that takes time
  {
    const std::lock_guard lock(mutex_);
    const auto [place, is_new] = scenes_.try_emplace(newest->name, entry);
    if (!is_new) old = std::exchange(place->second, std::move(entry));
    forget_history();
  }
  notify();
  return {newest, StoreFault::kNone, ""};
}

StoreResult SceneStore::put(std::shared_ptr<const Snapshot> snapshot, ChangeNote note,
                            const ChangeTicket& ticket) {
  assert(snapshot);
  note.when = std::chrono::system_clock::now();
  const ChangeLock turn(*this, snapshot->name);
  if (auto made = changed_by(snapshot->name, note.request)) return {made, StoreFault::kNone, ""};
  const std::shared_ptr<const Snapshot> before = find(snapshot->name);
  if (const std::uint64_t next = next_revision(snapshot->name); snapshot->revision < next) {
    auto numbered = std::make_shared<Snapshot>(*snapshot);
    numbered->revision = next;
    snapshot = std::move(numbered);
  }
  const Usage usage = usage_of(*snapshot);
  if (std::optional<StoreResult> fault = reserve(*snapshot, usage, ticket)) return *fault;
  if (journal_ != nullptr) {
    std::string reason = journal_->keep_scene(*snapshot, before ? before->revision : 0, note);
    if (!reason.empty()) return not_kept(*snapshot, usage, std::move(reason));
  }
  SceneHistory history(*snapshot, limits_.history, std::move(note));
  return publish({std::move(snapshot), usage, std::move(history)});
}

StoreResult SceneStore::adopt(SceneHistory history) {
  const ChangeLock turn(*this, history.name());
  std::shared_ptr<const Snapshot> newest = history.rebuild(history.newest_revision());
  const Usage usage = usage_of(*newest);
  if (std::optional<StoreResult> fault = reserve(*newest, usage, {})) return *fault;
  return publish({std::move(newest), usage, std::move(history)});
}

void SceneStore::begin_above(std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  highest_removed_ = std::max(highest_removed_, revision);
}

StoreResult SceneStore::unknown(std::string_view scene) const {
  return {nullptr, StoreFault::kUnknownScene,
          "scene: '" + std::string(scene) + "' is unknown; " + summary()};
}

StoreResult SceneStore::change(std::string_view scene, SceneChange change, ChangeNote note,
                               const ChangeTicket& ticket) {
  const ChangeLock turn(*this, scene);
  const std::shared_ptr<const Snapshot> before = find(scene);
  if (!before) return unknown(scene);
  if (changed_by(scene, note.request)) return {before, StoreFault::kNone, ""};
  return make_next(*before, {std::move(change)}, std::move(note), ticket);
}

StoreResult SceneStore::restore(std::string_view scene, std::uint64_t revision, ChangeNote note,
                                const ChangeTicket& ticket) {
  const ChangeLock turn(*this, scene);
  const std::optional<SceneHistory> known = history(scene);
  if (!known) return unknown(scene);
  const std::shared_ptr<const Snapshot> before = find(scene);
  if (changed_by(scene, note.request)) return {before, StoreFault::kNone, ""};
  std::optional<SceneChanges> changes = known->changes_back_to(revision);
  if (!changes) return not_in_history(scene, revision, *known);
  note.restored_revision = revision;
  return make_next(*before, *std::move(changes), std::move(note), ticket);
}

StoreResult SceneStore::restore_as(std::string_view scene, std::uint64_t revision,
                                   std::string other, ChangeNote note, const ChangeTicket& ticket) {
  const std::optional<SceneHistory> known = history(scene);
  if (!known) return unknown(scene);
  const std::shared_ptr<const Snapshot> then = known->rebuild(revision, ticket.stop());
  if (ticket.is_cancelled()) return cancelled();
  if (!then) return not_in_history(scene, revision, *known);
  note.restored_revision = revision;
  auto renamed = std::make_shared<Snapshot>(*then);
  renamed->name = std::move(other);
  renamed->revision = 1;
  return put(std::move(renamed), std::move(note), ticket);
}

StoreResult SceneStore::make_next(const Snapshot& before, SceneChanges changes, ChangeNote note,
                                  const ChangeTicket& ticket) {
  SnapshotResult result = changed(before, changes, before.revision + 1, ticket.stop());
  if (ticket.is_cancelled()) return cancelled();
  if (!result.snapshot) {
    const bool is_limit = result.limit != Limit::kNone;
    return {nullptr, is_limit ? StoreFault::kLimit : StoreFault::kInvalid, std::move(result.error),
            result.limit};
  }
  const Snapshot& next = *result.snapshot;
  const Usage usage = usage_of(next);
  note.when = std::chrono::system_clock::now();
  if (std::optional<StoreResult> fault = reserve(next, usage, ticket)) return *fault;
  if (journal_ != nullptr) {
    std::string reason = journal_->keep_changes(before, next, changes, note, oldest_kept(before));
    if (!reason.empty()) return not_kept(next, usage, std::move(reason));
  }
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = scenes_.find(before.name)->second;
    entry.newest = result.snapshot;
    entry.usage = usage;
    entry.history.add(std::move(changes), {next.revision, std::move(note)});
    forget_history();
  }
  notify();
  return {std::move(result.snapshot), StoreFault::kNone, ""};
}

std::shared_ptr<const Snapshot> SceneStore::changed_by(std::string_view scene,
                                                       const std::string& request) const {
  const std::lock_guard lock(mutex_);
  const auto found = scenes_.find(scene);
  const bool is_made = found != scenes_.end() && found->second.history.has_request(request);
  return is_made ? found->second.newest : nullptr;
}

std::uint64_t SceneStore::oldest_kept(const Snapshot& newest) const {
  const std::lock_guard lock(mutex_);
  return scenes_.find(newest.name)->second.history.oldest_revision();
}

void SceneStore::forget_history() {
  std::uint64_t bytes = 0;
  for (const auto& [name, entry] : scenes_) bytes += entry.history.bytes();
  while (bytes > limits_.history.bytes) {
    SceneHistory& longest = std::ranges::max_element(scenes_, {}, [](const auto& scene) {
                              return scene.second.history.bytes();
                            })->second.history;
    bytes -= longest.bytes();
    longest.forget_oldest();
    bytes += longest.bytes();
  }
}

StoreResult SceneStore::remove(std::string_view scene, const ChangeTicket& ticket) {
  std::optional<Entry> old;
  const ChangeLock turn(*this, scene);
  const std::shared_ptr<const Snapshot> last = find(scene);
  if (!last) return unknown(scene);
  if (!ticket.try_commit()) return cancelled();
  if (journal_ != nullptr) {
    std::string reason = journal_->keep_removal(*last);
    if (!reason.empty()) return {nullptr, StoreFault::kNotKept, std::move(reason)};
  }
  {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(scene);
    highest_removed_ = std::max(highest_removed_, last->revision);
    old = std::move(found->second);
    count(old->usage, {});
    scenes_.erase(found);
  }
  notify();
  return {last, StoreFault::kNone, ""};
}

void SceneStore::on_change(std::function<void()> listener) {
  const std::lock_guard notifying(notify_mutex_);
  listener_ = std::move(listener);
}

void SceneStore::notify() {
  const std::lock_guard notifying(notify_mutex_);
  if (listener_) listener_();
}

std::shared_ptr<const Snapshot> SceneStore::find(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto position = scenes_.find(name);
  return position == scenes_.end() ? nullptr : position->second.newest;
}

std::optional<SceneHistory> SceneStore::history(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto position = scenes_.find(name);
  if (position == scenes_.end()) return std::nullopt;
  return position->second.history;
}

SceneStore::Kept SceneStore::kept(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto position = scenes_.find(name);
  if (position == scenes_.end()) return {};
  return {position->second.newest, position->second.history.revisions()};
}

std::vector<std::shared_ptr<const Snapshot>> SceneStore::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<const Snapshot>> all;
  all.reserve(scenes_.size());
  for (const auto& [name, entry] : scenes_) all.push_back(entry.newest);
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
