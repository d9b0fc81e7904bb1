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

/// Requires a fault.
StoreResult result_of(Keeping keeping) {
  const StoreFault fault = keeping.fault == KeepFault::kOutrun ? StoreFault::kOutrun
                           : keeping.fault == KeepFault::kFull ? StoreFault::kFull
                                                               : StoreFault::kNotKept;
  return {nullptr, fault, std::move(keeping.error)};
}

/// How long a change is made anew because other processes outrun it. Each time one of them has made
/// a change, so all together never stand still.
constexpr std::chrono::seconds kOutrunPatience{30};

/// Requests of removals that are remembered, about as many as changes of one scene.
constexpr std::size_t kMostRemovals = 1024;

}  // namespace

SceneStore::ChangeLock::ChangeLock(SceneStore& store, std::string_view scene) : store_(store) {
  std::unique_lock lock(store_.mutex_);
  store_.change_ended_.wait(lock, [&] { return !store_.changing_.contains(scene); });
  scene_ = store_.changing_.emplace(scene).first;
}

SceneStore::ChangeLock::~ChangeLock() {
  {
    const std::lock_guard lock(store_.mutex_);
    store_.changing_.erase(scene_);
  }
  store_.change_ended_.notify_all();
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

StoreResult SceneStore::not_kept(const Snapshot& next, const Usage& usage, Keeping keeping) {
  const std::lock_guard lock(mutex_);
  count(usage, usage_before(next.name));
  return result_of(std::move(keeping));
}

StoreResult SceneStore::until_not_outrun(std::string_view scene,
                                         const std::function<StoreResult()>& attempt) {
  const auto end = std::chrono::steady_clock::now() + kOutrunPatience;
  while (true) {
    const std::shared_ptr<const Snapshot> before = find(scene);
    StoreResult result = attempt();
    if (result.fault != StoreFault::kOutrun) return result;
    const bool can_go_on = std::chrono::steady_clock::now() < end &&
                           journal_->await_other(std::string(scene), before ? before->revision : 0);
    if (!can_go_on) return {nullptr, StoreFault::kNotKept, std::move(result.error)};
  }
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
  return until_not_outrun(snapshot->name, [&] { return put_once(snapshot, note, ticket); });
}

StoreResult SceneStore::put_once(std::shared_ptr<const Snapshot> snapshot, ChangeNote note,
                                 const ChangeTicket& ticket) {
  note.when = std::chrono::system_clock::now();
  const ChangeLock lock(*this, snapshot->name);
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
    Keeping keeping = journal_->keep_scene(*snapshot, before ? before->revision : 0, note);
    if (keeping.fault != KeepFault::kNone) return not_kept(*snapshot, usage, std::move(keeping));
  }
  SceneHistory history(*snapshot, limits_.history, std::move(note));
  return publish({std::move(snapshot), usage, std::move(history)});
}

StoreResult SceneStore::adopt(SceneHistory history) {
  const std::string name = history.name();
  const ChangeLock lock(*this, name);
  return take(name, std::move(history));
}

StoreResult SceneStore::take(const std::string&, SceneHistory history) {
  std::shared_ptr<const Snapshot> newest = history.rebuild(history.newest_revision());
  if (newest == nullptr) {
    return {nullptr, StoreFault::kInvalid,
            "scene '" + history.name() + "': an object cannot be placed where it is said to be"};
  }
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
  const auto same = [&](const Snapshot&) { return MadeChange{change}; };
  return this->change(scene, ChangeMaker(same), std::move(note), ticket);
}

StoreResult SceneStore::change(std::string_view scene, const ChangeMaker& make, ChangeNote note,
                               const ChangeTicket& ticket) {
  return until_not_outrun(scene, [&] { return change_once(scene, make, note, ticket); });
}

StoreResult SceneStore::change_once(std::string_view scene, const ChangeMaker& make,
                                    const ChangeNote& note, const ChangeTicket& ticket) {
  const ChangeLock lock(*this, scene);
  const std::shared_ptr<const Snapshot> before = find(scene);
  if (!before) return unknown(scene);
  if (changed_by(scene, note.request)) return {before, StoreFault::kNone, ""};
  MadeChange made = make(*before);
  if (ticket.is_cancelled()) return cancelled();
  if (!made.change) {
    const bool is_limit = made.limit != Limit::kNone;
    return {nullptr, is_limit ? StoreFault::kLimit : StoreFault::kInvalid, std::move(made.error),
            made.limit};
  }
  return make_next(*before, {*std::move(made.change)}, note, ticket);
}

