// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "daemon/scene/snapshot/scene_journal.h"
#include "daemon/service/log/limited_log.h"

namespace camway::process {

/// A journal that logs a warning when another one, which does the work, cannot keep a change.
/// Thread-safe, as `SceneJournal` demands.
class WarningJournal : public scene::SceneJournal {
 public:
  /// Refers to `journal`, which must outlive it.
  WarningJournal(scene::SceneJournal& journal, const std::shared_ptr<service::Log>& log)
      : journal_(journal),
        warnings_(log, service::LogLevel::kWarn, "changes that are not kept", {}) {}

  scene::Keeping keep_scene(const scene::Snapshot& first, std::uint64_t before,
                            const scene::ChangeNote& note) override;
  scene::Keeping keep_changes(const scene::Snapshot& before, const scene::Snapshot& next,
                              const scene::SceneChanges& changes, const scene::ChangeNote& note,
                              std::uint64_t oldest_revision) override;
  scene::Keeping keep_removal(const scene::Snapshot& last, const std::string& request) override;
  bool await_other(const std::string& scene, std::uint64_t revision) override;
  bool catch_up() override;

 private:
  scene::Keeping warned(const std::string& scene, scene::Keeping keeping);

  scene::SceneJournal& journal_;
  std::mutex mutex_;  ///< guards warnings_
  service::LimitedLog warnings_;
};

}  // namespace camway::process
