// SPDX-License-Identifier: MIT
#include "daemon/process/settings/daemon_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <regex>
#include <span>
#include <type_traits>
#include <utility>

#include "daemon/planning/request/validate.h"
#include "daemon/process/metrics/http_page.h"
#include "daemon/service/transport/lcm_url.h"
#include "lcmtypes/wire/channels.h"

namespace camway::process {
namespace {

using std::chrono::milliseconds;

constexpr double kMillisecondsPerSecond = 1e3;
constexpr double kDayS = 86'400.0;
/// Less is taken for a wrong unit.
constexpr double kLeastDeadline_s = 1e-3;
/// Largest counts and numbers of bytes: beyond all practical values, and exact as doubles.
constexpr double kManyBytes = 1e15;

template <class Value>
constexpr bool kIsWhole = std::is_same_v<Value, int> || std::is_same_v<Value, std::size_t>;

/// The words for the values of an enumeration, in their order.
std::span<const std::string_view> words_for(service::LogLevel) { return service::kLogLevels; }
std::span<const std::string_view> words_for(service::LogFormat) { return service::kLogFormats; }
std::span<const std::string_view> words_for(FleetRole) { return kFleetRoles; }

template <class Choice>
std::string choose(Choice& place, std::string_view word) {
  const auto words = words_for(place);
  const auto found = std::ranges::find(words, word);
  if (found == words.end())
    return fmt::format("must be one of {}, not '{}'", fmt::join(words, ", "), word);
  place = static_cast<Choice>(found - words.begin());
  return {};
}

std::string fault_of_url(const std::string& text) { return service::parse_lcm_url(text).fault; }

std::string fault_of_prefix(const std::string& text) {
  if (wire::is_prefix(text)) return {};
  return fmt::format("'{}' is not of 1 to {} letters, digits, '_' and '-'", wire::printable(text),
                     wire::kMaxPrefixLength);
}

/// For the names of fleets and of processes in them, which are parts of subjects.
std::string fault_of_member(const std::string& text) {
  if (text.empty() || wire::is_client_id(text)) return {};
  return fmt::format("'{}' is not of 1 to {} letters, digits, '_' and '-'", wire::printable(text),
                     wire::kMaxClientIdLength);
}

/// Returns a list of URLs without the names and passwords of users in them.
std::string without_users(std::string list) {
  static const std::regex kUser("://[^/@,]*@");
  return std::regex_replace(list, kUser, "://");
}

/// Returns what is wrong with the URL of a server of NATS.
std::string fault_of_server(const std::string& server) {
  constexpr int kLargestPort = 65'535;
  const auto fault = [&](std::string_view what) {
    return fmt::format("'{}' {}", wire::printable(without_users(server)), what);
  };
  // User and password, a host or an address of IPv6 in brackets, and a port.
  static const std::regex kForm(
      R"((?:nats|tls)://(?:[^/@]*@)?(\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]*)(?::([^/:]*))?/?)");
  if (!server.starts_with("nats://") && !server.starts_with("tls://")) {
    return fault("begins neither with nats:// nor with tls://");
  }
  std::smatch parts;
  if (!std::regex_match(server, parts, kForm)) return fault("must be nats://HOST:PORT");
  if (parts[1].length() == 0) return fault("names no host");
  if (!parts[2].matched) return {};
  const std::string port = parts[2].str();
  int number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  const bool is_port = error == std::errc{} && end == port.data() + port.size() && number >= 1 &&
                       number <= kLargestPort;
  return is_port ? "" : fault(fmt::format("must have a port within 1 to {}", kLargestPort));
}

std::string fault_of_servers(const std::string& text) {
  for (const std::string& server : servers_of(text)) {
    if (std::string fault = fault_of_server(server); !fault.empty()) return fault;
  }
  return {};
}

std::string fault_of_address(const std::string& text) {
  return http::is_ip_address(text) ? "" : "must be an IPv4 or IPv6 address";
}

/// Largest number of requests that may wait.
constexpr double kQueue = service::kMaxQueueCapacity;

std::vector<Setting> lcm_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"lcm.url", &options.lcm_url, 0, 0, false, &fault_of_url},
      {"lcm.prefix", &service.prefix, 0, 0, false, &fault_of_prefix},
      {"lcm.share_prefix", &options.share_prefix},
      {"lcm.waiting_messages", &service.subscription_capacity, 1, 1e6},
  };
}

