// SPDX-License-Identifier: MIT
#include "daemon/scene/scene_change.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace camway::scene {
namespace {

std::uint64_t bytes_of(const SceneChange& change) {
  return change.source ? change.source->memory_bytes() : 0;
}

}  // namespace

SnapshotResult changed(const Snapshot& before, const SceneChange& change, std::uint64_t revision) {
  const SceneObject* old = before.find(change.object);
  if (old == nullptr && change.kind != SceneChange::Kind::kPut) {
    return {nullptr, "object: '" + change.object + "' is not in scene '" + before.name + "'"};
  }
  SceneObjects objects;
  objects.reserve(before.objects.size() + 1);
  std::ranges::copy_if(before.objects, std::back_inserter(objects),
                       [&](const auto& object) { return object->name != change.object; });
  if (change.kind != SceneChange::Kind::kRemove) {
    ObjectResult placed = place_object(change.object, change.source ? change.source : old->source,
                                       change.placement, before.options, old);
    if (!placed.object) return {nullptr, placed.error, placed.limit};
    const auto position = std::ranges::lower_bound(
        objects, change.object, {},
        [](const auto& object) -> const std::string& { return object->name; });
    objects.insert(position, std::move(placed.object));
  }
  return {assemble(before.name, revision, std::move(objects), before.options), ""};
}

SceneHistory::SceneHistory(const Snapshot& first, const Limits& limits)
    : name_(first.name), options_(first.options), limits_(limits), oldest_(first.revision) {
  for (const auto& object : first.objects) {
    before_.put(object->name, {object->source, object->placement});
  }
  newest_ = before_;
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

std::uint64_t SceneHistory::bytes() const {
  return entry_bytes_ + before_.bytes - std::min(before_.bytes, newest_.bytes);
}

void SceneHistory::add(SceneChange change, std::uint64_t revision) {
  entry_bytes_ += bytes_of(change);
  newest_.apply(change);
  entries_.push_back({revision, std::move(change)});
  while (entries_.size() > limits_.changes || bytes() > limits_.bytes) forget_oldest();
}

void SceneHistory::forget_oldest() {
  const Entry& entry = entries_.front();
  before_.apply(entry.change);
  oldest_ = entry.revision;
  entry_bytes_ -= bytes_of(entry.change);
  entries_.pop_front();
}

std::shared_ptr<const Snapshot> SceneHistory::rebuild(std::uint64_t revision) const {
  State state = before_;
  std::uint64_t reached = oldest_;
  for (const Entry& entry : entries_) {
    if (entry.revision > revision) break;
    state.apply(entry.change);
    reached = entry.revision;
  }
  if (reached != revision) return nullptr;
  SceneObjects objects;
  for (const auto& [name, placed] : state.objects) {
    ObjectResult result = place_object(name, placed.source, placed.placement, options_);
    assert(result.object && "it could be placed before");
    objects.push_back(std::move(result.object));
  }
  return assemble(name_, revision, std::move(objects), options_);
}

}  // namespace camway::scene
