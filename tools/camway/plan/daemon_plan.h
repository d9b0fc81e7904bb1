// SPDX-License-Identifier: MIT
#pragma once

#include <camway/client.h>

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/planning/request/request.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/interruption.h"

namespace camway::tools {

/// The flags of `camway plan` that have a daemon plan.
struct DaemonFlags {
  std::string scene;  ///< name of a scene of the daemon; empty: this process plans
  ClientOptions client;
  std::string key_file;
  std::optional<double> timeout_s;

  [[nodiscard]] bool is_asked() const { return !scene.empty(); }
};

/// Declares --daemon, --url, --prefix, --key-file and --timeout-s. Returns the option --daemon.
CLI::Option* add_daemon_flags(CLI::App& command, DaemonFlags& flags);

/// Has a daemon plan. While it exists, signals to end cancel the request at the daemon.
/// Not thread-safe.
class DaemonPlanner {
 public:
  /// Opens the network. Keeps a reference to `flags`.
  explicit DaemonPlanner(const DaemonFlags& flags);

  /// Returns why no daemon can be asked; empty if one can.
  [[nodiscard]] const std::string& error() const { return error_; }

  /// Plans, and waits for the answer. A first signal cancels the request, a second one ends the
  /// process. Requires that there is no error.
  PlanResponse plan(const planning::PlanRequest& request);

  /// Prints why an answer has no result. Returns the exit code.
  [[nodiscard]] ExitCode report(const PlanResponse& response) const;

 private:
  const DaemonFlags& flags_;
  std::string error_;
  Interruption interruption_;  ///< before the client, whose thread inherits the signal mask
  std::optional<Client> client_;
};

}  // namespace camway::tools
