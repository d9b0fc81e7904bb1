// SPDX-License-Identifier: MIT
#include "daemon/scene/log/durable_scenes.h"

#include <algorithm>
#include <set>
#include <utility>

namespace camway::scene {
namespace {

/// Entries of a scene that a summary replaces. A start reads each of them.
constexpr std::size_t kEntriesPerSummary = 256;

}  // namespace

base::Result<std::vector<SceneHistory>> DurableScenes::load(const SceneHistory::Limits& limits) {
  const base::Result<std::vector<LoggedScene>> logged = log_.scenes();
  if (!logged) return base::Failure{logged.error};
  std::vector<SceneHistory> histories;
  for (const LoggedScene& scene : *logged) {
    base::Result<SceneHistory> history = load_scene(scene, limits);
    if (!history) return base::Failure{std::move(history.error)};
    histories.push_back(*std::move(history));
  }
  return histories;
}

base::Result<SceneHistory> DurableScenes::load_scene(const LoggedScene& logged,
                                                     const SceneHistory::Limits& limits) {
  base::Result<RecordedScene> scene = recorded_scene_of(logged);
  if (!scene) return base::Failure{std::move(scene.error)};
  base::Result<SceneHistory> history = history_of(logged.name, *scene, limits);
  if (!history) return damaged_scene(logged.name, history.error);
  kept_[logged.name] = {*std::move(scene), logged.entries.size()};
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
    if (!source) return base::Failure{std::move(source.error)};
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
        if (!found) return base::Failure{std::move(found.error)};
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

std::string DurableScenes::keep_scene(const Snapshot& first, std::uint64_t before,
                                      const ChangeNote& note) {
  RecordedScene scene{first.options, {first.revision, note}, {}, {}};
  {
    const std::shared_lock using_blobs(blobs_in_use_);
    for (const auto& object : first.objects) {
      base::Result<BlobId> id = sources_.keep(object->source, nullptr);
      if (!id) return std::move(id.error);
      scene.objects.push_back({object->name, *id, object->placement});
    }
    AppendResult appended =
        log_.append(first.name, {before, first.revision, change_record_of(scene), scene.needs()});
    if (!appended.error.empty()) return std::move(appended.error);
  }
  Kept& kept = kept_of(first.name);
  kept.scene = std::move(scene);
  // The entries before are of no use any more.
  kept.entries += before > 0 ? kEntriesPerSummary : 1;
  summarize(first.name, kept, first.revision);
  return {};
}

base::Result<RecordedChange> DurableScenes::recorded(const SceneChange& change,
                                                     const Snapshot& before) {
  RecordedChange record{change.kind, change.object, std::nullopt, change.placement};
  if (change.kind != SceneChange::Kind::kPut) return record;
  const SceneObject* const replaced = before.find(change.object);
  base::Result<BlobId> id =
      sources_.keep(change.source, replaced != nullptr ? replaced->source : nullptr);
  if (!id) return base::Failure{std::move(id.error)};
  record.source = *id;
  return record;
}

std::string DurableScenes::keep_changes(const Snapshot& before, const Snapshot& next,
                                        const SceneChanges& changes, const ChangeNote& note,
                                        std::uint64_t oldest_revision) {
  RecordedRevision revision{{next.revision, note}, {}};
  {
    const std::shared_lock using_blobs(blobs_in_use_);
    std::vector<BlobId> needs;
    for (const SceneChange& change : changes) {
      base::Result<RecordedChange> record = recorded(change, before);
      if (!record) return std::move(record.error);
      if (record->source) needs.push_back(*record->source);
      revision.changes.push_back(*std::move(record));
    }
    AppendResult appended =
        log_.append(before.name,
                    {before.revision, next.revision, change_record_of(revision), std::move(needs)});
    if (!appended.error.empty()) return std::move(appended.error);
  }
  Kept& kept = kept_of(before.name);
  kept.scene.revisions.push_back(std::move(revision));
  ++kept.entries;
  summarize(before.name, kept, oldest_revision);
  return {};
}

void DurableScenes::summarize(const std::string& name, Kept& kept, std::uint64_t oldest_revision) {
  if (kept.entries < kEntriesPerSummary) return;
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

std::string DurableScenes::keep_removal(const Snapshot& last) {
  AppendResult removed = log_.remove(last.name, last.revision);
  if (!removed.error.empty()) return std::move(removed.error);
  {
    const std::lock_guard lock(mutex_);
    kept_.erase(last.name);
  }
  const std::unique_lock alone(blobs_in_use_);
  log_.drop_unused_blobs();
  return {};
}

}  // namespace camway::scene