std::vector<Setting> planning_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"planning.workers", &service.workers, 0, service::kMaxWorkers},
      {"planning.deadline_s", &service.deadline.default_s, kLeastDeadline_s, kDayS},
      {"planning.max_deadline_s", &service.deadline.max_s, kLeastDeadline_s, kDayS},
      {"planning.keyframes", &service.keyframes, 2, static_cast<double>(planning::kMaxKeyframes)},
      {"planning.drain_s", &service.drain_limit, 0, kDayS},
  };
}

std::vector<Setting> occupancy_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"occupancy.deadline_s", &service.occupancy_deadline.default_s, kLeastDeadline_s, kDayS},
      {"occupancy.max_deadline_s", &service.occupancy_deadline.max_s, kLeastDeadline_s, kDayS},
  };
}

std::vector<Setting> queue_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"queue.requests", &service.queue.jobs, 1, kQueue},
      {"queue.requests_of_a_client", &service.queue.jobs_of_a_client, 1, kQueue},
      {"queue.remembered_clients", &service.queue.remembered_clients, 2, 1e6},
      {"queue.newcomers_count_as", &service.queue.newcomers_count_as, 1, 1e6},
      {"queue.request_bytes", &service.request_bytes, 1, kManyBytes},
      {"queue.answers", &service.answers.answers, 1, 1e6},
      {"queue.answers_of_a_client", &service.answers.answers_of_a_channel, 1, 1e6},
      {"queue.answer_bytes", &service.answers.bytes, 1, kManyBytes},
      {"queue.refusals", &service.answers.refusals, 1, 1e6},
      {"queue.answer_pages", &service.answer_pages, 1, wire::kMaxResponsePages},
      {"queue.malformed_answers_per_s", &service.malformed_answers_per_s, 1, 1e6},
  };
}

std::vector<Setting> memory_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"memory.remembered_answers", &service.cache.max_answers, 0, 1e6},
      {"memory.remembered_answer_bytes", &service.cache.max_bytes, 0, kManyBytes},
      {"memory.half_received_requests", &service.assembly.max_messages, 1, 1e6},
      {"memory.half_received_bytes", &service.assembly.max_bytes, 1, kManyBytes},
  };
}

std::vector<Setting> scenes_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"scenes.roots", &options.scene_roots, 0, 0, false, nullptr, Setting::Path::kFolders},
      {"scenes.write_maps", &service.scene_rules.write_maps},
      {"scenes.cache_folder", &options.cache_folder, 0, 0, false, nullptr, Setting::Path::kFile},
      {"scenes.cache_bytes", &options.cache_bytes, 0, kManyBytes},
      {"scenes.workers", &service.scene_workers, 1, service::kMaxWorkers},
      {"scenes.deadline_s", &service.change_deadline.default_s, kLeastDeadline_s, kDayS},
      {"scenes.max_deadline_s", &service.change_deadline.max_s, kLeastDeadline_s, kDayS},
      {"scenes.scenes", &options.store.scenes, 1, 1e6},
      {"scenes.objects", &options.store.objects, 1, 1e6},
      {"scenes.triangles", &options.store.triangles, 1, 4e9},
      {"scenes.occupancy_bytes", &options.store.occupancy_bytes, 1, kManyBytes},
      {"scenes.mirror_voxels", &service.scene_rules.mirror_voxels, 1, 1e12},
      {"scenes.map_voxels", &service.scene_rules.maps.voxels, 1, 1e12},
      {"scenes.map_triangles", &service.scene_rules.maps.triangles, 12, 4e9},
      {"scenes.scan_voxels", &service.scene_rules.scan_voxels, 1, 1e12},
      {"scenes.remembered_changes", &options.store.history.changes, 0, 1e6},
      {"scenes.remembered_change_bytes", &options.store.history.bytes, 0, kManyBytes},
      {"scenes.waiting_changes", &service.changes.jobs, 1, kQueue},
      {"scenes.waiting_changes_of_a_client", &service.changes.jobs_of_a_client, 1, kQueue},
      {"scenes.uploads", &service.uploads.uploads, 1, 1e4},
      {"scenes.upload_bytes", &service.uploads.bytes, 1, 1e11},
      {"scenes.all_uploads_bytes", &service.uploads.total_bytes, 1, 1e12},
      {"scenes.exports", &service.exports.exports, 1, 1e4},
      {"scenes.all_exports_bytes", &service.exports.bytes, 1, 1e12},
      {"scenes.upload_idle_s", &service.uploads.idle, 1, kDayS},
      {"scenes.export_idle_s", &service.exports.idle, 1, kDayS},
  };
}

