// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "daemon/base/standard_streams.h"
#include "daemon/process/configured_scenes.h"
#include "daemon/process/daemon_run.h"
#include "daemon/process/kept_state.h"
#include "daemon/process/process_signals.h"
#include "daemon/process/settings/daemon_command_line.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/service/log/log.h"
#include "daemon/version/build_info.h"

namespace {

constexpr int kExitFault = 1;
constexpr int kExitBadInput = 2;

int state_fault(const camway::process::DaemonOptions& options, const std::string& reason,
                camway::service::Log& log) {
  log.error("the folder of the state cannot be used",
            {{"setting", options.where("state.folder")}, {"reason", reason}});
  return kExitFault;
}

int run(int argc, char** argv) {
  using namespace camway;
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

  process::block_reload_signal();  // a reload that is asked for now comes after the scenes
  std::unique_ptr<process::KeptState> state;
  if (!parsed.options->state.folder.empty()) {
    auto opened = process::KeptState::open(parsed.options->state);
    if (!opened) return state_fault(*parsed.options, opened.error, *log);
    state = *std::move(opened);
  }
  scene::SceneStore scenes(parsed.options->store, state ? &state->journal() : nullptr);
  if (const std::string fault = state ? state->load_into(scenes, *log) : ""; !fault.empty()) {
    return state_fault(*parsed.options, fault, *log);
  }
  std::optional<scene::SceneCache> cache = process::scene_cache(*parsed.options);
  if (const std::string fault = cache ? cache->fault() : ""; !fault.empty()) {
    log->warn("the cache of scenes is not used",
              {{"folder", cache->folder().string()}, {"reason", fault}});
    cache.reset();
  }
  process::ConfiguredScenes configured(scenes, log, std::move(cache),
                                       state ? &state->log() : nullptr);
  // A stop signal while scenes are being read ends the process at once: no client depends on it
  // yet.
  if (!configured.update(parsed.options->scenes)) return kExitBadInput;
  process::block_stop_signals();
  const auto read_again = [=] { return process::parse_daemon_options(argc, argv); };
  return process::serve(*parsed.options, read_again, scenes, configured, log);
}

}  // namespace

int main(int argc, char** argv) {
  if (!camway::base::occupy_closed_standard_streams()) return kExitFault;
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "camwayd: " << error.what() << '\n';
    return kExitFault;
  }
}
