// SPDX-License-Identifier: MIT
#include "daemon/scene/log/durable_scenes.h"

#include <algorithm>
#include <set>
#include <utility>

namespace camway::scene {
namespace {

/// Entries of a scene that a summary replaces. A start reads each of them.
constexpr std::size_t kEntriesPerSummary = 256;

Keeping not_kept(AppendResult appended) {
  switch (appended.fault) {
    case AppendFault::kNone:
      return {};
    case AppendFault::kConflict:
      return {KeepFault::kOutrun, std::move(appended.error)};
    case AppendFault::kFull:
      return {KeepFault::kFull, std::move(appended.error)};
    case AppendFault::kBroken:
      break;
  }
  return {KeepFault::kBroken, std::move(appended.error)};
}

/// The same for contents, without which no change is sent.
Keeping not_sent(AppendResult kept) {
  kept.error += "; nothing was changed";
  return not_kept(std::move(kept));
}

}  // namespace

DurableScenes::DurableScenes(SceneLog& log, std::chrono::milliseconds patience)
    : log_(log), patience_(patience), sources_(log) {
  log_.on_lost_blob([this](const BlobId& id) { return sources_.blob_again(id); });
}

DurableScenes::~DurableScenes() { log_.on_lost_blob({}); }

base::Result<std::vector<SceneHistory>> DurableScenes::load(const SceneHistory::Limits& limits) {
  const base::Result<std::vector<LoggedScene>> logged = log_.scenes();
  if (!logged) return base::Failure{logged.error};
  std::vector<SceneHistory> histories;
  std::string faults;
  for (const LoggedScene& scene : *logged) {
    base::Result<SceneHistory> history = load_scene(scene, limits);
    if (history) {
      histories.push_back(*std::move(history));
    } else {
      faults += (faults.empty() ? "" : "; ") + history.error;
    }
  }
  if (!faults.empty()) return base::Failure{std::move(faults)};
  return histories;
}

base::Result<SceneHistory> DurableScenes::load_scene(const LoggedScene& logged,
                                                     const SceneHistory::Limits& limits) {
  base::Result<RecordedScene> scene = recorded_scene_of(logged);
  if (!scene) return base::Failure{std::move(scene.error)};
  if (!has_mirrors_) scene->options.occupancy_resolution_m.reset();
  base::Result<SceneHistory> history = history_of(logged.name, *scene, limits);
  if (!history) return damaged_scene(logged.name, history.error);
  note_newest(logged.name, scene->newest_revision());
  kept_of(logged.name) = {*std::move(scene), logged.entries.size()};
  return history;
}

base::Result<SceneHistory> DurableScenes::history_of(const std::string& name,
                                                     const RecordedScene& scene,
                                                     const SceneHistory::Limits& limits) {
  SourceBlobs::Read read;
  sources_.read_whole(scene.needs(), scene.options, read);
  std::vector<PlacedSource> objects;
  std::set<std::string> names;
  for (const RecordedObject& object : scene.objects) {
    auto source = sources_.read(object.source, scene.options, read);
    if (!source) return base::Failure{"object '" + object.name + "': " + source.error};
    objects.push_back({object.name, *std::move(source), object.placement});
    names.insert(object.name);
  }
  SceneHistory history(name, scene.options, objects, scene.oldest, limits);
  for (const RecordedRevision& revision : scene.revisions) {
    SceneChanges changes;
    for (const RecordedChange& change : revision.changes) {
      std::shared_ptr<const ObjectSource> source;
      if (change.source) {
        auto found = sources_.read(*change.source, scene.options, read);
        if (!found) return base::Failure{"object '" + change.object + "': " + found.error};
        source = *std::move(found);
        names.insert(change.object);
      } else if (!names.contains(change.object)) {
        return base::Failure{"a change of object '" + change.object + "', which it has not"};
      }
      if (change.kind == SceneChange::Kind::kRemove) names.erase(change.object);
      changes.push_back({change.kind, change.object, std::move(source), change.placement});
    }
    history.add(std::move(changes), revision.made);
  }
  return history;
}

DurableScenes::Kept& DurableScenes::kept_of(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return kept_[name];
}

void DurableScenes::forget(const std::string& name) {
  const std::lock_guard lock(mutex_);
  kept_.erase(name);
}

void DurableScenes::note_newest(const std::string& name, std::uint64_t revision) {
  {
    const std::lock_guard lock(mutex_);
    newest_[name] = revision;
  }
  arrived_.notify_all();
}

Keeping DurableScenes::keep_scene(const Snapshot& first, std::uint64_t before,
                                  const ChangeNote& note) {
  RecordedScene scene{first.options, {first.revision, note}, {}, {}};
  {
    const std::shared_lock using_blobs(blobs_in_use_);
    for (const auto& object : first.objects) {
      RecordedObject& recorded = scene.objects.emplace_back();
      recorded.name = object->name;
      recorded.placement = object->placement;
      AppendResult kept = sources_.keep(object->source, nullptr, recorded.source);
      if (kept.fault != AppendFault::kNone) return not_sent(std::move(kept));
    }
    AppendResult appended =
        log_.append(first.name, {before, first.revision, change_record_of(scene), scene.needs()});
    if (appended.fault != AppendFault::kNone) return not_kept(std::move(appended));
  }
  note_newest(first.name, first.revision);
  Kept& kept = kept_of(first.name);
  kept.scene = std::move(scene);
  // The entries before are of no use any more.
  kept.entries += before > 0 ? kEntriesPerSummary : 1;
  summarize(first.name, kept, first.revision);
  return {};
}

AppendResult DurableScenes::record(const SceneChange& change, const Snapshot& before,
                                   RecordedChange& record) {
  record = {change.kind, change.object, std::nullopt, change.placement};
  if (change.kind != SceneChange::Kind::kPut) return {};
  const SceneObject* const replaced = before.find(change.object);
  return sources_.keep(change.source, replaced != nullptr ? replaced->source : nullptr,
                       record.source.emplace());
}

Keeping DurableScenes::keep_changes(const Snapshot& before, const Snapshot& next,
                                    const SceneChanges& changes, const ChangeNote& note,
                                    std::uint64_t oldest_revision) {
  RecordedRevision revision{{next.revision, note}, {}};
  {
    const std::shared_lock using_blobs(blobs_in_use_);
    std::vector<BlobId> needs;
    for (const SceneChange& change : changes) {
      RecordedChange& recorded = revision.changes.emplace_back();
      AppendResult kept = record(change, before, recorded);
      if (kept.fault != AppendFault::kNone) return not_sent(std::move(kept));
      if (recorded.source) needs.push_back(*recorded.source);
    }
    AppendResult appended =
        log_.append(before.name,
                    {before.revision, next.revision, change_record_of(revision), std::move(needs)});
    if (appended.fault != AppendFault::kNone) return not_kept(std::move(appended));
  }
  note_newest(before.name, next.revision);
  Kept& kept = kept_of(before.name);
  kept.scene.revisions.push_back(std::move(revision));
  ++kept.entries;
  summarize(before.name, kept, oldest_revision);
  return {};
}

void DurableScenes::summarize(const std::string& name, Kept& kept, std::uint64_t oldest_revision) {
  if (kept.entries < kEntriesPerSummary && !log_.lacks_blobs_of(name)) return;
  kept.scene.forget_before(oldest_revision);
  const AppendResult done = log_.summarize(name, kept.scene.newest_revision(),
                                           change_record_of(kept.scene), kept.scene.needs());
  // The entries are still there if this failed; the next change tries again.
  if (!done.error.empty()) return;
  kept.entries = 0;
  const std::unique_lock alone(blobs_in_use_);
  log_.drop_unused_blobs();
  sources_.forget_unused();
}

Keeping DurableScenes::keep_removal(const Snapshot& last, const std::string& request) {
  AppendResult removed = log_.remove(last.name, last.revision, request);
  if (removed.fault != AppendFault::kNone) return not_kept(std::move(removed));
  note_newest(last.name, 0);
  forget(last.name);
  const std::unique_lock alone(blobs_in_use_);
  log_.drop_unused_blobs();
  return {};
}

bool DurableScenes::await_other(const std::string& scene, std::uint64_t revision) {
  std::unique_lock lock(mutex_);
  return arrived_.wait_for(lock, patience_, [&] {
    const auto found = newest_.find(scene);
    return (found == newest_.end() ? 0 : found->second) != revision;
  });
}

base::Result<SceneStore::OthersWork> DurableScenes::read(const LogUpdate& update,
                                                         const Snapshot* newest,
                                                         const SceneHistory::Limits& limits) {
  using Work = base::Result<SceneStore::OthersWork>;
  const std::uint64_t known = newest != nullptr ? newest->revision : 0;
  const std::uint64_t revision = update.entry.revision;
  if (update.kind == LogUpdate::Kind::kRemoval) {
    if (newest == nullptr || known > revision) return Work(std::monostate());
    note_newest(update.scene, 0);
    forget(update.scene);
    return Work(SceneStore::OthersRemoval());
  }
  const bool is_summary = update.kind == LogUpdate::Kind::kSummary;
  if (revision < known || (revision == known && !is_summary)) return Work(std::monostate());
  base::Result<ChangeRecord> record = change_record_from(update.entry.record);
  if (!record) return damaged_scene(update.scene, record.error);
  if (auto* const scene = std::get_if<RecordedScene>(&*record)) {
    return read_scene(update, std::move(*scene), known, limits);
  }
  if (newest == nullptr || update.entry.before != known) {
    return damaged_scene(update.scene, "revision " + std::to_string(revision) +
                                           " was made of revision " +
                                           std::to_string(update.entry.before) + ", but revision " +
                                           std::to_string(known) + " is the newest here");
  }
  return read_revision(update, std::get<RecordedRevision>(*std::move(record)), *newest);
}

base::Result<SceneStore::OthersWork> DurableScenes::read_scene(const LogUpdate& update,
                                                               RecordedScene scene,
                                                               std::uint64_t known,
                                                               const SceneHistory::Limits& limits) {
  using Work = base::Result<SceneStore::OthersWork>;
  const std::uint64_t revision = scene.newest_revision();
  if (revision != update.entry.revision) {
    return damaged_scene(update.scene, "a record is of another revision");
  }
  if (!has_mirrors_) scene.options.occupancy_resolution_m.reset();
  std::optional<SceneHistory> history;
  if (revision > known) {
    base::Result<SceneHistory> made = history_of(update.scene, scene, limits);
    if (!made) return damaged_scene(update.scene, made.error);
    history = *std::move(made);
  }
  // A summary replaces the entries, of whichever process they are.
  kept_of(update.scene) = {std::move(scene), 0};
  sources_.forget_unused();
  if (!history) return Work(std::monostate());
  note_newest(update.scene, revision);
  return Work(*std::move(history));
}

base::Result<SceneStore::OthersWork> DurableScenes::read_revision(const LogUpdate& update,
                                                                  RecordedRevision revision,
                                                                  const Snapshot& newest) {
  Kept& kept = kept_of(update.scene);
  SourceBlobs::Read read;
  SceneChanges changes;
  for (const RecordedChange& change : revision.changes) {
    // The content after a scan is a difference from the one before.
    const SceneObject* const replaced = newest.find(change.object);
    if (replaced != nullptr) sources_.add_known(replaced->source, read);
    std::shared_ptr<const ObjectSource> source;
    if (change.source) {
      auto found = sources_.read(*change.source, kept.scene.options, read);
      if (!found) {
        return damaged_scene(update.scene, "object '" + change.object + "': " + found.error);
      }
      source = *std::move(found);
    }
    changes.push_back({change.kind, change.object, std::move(source), change.placement});
  }
  KeptRevision made = revision.made;
  kept.scene.revisions.push_back(std::move(revision));
  ++kept.entries;
  note_newest(update.scene, made.revision);
  return base::Result<SceneStore::OthersWork>(
      SceneStore::OthersChanges{std::move(changes), std::move(made)});
}

}  // namespace camway::scene
