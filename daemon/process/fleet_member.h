// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/nats/connection.h"
#include "daemon/process/kept_state.h"
#include "daemon/process/settings/daemon_options.h"
#include "daemon/scene/log/scene_follower.h"
#include "daemon/scene/log/shared_log.h"
#include "daemon/service/log/limited_log.h"
#include "daemon/service/log/log.h"

namespace camway::process {

/// Returns the name of this process in its fleet: the one of the options, or one that is made of
/// the host and, for a front, its prefix, for a planner, its process.
std::string member_id(const DaemonOptions& options);

/// A process's side of its fleet: the connection to NATS, and the log of all scenes there.
class FleetMember {
 public:
  /// Connects, and opens the log or makes it. Logs the reason and returns null if that is not
  /// possible.
  static std::unique_ptr<FleetMember> open_or_log(const DaemonOptions& options,
                                                  const std::shared_ptr<service::Log>& log);

  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] nats::Connection& connection() { return *connection_; }
  [[nodiscard]] scene::SharedLog& shared_log() { return *shared_log_; }
  [[nodiscard]] KeptState& state() { return *state_; }

  /// Brings the changes of other processes into `store` as long as the returned object lives.
  /// Requires that the state was loaded into the store, and that both outlive it. `advanced` is as
  /// in `SceneFollower`. A front logs each of these changes, within `limits`, and then calls
  /// `changed`.
  [[nodiscard]] std::unique_ptr<scene::SceneFollower> follow(
      scene::SceneStore& store, const service::LimitedLog::Limits& limits,
      scene::SceneFollower::Advanced advanced = {}, scene::SceneFollower::Changed changed = {});

 private:
  FleetMember(std::string id, std::unique_ptr<nats::Connection> connection,
              std::unique_ptr<nats::Connection> log_connection,
              std::unique_ptr<scene::SharedLog> log, const FleetOptions& options,
              std::shared_ptr<service::Log> service_log);

  const std::string id_;
  const FleetRole role_;
  const std::shared_ptr<service::Log> service_log_;
  const std::unique_ptr<nats::Connection> connection_;
  /// The log alone uses it: a connection that asks a locked stream (`nats::StallWatch`) gets no
  /// other answer either, and jobs go on meanwhile.
  const std::unique_ptr<nats::Connection> log_connection_;
  scene::SharedLog* const shared_log_;  ///< owned by `state_`
  const std::unique_ptr<KeptState> state_;
};

}  // namespace camway::process
