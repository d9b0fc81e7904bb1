// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/scene_change.h"

#include <algorithm>
#include <utility>

#include "daemon/base/parallel_chunks.h"

namespace camway::scene {
namespace {

SceneObjects::iterator place_of(const std::string& name, SceneObjects& objects) {
  return std::ranges::lower_bound(
      objects, name, {}, [](const auto& object) -> const std::string& { return object->name; });
}

/// Applies the change to `objects`. Returns the fault; without an error if there is none.
SnapshotResult apply(const SceneChange& change, const Snapshot& before, const std::stop_token& stop,
                     SceneObjects& objects) {
  const auto place = place_of(change.object, objects);
  const bool is_there = place != objects.end() && (*place)->name == change.object;
  if (!is_there && change.kind != SceneChange::Kind::kPut) {
    return {nullptr, "object: '" + change.object + "' is not in scene '" + before.name + "'"};
  }
  if (change.kind == SceneChange::Kind::kRemove) {
    objects.erase(place);
    return {};
  }
  ObjectResult placed =
      place_object(change.object, change.source ? change.source : (*place)->source,
                   change.placement, before.options, is_there ? place->get() : nullptr, stop);
  if (!placed.object) return {nullptr, placed.error, placed.limit};
  if (is_there) {
    *place = std::move(placed.object);
  } else {
    objects.insert(place, std::move(placed.object));
  }
  return {};
}

}  // namespace

SnapshotResult changed(const Snapshot& before, const SceneChanges& changes, std::uint64_t revision,
                       const std::stop_token& stop) {
  SceneObjects objects = before.objects;
  for (const SceneChange& change : changes) {
    SnapshotResult fault = apply(change, before, stop, objects);
    if (!fault.error.empty()) return fault;
  }
  return {assemble(before.name, revision, std::move(objects), before.options), ""};
}

SnapshotResult changed(const Snapshot& before, const SceneChange& change, std::uint64_t revision,
                       const std::stop_token& stop) {
  return changed(before, SceneChanges{change}, revision, stop);
}

std::vector<PlacedSource> placed_sources_of(const Snapshot& snapshot) {
  std::vector<PlacedSource> objects;
  for (const auto& object : snapshot.objects) {
    objects.push_back({object->name, object->source, object->placement});
  }
  return objects;
}

SceneHistory::SceneHistory(const Snapshot& first, const Limits& limits, ChangeNote note)
    : SceneHistory(first.name, first.options, placed_sources_of(first),
                   {first.revision, std::move(note)}, limits) {}

SceneHistory::SceneHistory(std::string name, const ObjectOptions& options,
                           const std::vector<PlacedSource>& objects, KeptRevision oldest,
                           const Limits& limits)
    : name_(std::move(name)), options_(options), limits_(limits), oldest_(std::move(oldest)) {
  for (const PlacedSource& object : objects) {
    before_.put(object.name, {object.source, object.placement});
  }
  newest_ = before_;
}

bool SceneHistory::has_request(const std::string& request) const {
  if (request.empty()) return false;
  return oldest_.note.request == request || std::ranges::any_of(entries_, [&](const Entry& entry) {
           return entry.made.note.request == request;
         });
}

void SceneHistory::State::put(std::string_view name, const Placed& placed) {
  remove(name);
  objects.emplace(name, placed);
  bytes += placed.source->memory_bytes();
}

void SceneHistory::State::remove(std::string_view name) {
  const auto found = objects.find(name);
  if (found == objects.end()) return;
  bytes -= found->second.source->memory_bytes();
  objects.erase(found);
}

void SceneHistory::State::apply(const SceneChange& change) {
  switch (change.kind) {
    case SceneChange::Kind::kPut:
      put(change.object, {change.source, change.placement});
      break;
    case SceneChange::Kind::kMove:
      objects.find(change.object)->second.placement = change.placement;
      break;
    case SceneChange::Kind::kRemove:
      remove(change.object);
      break;
  }
}

void SceneHistory::State::apply(const SceneChanges& changes) {
  for (const SceneChange& change : changes) apply(change);
}

// The sources of the newest revision are at most those of the oldest one plus what each change
// brought beyond the predecessors of its objects. So the difference is never below 0.
std::uint64_t SceneHistory::bytes() const { return before_.bytes + entry_bytes_ - newest_.bytes; }

std::uint64_t SceneHistory::bytes_beside(const SceneChange& change) const {
  if (!change.source) return 0;
  const auto found = newest_.objects.find(change.object);
  return found == newest_.objects.end() ? change.source->memory_bytes()
                                        : change.source->memory_bytes_beside(*found->second.source);
}

void SceneHistory::add(SceneChanges changes, KeptRevision made) {
  Entry entry{std::move(made), std::move(changes)};
  for (const SceneChange& change : entry.changes) {
    entry.bytes += bytes_beside(change);
    newest_.apply(change);
  }
  entry_bytes_ += entry.bytes;
  entries_.push_back(std::move(entry));
  while (entries_.size() > limits_.changes || bytes() > limits_.bytes) forget_oldest();
}

void SceneHistory::forget_oldest() {
  Entry& entry = entries_.front();
  before_.apply(entry.changes);
  oldest_ = std::move(entry.made);
  entry_bytes_ -= entry.bytes;
  entries_.pop_front();
}

std::vector<KeptRevision> SceneHistory::revisions() const {
  std::vector<KeptRevision> all{oldest_};
  for (const Entry& entry : entries_) all.push_back(entry.made);
  return all;
}

std::optional<SceneHistory::State> SceneHistory::state_at(std::uint64_t revision) const {
  State state = before_;
  std::uint64_t reached = oldest_.revision;
  for (const Entry& entry : entries_) {
    if (entry.made.revision > revision) break;
    state.apply(entry.changes);
    reached = entry.made.revision;
  }
  return reached == revision ? std::optional(std::move(state)) : std::nullopt;
}

std::optional<SceneChanges> SceneHistory::changes_back_to(std::uint64_t revision) const {
  const std::optional<State> then = state_at(revision);
  if (!then) return std::nullopt;
  SceneChanges changes;
  for (const auto& [name, now] : newest_.objects) {
    if (!then->objects.contains(name)) {
      changes.push_back({SceneChange::Kind::kRemove, name, nullptr, {}});
    }
  }
  for (const auto& [name, placed] : then->objects) {
    const auto now = newest_.objects.find(name);
    if (now == newest_.objects.end() || now->second.source != placed.source) {
      changes.push_back({SceneChange::Kind::kPut, name, placed.source, placed.placement});
    } else if (!(now->second.placement == placed.placement)) {
      changes.push_back({SceneChange::Kind::kMove, name, nullptr, placed.placement});
    }
  }
  return changes;
}

std::shared_ptr<const Snapshot> SceneHistory::rebuild(std::uint64_t revision,
                                                      const std::stop_token& stop) const {
  const std::optional<State> state = state_at(revision);
  if (!state) return nullptr;
  std::vector<const std::pair<const std::string, Placed>*> all;
  for (const auto& object : state->objects) all.push_back(&object);
  SceneObjects objects(all.size());
  base::for_each_chunk(base::chunk_threads(0), all.size(), [&](unsigned, std::size_t i) {
    const auto& [name, placed] = *all[i];
    objects[i] =
        place_object(name, placed.source, placed.placement, options_, nullptr, stop).object;
  });
  if (stop.stop_requested()) return nullptr;
  // Only a damaged record has objects that cannot be placed: a store placed its own before.
  if (std::ranges::find(objects, nullptr) != objects.end()) return nullptr;
  return assemble(name_, revision, std::move(objects), options_);
}

}  // namespace camway::scene
