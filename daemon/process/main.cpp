// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "daemon/base/standard_streams.h"
#include "daemon/process/configured_scenes.h"
#include "daemon/process/daemon_run.h"
#include "daemon/process/fleet_member.h"
#include "daemon/process/kept_state.h"
#include "daemon/process/planner_run.h"
#include "daemon/process/process_signals.h"
#include "daemon/process/recording.h"
#include "daemon/process/settings/daemon_command_line.h"
#include "daemon/process/settings/daemon_faults.h"
#include "daemon/process/warning_journal.h"
#include "daemon/record/recording_journal.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"
#include "daemon/version/build_info.h"

namespace {

constexpr int kExitFault = 1;
constexpr int kExitBadInput = 2;

using namespace camway;

int state_fault(const process::DaemonOptions& options, const std::string& reason,
                service::Log& log) {
  const bool is_alone = options.fleet.role == process::FleetRole::kAlone;
  log.error(is_alone ? "the folder of the state cannot be used"
                     : "the scenes of the fleet cannot be read",
            {{"setting", options.where(is_alone ? "state.folder" : "fleet.servers")},
             {"reason", reason}});
  return kExitFault;
}

/// A folder that can be neither made nor written is a fault of the configuration, which another
/// start does not mend; that another daemon records into it may be over by then.
int record_fault(const process::DaemonOptions& options, const std::string& reason,
                 service::Log& log) {
  log.error("nothing can be recorded",
            {{"setting", options.where("record.folder")}, {"reason", reason}});
  return process::fault_of_record_folder(options).empty() ? kExitFault : kExitBadInput;
}

/// The journals that are told of the changes of the scenes.
class Journals {
 public:
  /// Both may be null.
  Journals(process::KeptState* state, record::Recorder* recorder,
           const std::shared_ptr<service::Log>& log) {
    if (state != nullptr) warning_.emplace(state->scenes(), log);
    if (recorder != nullptr) recording_.emplace(warning_ ? &*warning_ : nullptr, *recorder);
  }
  Journals(const Journals&) = delete;
  Journals& operator=(const Journals&) = delete;

  /// The journal for the store; null if there is none.
  [[nodiscard]] scene::SceneJournal* first() {
    if (recording_) return &*recording_;
    return warning_ ? &*warning_ : nullptr;
  }

 private:
  std::optional<process::WarningJournal> warning_;
  std::optional<record::RecordingJournal> recording_;
};

/// Records the scenes that were kept since an earlier start.
void record_scenes(const scene::SceneStore& scenes, record::Recorder& recorder) {
  for (const auto& scene : scenes.list()) recorder.scene_put(*scene, {});
}

/// Records the changes of other processes, of which the journal of the store does not hear.
scene::SceneFollower::Changed recording_of_others(record::Recorder* recorder) {
  if (recorder == nullptr) return {};
  return [recorder](const scene::Snapshot& scene, bool is_removed) {
    if (is_removed) {
      recorder->scene_removed(scene);
    } else {
      recorder->scene_put(scene, {});
    }
  };
}

/// The log that keeps scenes beyond the life of this process. Both are null if nothing does.
struct Keeper {
  std::unique_ptr<process::FleetMember> fleet;
  std::unique_ptr<process::KeptState> folder;

  [[nodiscard]] process::KeptState* state() const { return fleet ? &fleet->state() : folder.get(); }
};

/// Opens what the options ask for. Returns the exit code if that is not possible, having logged
/// why.
std::optional<int> open(const process::DaemonOptions& options,
                        const std::shared_ptr<service::Log>& log, Keeper& keeper) {
  if (options.fleet.role != process::FleetRole::kAlone) {
    process::block_stop_signals();  // the connection has threads
    keeper.fleet = process::FleetMember::open_or_log(options, log);
    return keeper.fleet ? std::nullopt : std::optional(kExitFault);
  }
  if (options.state.folder.empty()) return std::nullopt;
  auto opened = process::KeptState::open(options.state);
  if (!opened) return state_fault(options, opened.error, *log);
  keeper.folder = *std::move(opened);
  return std::nullopt;
}

std::optional<scene::SceneCache> open_cache(const process::DaemonOptions& options,
                                            service::Log& log) {
  std::optional<scene::SceneCache> cache = process::scene_cache(options);
  if (const std::string fault = cache ? cache->fault() : ""; !fault.empty()) {
    log.warn("the cache of scenes is not used",
             {{"folder", cache->folder().string()}, {"reason", fault}});
    cache.reset();
  }
  return cache;
}

/// Serves clients, alone or as the front of a fleet.
int run_service(const process::DaemonOptions& options, const process::Reloader::Read& read_again,
                const std::shared_ptr<service::Log>& log) {
  process::block_reload_signal();  // a reload that is asked for now comes after the scenes
  Keeper keeper;
  if (const std::optional<int> code = open(options, log, keeper)) return *code;
  auto recorder = process::open_recorder(options, log);
  if (!recorder) return record_fault(options, recorder.error, *log);
  process::KeptState* const state = keeper.state();
  Journals journals(state, recorder->get(), log);
  scene::SceneStore scenes(options.store, journals.first());
  if (const std::string fault = state != nullptr ? state->load_into(scenes, *log) : "";
      !fault.empty()) {
    return state_fault(options, fault, *log);
  }
  if (*recorder) record_scenes(scenes, **recorder);
  const auto follower = keeper.fleet ? keeper.fleet->follow(scenes, options.service.log_limits, {},
                                                            recording_of_others(recorder->get()))
                                     : nullptr;
  process::ConfiguredScenes configured(scenes, log, open_cache(options, *log),
                                       state != nullptr ? &state->log() : nullptr,
                                       keeper.fleet ? process::member_id(options) : "");
  const auto read_scenes = [&] { return configured.update(options.scenes); };
  // A stop signal while scenes are being read ends the process at once: no client depends on it
  // yet. A front reads them later.
  if (!keeper.fleet && !read_scenes()) return kExitBadInput;
  process::block_stop_signals();
  return process::serve(options, read_again, scenes, configured, keeper.fleet.get(),
                        recorder->get(), read_scenes, log);
}

int run(int argc, char** argv) {
  const process::ParsedOptions parsed = process::parse_daemon_options(argc, argv);
  if (!(std::cout << parsed.text).flush()) {
    std::cerr << "camwayd: standard output cannot be written: the disk is full, or nobody reads\n";
    return kExitBadInput;
  }
  for (const std::string& fault : parsed.faults) std::cerr << "camwayd: " << fault << '\n';
  if (!parsed.faults.empty()) return kExitBadInput;
  if (!parsed.options) return EXIT_SUCCESS;

  const auto log = std::make_shared<service::Log>(std::cerr, parsed.options->log_format,
                                                  parsed.options->log_level);
  log->info("starting", {{"version", service::version_text()}});

  if (parsed.options->fleet.role == process::FleetRole::kPlanner) {
    return process::run_planner(*parsed.options, log);
  }
  const auto read_again = [=] { return process::parse_daemon_options(argc, argv); };
  return run_service(*parsed.options, read_again, log);
}

}  // namespace

int main(int argc, char** argv) {
  if (!base::occupy_closed_standard_streams()) return kExitFault;
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "camwayd: " << error.what() << '\n';
    return kExitFault;
  }
}
