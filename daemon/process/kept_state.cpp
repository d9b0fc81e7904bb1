// SPDX-License-Identifier: MIT
#include "daemon/process/kept_state.h"

#include <utility>
#include <vector>

namespace camway::process {

base::Result<std::unique_ptr<KeptState>> KeptState::open(const StateOptions& options) {
  base::Result<std::unique_ptr<scene::SqliteLog>> log =
      scene::SqliteLog::open(options.folder, {.most_bytes = options.most_bytes});
  if (!log) return base::Failure{std::move(log.error)};
  return std::make_unique<KeptState>(options.folder, *std::move(log), std::chrono::milliseconds(0));
}

std::string KeptState::load_into(scene::SceneStore& store, service::Log& log) {
  base::Result<std::vector<scene::SceneHistory>> histories = scenes_.load(store.limits().history);
  if (!histories) return std::move(histories.error);
  store.begin_above(log_->highest_removed());
  store.remember_removals(log_->removals());
  log.info("scenes are durable", {{"kept_in", place_}, {"scenes", histories->size()}});
  for (scene::SceneHistory& history : *histories) {
    const scene::StoreResult adopted = store.adopt(std::move(history));
    if (!adopted.snapshot) return adopted.error;
    log.info(is_shared_ ? "scene found in the fleet" : "scene found in the state",
             {{"scene", adopted.snapshot->name},
              {"revision", adopted.snapshot->revision},
              {"objects", adopted.snapshot->objects.size()},
              {"digest", adopted.snapshot->digest}});
  }
  return {};
}

}  // namespace camway::process