std::vector<Setting> state_settings(DaemonOptions& options) {
  return {
      {"state.folder", &options.state.folder, 0, 0, false, nullptr, Setting::Path::kFile},
      {"state.most_bytes", &options.state.most_bytes, 1 << 20, kManyBytes},
  };
}

std::vector<Setting> record_settings(DaemonOptions& options) {
  return {
      {"record.folder", &options.record.folder, 0, 0, false, nullptr, Setting::Path::kFile},
      {"record.file_bytes", &options.record.limits.file_bytes, 1 << 16, kManyBytes},
      {"record.file_s", &options.record.limits.file_time, 1, kDayS},
      {"record.most_bytes", &options.record.limits.most_bytes, 1 << 20, kManyBytes},
  };
}

std::vector<Setting> fleet_settings(DaemonOptions& options) {
  return {
      {"fleet.role", &options.fleet.role},
      {"fleet.servers", &options.fleet.servers, 0, 0, false, &fault_of_servers},
      {"fleet.name", &options.fleet.name, 0, 0, false, &fault_of_member},
      {"fleet.id", &options.fleet.id, 0, 0, false, &fault_of_member},
      {"fleet.credentials_file", &options.fleet.credentials_file, 0, 0, false, nullptr,
       Setting::Path::kFile},
      {"fleet.ca_file", &options.fleet.ca_file, 0, 0, false, nullptr, Setting::Path::kFile},
      {"fleet.certificate_file", &options.fleet.certificate_file, 0, 0, false, nullptr,
       Setting::Path::kFile},
      {"fleet.key_file", &options.fleet.key_file, 0, 0, false, nullptr, Setting::Path::kFile},
      {"fleet.replicas", &options.fleet.replicas, 1, 5},
      {"fleet.jobs", &options.fleet.jobs, 1, service::kMaxWorkers},
      {"fleet.patience_s", &options.fleet.patience, 0.1, 3600},
  };
}

std::vector<Setting> watch_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"watch.paths", &service.watches.paths, 0, 1e6},
      {"watch.paths_of_a_client", &service.watches.paths_of_a_client, 0, 1e6},
      {"watch.bytes", &service.watches.bytes, 0, kManyBytes},
      {"watch.longest_lease_s", &service.watches.longest_lease, 1, kDayS},
  };
}

std::vector<Setting> status_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"status.period_s", &service.heartbeat_period, 0.01, 3600},
  };
}

std::vector<Setting> auth_settings(DaemonOptions& options) {
  return {
      {"auth.key_file", &options.auth.key_file, 0, 0, false, nullptr, Setting::Path::kFile},
      {"auth.required", &options.auth.required},
      {"auth.window_s", &options.auth.window, 0.001, kDayS},
      {"auth.senders", &options.auth.senders, 1, 1e7},
  };
}

std::vector<Setting> metrics_settings(DaemonOptions& options) {
  return {
      {"metrics.address", &options.metrics.ip, 0, 0, false, &fault_of_address},
      {"metrics.port", &options.metrics.port, 0, 65'535},
      {"metrics.connections", &options.metrics_limits.connections, 1, 1000},
      {"metrics.idle_s", &options.metrics_limits.idle_s, 1, kDayS},
  };
}

std::vector<Setting> log_settings(DaemonOptions& options) {
  service::ServiceConfig& service = options.service;
  return {
      {"log.level", &options.log_level, 0, 0, true},
      {"log.format", &options.log_format},
      {"log.lines_per_s", &service.log_limits.lines_per_s, 0.001, 1e6},
      {"log.burst_lines", &service.log_limits.burst_lines, 1, 1e6},
  };
}

}  // namespace

std::string Setting::text() const {
  return std::visit(
      [](const auto* value) -> std::string {
        using Value = std::decay_t<decltype(*value)>;
        if constexpr (std::is_same_v<Value, std::string>) {
          return fmt::format("\"{}\"", *value);
        } else if constexpr (std::is_enum_v<Value>) {
          return fmt::format("\"{}\"", words_for(*value)[static_cast<std::size_t>(*value)]);
        } else if constexpr (std::is_same_v<Value, milliseconds>) {
          return fmt::format("{}", static_cast<double>(value->count()) / kMillisecondsPerSecond);
        } else {
          return fmt::format("{}", *value);
        }
      },
      target);
}

