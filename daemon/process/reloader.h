// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "daemon/process/configured_scenes.h"
#include "daemon/process/daemon_command_line.h"
#include "daemon/process/reload_record.h"
#include "daemon/process/service_manager.h"
#include "daemon/service/log/log.h"
#include "lcmtypes/wire/auth/message_auth.h"

namespace camway::service {

/// Reads the configuration again while the daemon serves, on a thread of its own: takes over scenes
/// and log level, and the keys in their file, says which other changes need a restart, and keeps
/// all as it was if the configuration or a scene is bad. In between it looks at the files of scenes
/// that are to be watched.
class Reloader {
 public:
  using Read = std::function<ParsedOptions()>;

  /// `running`: what the daemon was started with. `read` gives what holds now. `scenes`, `record`
  /// and `manager` must outlive this; nobody else may use `scenes` meanwhile.
  /// Files of scenes that are to be watched are looked at every `look_every`.
  Reloader(DaemonOptions running, Read read, ConfiguredScenes& scenes, ReloadRecord& record,
           const ServiceManager& manager, std::shared_ptr<Log> log,
           std::shared_ptr<wire::MessageAuth> auth = nullptr,
           std::chrono::milliseconds look_every = std::chrono::seconds(1));
  /// Calls off the reading of a scene, if one is being read.
  ~Reloader() = default;
  Reloader(const Reloader&) = delete;
  Reloader& operator=(const Reloader&) = delete;

  /// From any thread. It waits for nothing: the reading of a file that changed is called off for
  /// it, to be done afterwards, and so is a reload that is being done, since the newest
  /// configuration counts. But not the one after that: requests that come all the time must not
  /// keep every reload from its end.
  void request();

 private:
  void serve(const std::stop_token& stop);
  /// Whether a reload was asked for; looks at files until then, or until the stop.
  bool wait(const std::stop_token& stop);
  /// What calls off the work that begins now: the end of all, or also a request.
  std::stop_token begin_work(const std::stop_token& stop, bool may_call_off);
  void look_at_files(const std::stop_token& stop);
  void reload(const std::stop_token& stop);
  void take_over(const DaemonOptions& next);

  DaemonOptions running_;
  Read read_;
  ConfiguredScenes& scenes_;
  ReloadRecord& record_;
  const ServiceManager& manager_;
  std::shared_ptr<Log> log_;
  std::shared_ptr<wire::MessageAuth> auth_;  ///< null if messages are not signed
  const std::chrono::milliseconds look_every_;
  std::mutex mutex_;  ///< guards requested_, work_ and may_call_off_
  std::condition_variable_any changed_;
  bool requested_ = false;
  std::stop_source work_;
  bool may_call_off_ = true;  ///< whether a request ends the work
  std::jthread thread_;       ///< last: uses all above
};

}  // namespace camway::service
