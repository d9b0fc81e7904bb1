// SPDX-License-Identifier: MIT
#include "daemon/record/recording_journal.h"

namespace camway::record {

using scene::KeepFault;
using scene::Keeping;

Keeping RecordingJournal::keep_scene(const scene::Snapshot& first, std::uint64_t before,
                                     const scene::ChangeNote& note) {
  Keeping kept = journal_ != nullptr ? journal_->keep_scene(first, before, note) : Keeping{};
  if (kept.fault == KeepFault::kNone) recorder_.scene_put(first, note);
  return kept;
}

Keeping RecordingJournal::keep_changes(const scene::Snapshot& before, const scene::Snapshot& next,
                                       const scene::SceneChanges& changes,
                                       const scene::ChangeNote& note,
                                       std::uint64_t oldest_revision) {
  Keeping kept = journal_ != nullptr
                     ? journal_->keep_changes(before, next, changes, note, oldest_revision)
                     : Keeping{};
  if (kept.fault == KeepFault::kNone) {
    recorder_.scene_changed(before.revision, next, changes, note);
  }
  return kept;
}

Keeping RecordingJournal::keep_removal(const scene::Snapshot& last, const std::string& request) {
  Keeping kept = journal_ != nullptr ? journal_->keep_removal(last, request) : Keeping{};
  if (kept.fault == KeepFault::kNone) recorder_.scene_removed(last);
  return kept;
}

bool RecordingJournal::await_other(const std::string& scene, std::uint64_t revision) {
  return journal_ != nullptr && journal_->await_other(scene, revision);
}

}  // namespace camway::record