std::vector<std::string_view> Setting::choices() const {
  return std::visit(
      [](const auto* value) -> std::vector<std::string_view> {
        if constexpr (std::is_enum_v<std::decay_t<decltype(*value)>>) {
          const auto words = words_for(*value);
          return {words.begin(), words.end()};
        } else {
          return {};
        }
      },
      target);
}

std::string Setting::set(std::string_view value) const {
  if (const auto* const level = std::get_if<service::LogLevel*>(&target))
    return choose(**level, value);
  if (const auto* const format = std::get_if<service::LogFormat*>(&target))
    return choose(**format, value);
  if (const auto* const role = std::get_if<FleetRole*>(&target)) return choose(**role, value);
  std::string text(value);
  std::string fault = fault_of_text != nullptr ? fault_of_text(text) : std::string();
  if (fault.empty()) *std::get<std::string*>(target) = std::move(text);
  return fault;
}

std::string Setting::set(double value) const {
  if (!(value >= least && value <= most)) {
    return fmt::format("must be within {} to {}, not {}", least, most, value);
  }
  std::visit(
      [value](auto* place) {
        using Value = std::decay_t<decltype(*place)>;
        if constexpr (std::is_same_v<Value, milliseconds>) {
          *place = milliseconds(std::llround(value * kMillisecondsPerSecond));
        } else if constexpr (kIsWhole<Value> || std::is_same_v<Value, double>) {
          *place = static_cast<Value>(value);
        }
      },
      target);
  return {};
}

std::string Setting::set_word(std::string_view word) const {
  if (is_text()) return set(word);
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_number = error == std::errc{} && end == word.data() + word.size();
  if (is_number && !(is_whole_number() && number != std::trunc(number))) return set(number);
  return fmt::format("must be a {}number, not '{}'", is_whole_number() ? "whole " : "", word);
}

void Setting::turn(bool on) const { *std::get<bool*>(target) = on; }

bool Setting::is_switch() const { return std::holds_alternative<bool*>(target); }

bool Setting::is_text() const {
  return std::holds_alternative<std::string*>(target) ||
         std::holds_alternative<service::LogLevel*>(target) ||
         std::holds_alternative<service::LogFormat*>(target) ||
         std::holds_alternative<FleetRole*>(target);
}

std::string Setting::below(const std::filesystem::path& folder, std::string_view value) const {
  if (path == Path::kNone || value.empty()) return std::string(value);
  if (path == Path::kFile) return (folder / value).string();
  std::string paths;
  while (!value.empty()) {
    const std::string_view one = value.substr(0, value.find(':'));
    value.remove_prefix(std::min(value.size(), one.size() + 1));
    if (one.empty()) continue;
    if (!paths.empty()) paths += ':';
    paths += (folder / one).string();
  }
  return paths;
}

bool Setting::is_whole_number() const {
  return std::holds_alternative<int*>(target) || std::holds_alternative<std::size_t*>(target);
}

std::vector<Setting> settings_of(DaemonOptions& options) {
  std::vector<Setting> settings;
  for (const auto settings_of_section :
       {&lcm_settings, &planning_settings, &occupancy_settings, &queue_settings, &memory_settings,
        &scenes_settings, &state_settings, &record_settings, &fleet_settings, &watch_settings,
        &status_settings, &auth_settings, &metrics_settings, &log_settings}) {
    std::ranges::move(settings_of_section(options), std::back_inserter(settings));
  }
  return settings;
}

std::vector<SettingChange> changes_between(DaemonOptions before, DaemonOptions after) {
  const std::vector<Setting> old_settings = settings_of(before);
  const std::vector<Setting> new_settings = settings_of(after);
  std::vector<SettingChange> changes;
  for (std::size_t i = 0; i < old_settings.size(); ++i) {
    SettingChange change{old_settings[i].key, old_settings[i].text(), new_settings[i].text(),
                         old_settings[i].reloads};
    if (change.before == change.after) continue;
    if (change.key == "fleet.servers") {
      change.before = without_users(change.before);
      change.after = without_users(change.after);
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace camway::process
