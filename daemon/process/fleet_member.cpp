// SPDX-License-Identifier: MIT
#include "daemon/process/fleet_member.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "daemon/fleet/fleet_news.h"
#include "daemon/scene/log/nats/nats_log.h"
#include "lcmtypes/wire/channels.h"

namespace camway::process {
namespace {

/// Returns the name of this host as a part of a plain name: its first label, other characters
/// replaced by '-'.
std::string plain_host_name(std::size_t most) {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "host";
  std::string text(name.data());
  text.resize(std::min({text.size(), text.find('.'), most}));
  for (char& c : text) {
    if (!wire::is_plain_name(std::string_view(&c, 1), 1)) c = '-';
  }
  return text.empty() ? "host" : text;
}

nats::ConnectOptions connect_options(const FleetOptions& options, const std::string& id) {
  nats::ConnectOptions connect;
  connect.servers = servers_of(options.servers);
  connect.name =
      fmt::format("camwayd {} {}", kFleetRoles[static_cast<std::size_t>(options.role)], id);
  connect.credentials_file = options.credentials_file;
  connect.ca_file = options.ca_file;
  connect.certificate_file = options.certificate_file;
  connect.key_file = options.key_file;
  connect.patience = options.patience;
  return connect;
}

scene::NatsLogOptions log_options(const FleetOptions& options,
                                  const std::shared_ptr<service::Log>& log) {
  scene::NatsLogOptions log_options;
  log_options.fleet = options.name;
  log_options.replicas = options.replicas;
  log_options.patience = options.patience;
  log_options.warn = [log](const std::string& warning) {
    log->warn("log of the fleet", {{"reason", warning}});
  };
  return log_options;
}

/// Logs a change that came from the log: another process has made it, or this one, in a request
/// that it had given up.
void log_change(const scene::Snapshot& scene, bool is_removed, const scene::SceneStore& store,
                service::LimitedLog& log) {
  scene::ChangeNote note{.operation = "unload"};
  if (!is_removed) {
    const scene::SceneStore::Kept kept = store.kept(scene.name);
    if (!kept.revisions.empty()) note = kept.revisions.back().note;
  }
  log.write("a scene was changed in the fleet", {{"client", note.client},
                                                 {"operation", note.operation},
                                                 {"scene", scene.name},
                                                 {"object", note.object},
                                                 {"revision", scene.revision}});
}

/// Removes the scenes that the user gives up, before anything of them is read.
bool drop_scenes_or_log(const DaemonOptions& options, scene::SharedLog& fleet_log,
                        service::Log& log) {
  if (options.fleet.role != FleetRole::kFront) return true;
  for (const std::string& name : options.drop_scenes) {
    const scene::AppendResult dropped = fleet_log.drop(name);
    if (dropped.fault != scene::AppendFault::kNone) {
      log.error("scene cannot be dropped", {{"scene", name}, {"reason", dropped.error}});
      return false;
    }
    log.warn("scene dropped from the fleet, with all that was added to it", {{"scene", name}});
  }
  return true;
}

}  // namespace

std::string member_id(const DaemonOptions& options) {
  if (!options.fleet.id.empty()) return options.fleet.id;
  const std::string own = options.fleet.role == FleetRole::kPlanner ? std::to_string(::getpid())
                                                                    : options.service.prefix;
  return plain_host_name(wire::kMaxClientIdLength - 1 - own.size()) + "-" + own;
}

std::unique_ptr<FleetMember> FleetMember::open_or_log(const DaemonOptions& options,
                                                      const std::shared_ptr<service::Log>& log) {
  const FleetOptions& fleet = options.fleet;
  const std::string id = member_id(options);
  const auto fail = [&](const std::string& reason) {
    log->error("there is no way into the fleet",
               {{"setting", options.where("fleet.servers")}, {"reason", reason}});
    return nullptr;
  };
  log->info("connecting to the fleet",
            {{"setting", options.where("fleet.servers")},
             {"patience_s", std::chrono::duration<double>(fleet.patience).count()}});
  auto connection = nats::Connection::open(connect_options(fleet, id));
  if (!connection) return fail(connection.error);
  auto log_connection = nats::Connection::open(connect_options(fleet, id + " log"));
  if (!log_connection) return fail(log_connection.error);
  auto opened = scene::NatsLog::open(**log_connection, log_options(fleet, log));
  if (!opened) return fail(opened.error);
  if (!drop_scenes_or_log(options, **opened, *log)) return nullptr;
  log->info("part of a fleet", {{"fleet", fleet.name},
                                {"role", kFleetRoles[static_cast<std::size_t>(fleet.role)]},
                                {"id", id},
                                {"server", (*connection)->server()}});
  return std::unique_ptr<FleetMember>(new FleetMember(
      id, *std::move(connection), *std::move(log_connection), *std::move(opened), fleet, log));
}

FleetMember::FleetMember(std::string id, std::unique_ptr<nats::Connection> connection,
                         std::unique_ptr<nats::Connection> log_connection,
                         std::unique_ptr<scene::SharedLog> log, const FleetOptions& options,
                         std::shared_ptr<service::Log> service_log)
    : id_(std::move(id)),
      role_(options.role),
      service_log_(std::move(service_log)),
      connection_(std::move(connection)),
      log_connection_(std::move(log_connection)),
      shared_log_(log.get()),
      state_(std::make_unique<KeptState>(fmt::format("fleet '{}'", options.name), std::move(log),
                                         options.patience)) {
  // Called on one thread at a time.
  connection_->on_change(
      [news = std::make_shared<fleet::ConnectionLog>(service_log_)](bool is_connected) {
        if (is_connected) {
          news->made_again(std::nullopt);
        } else {
          news->lost(fleet::ConnectionLog::Clock::now());
        }
      });
}

std::unique_ptr<scene::SceneFollower> FleetMember::follow(scene::SceneStore& store,
                                                          const service::LimitedLog::Limits& limits,
                                                          scene::SceneFollower::Advanced advanced,
                                                          scene::SceneFollower::Changed changed) {
  if (role_ == FleetRole::kFront) {
    // Called on the follower's thread alone, since limited logs are not thread-safe.
    const auto lines = std::make_shared<service::LimitedLog>(service_log_, service::LogLevel::kInfo,
                                                             "changes of others", limits);
    changed = [lines, &store, next = std::move(changed)](const scene::Snapshot& scene,
                                                         bool is_removed) {
      log_change(scene, is_removed, store, *lines);
      if (next) next(scene, is_removed);
    };
  }
  return std::make_unique<scene::SceneFollower>(
      *shared_log_, state_->scenes(), store,
      [log = service_log_](const std::string& warning) {
        log->error("a change of the fleet is missing here", {{"reason", warning}});
      },
      std::move(advanced), std::move(changed));
}

}  // namespace camway::process
