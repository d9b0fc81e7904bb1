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
                                       change.placement, before.options);
    if (!placed.object) return {nullptr, placed.error};
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
    state_.insert_or_assign(object->name, Placed{object->source, object->placement});
  }
}

void SceneHistory::apply(const SceneChange& change, State& state) {
  switch (change.kind) {
    case SceneChange::Kind::kPut:
      state.insert_or_assign(change.object, Placed{change.source, change.placement});
      break;
    case SceneChange::Kind::kMove:
      state.find(change.object)->second.placement = change.placement;
      break;
    case SceneChange::Kind::kRemove:
      state.erase(change.object);
      break;
  }
}

void SceneHistory::add(SceneChange change, std::uint64_t revision) {
  bytes_ += bytes_of(change);
  entries_.push_back({revision, std::move(change)});
  while (entries_.size() > limits_.changes || (bytes_ > limits_.bytes && !entries_.empty())) {
    forget_oldest();
  }
}

void SceneHistory::forget_oldest() {
  const Entry& entry = entries_.front();
  apply(entry.change, state_);
  oldest_ = entry.revision;
  bytes_ -= bytes_of(entry.change);
  entries_.pop_front();
}

std::shared_ptr<const Snapshot> SceneHistory::rebuild(std::uint64_t revision) const {
  State state = state_;
  std::uint64_t reached = oldest_;
  for (const Entry& entry : entries_) {
    if (entry.revision > revision) break;
    apply(entry.change, state);
    reached = entry.revision;
  }
  if (reached != revision) return nullptr;
  SceneObjects objects;
  for (const auto& [name, placed] : state) {
    ObjectResult result = place_object(name, placed.source, placed.placement, options_);
    assert(result.object && "it could be placed before");
    objects.push_back(std::move(result.object));
  }
  return assemble(name_, revision, std::move(objects), options_);
}

}  // namespace camway::scene
