// SPDX-License-Identifier: MIT
#include "daemon/process/warning_journal.h"

#include <utility>

namespace camway::process {

scene::Keeping WarningJournal::warned(const std::string& scene, scene::Keeping keeping) {
  if (keeping.fault == scene::KeepFault::kFull || keeping.fault == scene::KeepFault::kBroken) {
    const std::lock_guard lock(mutex_);
    warnings_.write("a change of a scene cannot be kept, and is not made",
                    {{"scene", scene}, {"reason", keeping.error}});
  }
  return keeping;
}

scene::Keeping WarningJournal::keep_scene(const scene::Snapshot& first, std::uint64_t before,
                                          const scene::ChangeNote& note) {
  return warned(first.name, journal_.keep_scene(first, before, note));
}

scene::Keeping WarningJournal::keep_changes(const scene::Snapshot& before,
                                            const scene::Snapshot& next,
                                            const scene::SceneChanges& changes,
                                            const scene::ChangeNote& note,
                                            std::uint64_t oldest_revision) {
  return warned(before.name, journal_.keep_changes(before, next, changes, note, oldest_revision));
}

scene::Keeping WarningJournal::keep_removal(const scene::Snapshot& last,
                                            const std::string& request) {
  return warned(last.name, journal_.keep_removal(last, request));
}

bool WarningJournal::await_other(const std::string& scene, std::uint64_t revision) {
  return journal_.await_other(scene, revision);
}

bool WarningJournal::catch_up() { return journal_.catch_up(); }

}  // namespace camway::process