StoreResult SceneStore::restore(std::string_view scene, std::uint64_t revision, ChangeNote note,
                                const ChangeTicket& ticket) {
  return until_not_outrun(scene, [&] { return restore_once(scene, revision, note, ticket); });
}

StoreResult SceneStore::restore_once(std::string_view scene, std::uint64_t revision,
                                     ChangeNote note, const ChangeTicket& ticket) {
  const ChangeLock lock(*this, scene);
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
    Keeping keeping = journal_->keep_changes(before, next, changes, note, oldest_kept(before));
    if (keeping.fault != KeepFault::kNone) return not_kept(next, usage, std::move(keeping));
  }
  return publish_changes(std::move(result.snapshot), usage, std::move(changes), std::move(note));
}

StoreResult SceneStore::publish_changes(std::shared_ptr<const Snapshot> next, const Usage& usage,
                                        SceneChanges changes, ChangeNote note) {
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = scenes_.find(next->name)->second;
    entry.newest = next;
    entry.usage = usage;
    entry.history.add(std::move(changes), {next->revision, std::move(note)});
    forget_history();
  }
  notify();
  return {std::move(next), StoreFault::kNone, ""};
}

StoreResult SceneStore::follow(
    const std::string& scene,
    const std::function<base::Result<OthersWork>(const Snapshot* newest)>& read) {
  const ChangeLock lock(*this, scene);
  base::Result<OthersWork> work = read(find(scene).get());
  if (!work) return {nullptr, StoreFault::kInvalid, std::move(work.error)};
  return std::visit([&](auto&& kind) { return take(scene, std::move(kind)); }, *std::move(work));
}

StoreResult SceneStore::take(const std::string& scene, OthersChanges work) {
  const std::shared_ptr<const Snapshot> before = find(scene);
  if (!before) return unknown(scene);
  SnapshotResult next = changed(*before, work.changes, work.made.revision);
  if (!next.snapshot) return {nullptr, StoreFault::kInvalid, std::move(next.error), next.limit};
  const Usage usage = usage_of(*next.snapshot);
  if (std::optional<StoreResult> fault = reserve(*next.snapshot, usage, {})) return *fault;
  return publish_changes(std::move(next.snapshot), usage, std::move(work.changes),
                         std::move(work.made.note));
}

StoreResult SceneStore::take(const std::string& scene, OthersRemoval) {
  const std::shared_ptr<const Snapshot> last = find(scene);
  if (!last) return unknown(scene);
  take_out(scene, last->revision);
  return {last, StoreFault::kNone, ""};
}

StoreResult SceneStore::take(const std::string& scene, std::monostate) {
  return {find(scene), StoreFault::kNone, ""};
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

StoreResult SceneStore::remove(std::string_view scene, const ChangeTicket& ticket,
                               const std::string& request) {
  return until_not_outrun(scene, [&] { return remove_once(scene, ticket, request); });
}

StoreResult SceneStore::remove_once(std::string_view scene, const ChangeTicket& ticket,
                                    const std::string& request) {
  const ChangeLock lock(*this, scene);
  // There may be a new scene of that name.
  if (removed_by(request)) return {};
  const std::shared_ptr<const Snapshot> last = find(scene);
  if (!last) return unknown(scene);
  if (!ticket.try_commit()) return cancelled();
  if (journal_ != nullptr) {
    Keeping keeping = journal_->keep_removal(*last, request);
    if (keeping.fault != KeepFault::kNone) return result_of(std::move(keeping));
  }
  if (!request.empty()) remember_removals({request});
  take_out(scene, last->revision);
  return {last, StoreFault::kNone, ""};
}

bool SceneStore::removed_by(const std::string& request) const {
  const std::lock_guard lock(mutex_);
  return !request.empty() && std::ranges::count(removals_, request) > 0;
}

void SceneStore::remember_removals(const std::vector<std::string>& requests) {
  const std::lock_guard lock(mutex_);
  for (const std::string& request : requests) {
    if (std::ranges::count(removals_, request) > 0) continue;
    removals_.push_back(request);
    if (removals_.size() > kMostRemovals) removals_.pop_front();
  }
}

void SceneStore::take_out(std::string_view scene, std::uint64_t last_revision) {
  std::optional<Entry> old;  // destroyed after the lock is released, since that takes time
  {
    const std::lock_guard lock(mutex_);
    const auto found = scenes_.find(scene);
    highest_removed_ = std::max(highest_removed_, last_revision);
    old = std::move(found->second);
    count(old->usage, {});
    scenes_.erase(found);
  }
  notify();
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
