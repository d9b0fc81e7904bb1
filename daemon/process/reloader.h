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
#include "daemon/process/reload_record.h"
#include "daemon/process/service_manager.h"
#include "daemon/process/settings/daemon_command_line.h"
#include "daemon/service/log/log.h"
#include "lcmtypes/wire/auth/message_auth.h"

namespace camway::process {

/// Reads the configuration again while the daemon serves, on a thread of its own. Applies scenes,
/// log level and the content of the key file, and logs which other changes need a restart. Keeps
/// all as it was if the configuration is bad or a scene cannot be read. In between it checks the
/// files of watched scenes.
class Reloader {
 public:
  using Read = std::function<ParsedOptions()>;

  /// `running`: the options that the daemon was started with. `read` returns the present ones.
  /// `scenes`, `record` and `manager` must outlive this; nobody else may use `scenes` meanwhile.
  /// Files of watched scenes are checked every `look_every`.
  Reloader(DaemonOptions running, Read read, ConfiguredScenes& scenes, ReloadRecord& record,
           const ServiceManager& manager, std::shared_ptr<service::Log> log,
           std::shared_ptr<wire::MessageAuth> auth = nullptr,
           std::chrono::milliseconds look_every = std::chrono::seconds(1));
  /// Cancels the reading of a scene, if one is being read.
  ~Reloader() = default;
  Reloader(const Reloader&) = delete;
  Reloader& operator=(const Reloader&) = delete;

  /// Asks for a reload, without waiting. Cancels a check of files, which is repeated afterwards,
  /// and a reload in progress, since the newest configuration counts. A reload that follows a
  /// cancelled one is not cancelled, so that steady requests cannot keep every reload from
  /// finishing.
  /// Thread-safe.
  void request();

 private:
  void serve(const std::stop_token& stop);
  /// Checks files until a reload is requested, then returns true; returns false at the stop.
  bool wait(const std::stop_token& stop);
  /// Returns a token that cancels the work that begins now: at `stop` and, if `may_cancel`, at a
  /// request.
  std::stop_token begin_work(const std::stop_token& stop, bool may_cancel);
  void look_at_files(const std::stop_token& stop);
  void reload(const std::stop_token& stop);
  void take_over(const DaemonOptions& next);

  DaemonOptions running_;
  Read read_;
  ConfiguredScenes& scenes_;
  ReloadRecord& record_;
  const ServiceManager& manager_;
  std::shared_ptr<service::Log> log_;
  std::shared_ptr<wire::MessageAuth> auth_;  ///< null if messages are not signed
  const std::chrono::milliseconds look_every_;
  std::mutex mutex_;  ///< guards requested_, work_ and may_cancel_
  std::condition_variable_any changed_;
  bool requested_ = false;
  std::stop_source work_;
  bool may_cancel_ = true;  ///< whether a request cancels the work
  std::jthread thread_;     ///< last: uses all above
};

}  // namespace camway::process
