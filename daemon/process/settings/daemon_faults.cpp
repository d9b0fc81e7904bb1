// SPDX-License-Identifier: MIT
#include "daemon/process/settings/daemon_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "daemon/nats/security_files.h"
#include "daemon/process/metrics/http_page.h"
#include "daemon/process/settings/daemon_settings.h"
#include "daemon/record/log_files.h"
#include "lcmtypes/wire/auth/message_keys.h"

namespace camway::process {
namespace {

/// Blames the default if that was set, else the maximum.
void check_deadlines(const DaemonOptions& options, const std::string& table,
                     const messages::DeadlineLimits& limits, std::vector<std::string>& faults) {
  if (limits.default_s <= limits.max_s) return;
  const std::string usual = table + ".deadline_s";
  const std::string longest = table + ".max_deadline_s";
  if (options.set_at.contains(usual) || !options.set_at.contains(longest)) {
    faults.push_back(fmt::format("{}: is {:g}, but must be at most {}, which is {:g}",
                                 options.where(usual), limits.default_s, longest, limits.max_s));
  } else {
    faults.push_back(fmt::format("{}: is {:g}, but must be at least {}, which is {:g}",
                                 options.where(longest), limits.max_s, usual, limits.default_s));
  }
}

/// Reports a share that is larger than the whole, if it was set explicitly: it could have no
/// effect.
void check_share(const DaemonOptions& options, const std::string& share, std::size_t value,
                 const std::string& whole, std::size_t most, std::vector<std::string>& faults) {
  if (value <= most || !options.set_at.contains(share)) return;
  faults.push_back(fmt::format("{}: is {}, but must be at most {}, which is {}",
                               options.where(share), value, whole, most));
}

void check_shares(const DaemonOptions& options, std::vector<std::string>& faults) {
  const service::ServiceConfig& service = options.service;
  check_share(options, "queue.requests_of_a_client", service.queue.jobs_of_a_client,
              "queue.requests", service.queue.jobs, faults);
  check_share(options, "queue.answers_of_a_client", service.answers.answers_of_a_channel,
              "queue.answers", service.answers.answers, faults);
  check_share(options, "scenes.waiting_changes_of_a_client", service.changes.jobs_of_a_client,
              "scenes.waiting_changes", service.changes.jobs, faults);
  check_share(options, "scenes.upload_bytes", service.uploads.bytes, "scenes.all_uploads_bytes",
              service.uploads.total_bytes, faults);
  check_share(options, "watch.paths_of_a_client", service.watches.paths_of_a_client, "watch.paths",
              service.watches.paths, faults);
}

/// Reports settings that do not have their defaults although the role gives them no effect. What
/// the environment says counts as a default.
void check_effect(const DaemonOptions& options, std::initializer_list<std::string_view> keys,
                  std::string_view why, std::vector<std::string>& faults) {
  for (const SettingChange& change : changes_between(default_options(), options)) {
    if (std::ranges::find(keys, change.key) != keys.end()) {
      faults.push_back(fmt::format("{}: {}", options.where(change.key), why));
    }
  }
}

/// A folder has to hold several files, so that the oldest can go while one is written.
void check_record(const DaemonOptions& options, std::vector<std::string>& faults) {
  constexpr std::size_t kLeastFiles = 4;
  const record::RecordLimits& limits = options.record.limits;
  if (limits.file_bytes <= limits.most_bytes / kLeastFiles) return;
  const bool blames_file = options.set_at.contains("record.file_bytes");
  faults.push_back(
      fmt::format("{}: is {}, but record.most_bytes must be at least {} times record.file_bytes",
                  options.where(blames_file ? "record.file_bytes" : "record.most_bytes"),
                  blames_file ? limits.file_bytes : limits.most_bytes, kLeastFiles));
}

void check_fleet(const DaemonOptions& options, std::vector<std::string>& faults) {
  const FleetOptions& fleet = options.fleet;
  if (!options.drop_scenes.empty() && fleet.role != FleetRole::kFront) {
    faults.push_back("--fleet-drop: has no effect but on a front: give --role front");
  }
  if (fleet.role == FleetRole::kAlone) {
    check_effect(options,
                 {"fleet.servers", "fleet.credentials_file", "fleet.ca_file",
                  "fleet.certificate_file", "fleet.key_file"},
                 "has no effect without a role in the fleet: give --role front or --role planner "
                 "(fleet.role)",
                 faults);
    return;
  }
  if (servers_of(fleet.servers).empty()) {
    faults.push_back(options.where("fleet.role") +
                     ": needs the servers of NATS: give --fleet nats://HOST:4222 "
                     "(fleet.servers)");
  }
  if (fleet.certificate_file.empty() != fleet.key_file.empty()) {
    faults.push_back(
        options.where(fleet.key_file.empty() ? "fleet.certificate_file" : "fleet.key_file") +
        ": a certificate and its key go together");
  }
  if (fleet.name.empty()) faults.push_back(options.where("fleet.name") + ": must not be empty");
  if (fleet.replicas % 2 == 0) {
    faults.push_back(options.where("fleet.replicas") + ": must be 1, 3 or 5");
  }
  check_effect(options, {"state.folder"},
               "has no effect in a fleet, which keeps its scenes in NATS", faults);
  if (fleet.role != FleetRole::kPlanner) return;
  check_effect(options,
               {"lcm.url", "lcm.prefix", "lcm.share_prefix", "scenes.roots", "auth.key_file",
                "metrics.port", "fleet.jobs", "record.folder"},
               "has no effect on a planner, which talks to the fronts of its fleet alone", faults);
  for (const SceneArgument& scene : options.scenes) {
    faults.push_back(
        fmt::format("{}: scene '{}': a planner has the scenes of its fleet; name it "
                    "to a front",
                    scene.set_at, scene.name));
  }
}

}  // namespace

std::vector<std::string> contradictions(const DaemonOptions& options) {
  std::vector<std::string> faults;
  check_fleet(options, faults);
  if (options.state.folder.empty() && options.where("state.folder") == "--state") {
    faults.push_back("--state: must name a folder");
  }
  if (options.record.folder.empty() && options.where("record.folder") == "--record") {
    faults.push_back("--record: must name a folder");
  }
  check_record(options, faults);
  check_deadlines(options, "planning", options.service.deadline, faults);
  check_deadlines(options, "occupancy", options.service.occupancy_deadline, faults);
  check_deadlines(options, "scenes", options.service.change_deadline, faults);
  check_shares(options, faults);
  return faults;
}

std::vector<std::string> unusable_fleet_files(const DaemonOptions& options) {
  using File = nats::SecurityFileFault::File;
  const FleetOptions& fleet = options.fleet;
  if (fleet.role == FleetRole::kAlone) return {};
  nats::ConnectOptions connect;
  connect.credentials_file = fleet.credentials_file;
  connect.ca_file = fleet.ca_file;
  connect.certificate_file = fleet.certificate_file;
  connect.key_file = fleet.key_file;
  std::vector<std::string> faults;
  for (const nats::SecurityFileFault& fault : nats::faults_of_security_files(connect)) {
    const std::string_view key = fault.file == File::kCredentials   ? "fleet.credentials_file"
                                 : fault.file == File::kCa          ? "fleet.ca_file"
                                 : fault.file == File::kCertificate ? "fleet.certificate_file"
                                                                    : "fleet.key_file";
    faults.push_back(options.where(key) + ": " + fault.reason);
  }
  return faults;
}

std::vector<std::string> missing_things(const DaemonOptions& options) {
  std::vector<std::string> faults = unusable_fleet_files(options);
  if (!options.auth.key_file.empty()) {
    const wire::MessageKeys::ReadResult read = wire::MessageKeys::from_file(options.auth.key_file);
    if (!read.keys) faults.push_back(options.where("auth.key_file") + ": " + read.error);
  }
  const bool address_counts =
      options.metrics.port != 0 || options.set_at.contains("metrics.address");
  if (address_counts && !http::is_address_of_this_machine(options.metrics.ip)) {
    faults.push_back(fmt::format("{}: {} is no address of this machine",
                                 options.where("metrics.address"), options.metrics.ip));
  }
  if (const std::string fault = fault_of_record_folder(options); !fault.empty()) {
    faults.push_back(options.where("record.folder") + ": " + fault);
  }
  return faults;
}

std::string fault_of_record_folder(const DaemonOptions& options) {
  return options.record.folder.empty() ? "" : record::folder_fault(options.record.folder);
}

}  // namespace camway::process
