// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>

#include <memory>
#include <string>
#include <utility>

#include "client/c/handles.h"
#include "client/c/sized.h"

namespace camway {

// Weak, so null in a program that links the static library alone: that one does without libsodium,
// which signing needs. The shared library has it.
[[gnu::weak]] LoadedAuthentication authentication_from(const std::string& key_file,
                                                       double window_s);

}  // namespace camway

namespace camway::c {
namespace {

/// Window of signed messages, as `authentication_from` has it.
constexpr double kKeyWindow_s = 30.0;

std::shared_ptr<const Authentication> authentication_of(const camway_client_options& given) {
  if (given.key_file == nullptr) return nullptr;
  if (&authentication_from == nullptr) {
    throw Refusal{CAMWAY_INVALID,
                  "key_file: the static library cannot sign; link libcamway_c.so"};
  }
  LoadedAuthentication loaded = authentication_from(given.key_file, given.key_window_s);
  if (!loaded.authentication) throw Refusal{CAMWAY_INVALID, std::move(loaded.error)};
  return std::move(loaded.authentication);
}

camway_client_options default_options() {
  const ClientOptions defaults;
  camway_client_options options{};
  options.retries = defaults.retries;
  options.deadline_s = defaults.deadline_s;
  options.change_deadline_s = defaults.change_deadline_s;
  options.try_timeout_s = defaults.try_timeout_s;
  options.max_try_timeout_s = defaults.max_try_timeout_s;
  options.watch_lease_s = defaults.watch_lease_s;
  options.key_window_s = kKeyWindow_s;
  return options;
}

ClientOptions options_of(const camway_client_options& given) {
  ClientOptions options;
  options.url = optional_text(given.url);
  if (given.prefix != nullptr) options.prefix = given.prefix;
  options.client_id = optional_text(given.client_id);
  options.retries = given.retries;
  options.deadline_s = given.deadline_s;
  options.change_deadline_s = given.change_deadline_s;
  options.try_timeout_s = given.try_timeout_s;
  options.max_try_timeout_s = given.max_try_timeout_s;
  options.watch_lease_s = given.watch_lease_s;
  options.authentication = authentication_of(given);
  return options;
}

camway_daemon_status daemon_status_of(const DaemonStatus& from) {
  camway_daemon_status status{};
  status.num_workers = from.num_workers;
  status.num_scenes = from.total_scenes;
  status.queued_requests = from.queued_requests;
  status.running_requests = from.running_requests;
  status.durable = from.daemon_start.durable;
  status.start_id = from.daemon_start.id;
  status.uptime_s = from.uptime_s;
  from.version.copy(status.version, sizeof status.version - 1);
  return status;
}

/// A client without a network has one status for all faults: only its text tells of a bad option.
camway_status why_unusable(Client& client) {
  return returned(client.status(0.0).status, client.error());
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_client_options_init(camway_client_options* options, size_t struct_size) {
  return guarded([&] {
    init_sized(default_options(), options, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_client_create(const camway_client_options* options, camway_client** client) {
  return guarded([&] {
    require(client, "client");
    *client = nullptr;
    const camway_client_options given =
        options == nullptr ? default_options() : read_sized(options, default_options(), "options");
    auto made = std::make_shared<camway::Client>(options_of(given));
    if (!made->good()) return why_unusable(*made);
    *client = Handles::all().add<camway_client>(std::move(made));
    return camway_status{CAMWAY_OK};
  });
}

camway_status camway_client_free(camway_client* client) {
  return guarded([&] {
    Handles::all().take(client);
    return CAMWAY_OK;
  });
}

const char* camway_client_id(const camway_client* client) {
  return guarded_text([&] { return Handles::all().find(client)->client_id().c_str(); });
}

camway_status camway_daemon_status_get(camway_client* client, double timeout_s,
                                       camway_daemon_status* status, size_t struct_size) {
  return guarded([&] {
    require(status, "status");
    require_size<camway_daemon_status>(struct_size);
    const camway::DaemonStatus heard = Handles::all().find(client)->status(timeout_s);
    write_sized(daemon_status_of(heard), status, struct_size);
    return returned(heard.status, heard.error);
  });
}
