// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/record/recorder.h"
#include "daemon/scene/snapshot/scene_journal.h"

namespace camway::record {

/// A journal that records the changes which another one keeps.
/// Thread-safe, as `SceneJournal` demands.
class RecordingJournal final : public scene::SceneJournal {
 public:
  /// Both must outlive this. `journal` may be null: then nothing else keeps the changes.
  RecordingJournal(scene::SceneJournal* journal, Recorder& recorder)
      : journal_(journal), recorder_(recorder) {}

  scene::Keeping keep_scene(const scene::Snapshot& first, std::uint64_t before,
                            const scene::ChangeNote& note) override;
  scene::Keeping keep_changes(const scene::Snapshot& before, const scene::Snapshot& next,
                              const scene::SceneChanges& changes, const scene::ChangeNote& note,
                              std::uint64_t oldest_revision) override;
  scene::Keeping keep_removal(const scene::Snapshot& last, const std::string& request) override;
  bool await_other(const std::string& scene, std::uint64_t revision) override;
  bool catch_up() override { return journal_ != nullptr && journal_->catch_up(); }

 private:
  scene::SceneJournal* const journal_;
  Recorder& recorder_;
};

}  // namespace camway::record
