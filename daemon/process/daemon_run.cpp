// SPDX-License-Identifier: MIT
#include "daemon/process/daemon_run.h"

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "daemon/planning/plan.h"
#include "daemon/process/metrics/metrics_text.h"
#include "daemon/process/process_signals.h"
#include "daemon/process/service_manager.h"
#include "daemon/service/scenes/upload_file.h"
#include "daemon/service/service.h"
#include "daemon/service/transport/auth_transport.h"
#include "daemon/service/transport/lcm_transport.h"

namespace camway::process {
namespace {

constexpr int kExitLcm = 1;
constexpr int kExitMetrics = 1;
constexpr int kExitPrefix = 1;
constexpr int kExitBadInput = 2;
/// How long a start waits for an answer of another daemon with its prefix, which takes
/// milliseconds.
constexpr std::chrono::milliseconds kClaimWindow{250};

/// The last status, written by the loop and read by the page of metrics.
/// Thread-safe.
class LatestStatus {
 public:
  void set(const status_t& status) {
    const std::lock_guard lock(mutex_);
    status_ = status;
  }
  [[nodiscard]] status_t get() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }

 private:
  mutable std::mutex mutex_;  ///< guards status_
  status_t status_{};
};

/// Writes the counts of distrusted messages into the status.
void add_distrusted(const service::AuthTransport::Distrusted& counts, status_t& status) {
  const auto count = [&](wire::Distrust why) { return counts.at(static_cast<std::size_t>(why)); };
  status.unsigned_messages = count(wire::Distrust::kUnsigned);
  status.broken_envelopes = count(wire::Distrust::kBroken);
  status.unknown_key_messages = count(wire::Distrust::kUnknownKey);
  status.altered_messages = count(wire::Distrust::kAltered);
  status.stale_messages = count(wire::Distrust::kStale);
  status.replayed_messages = count(wire::Distrust::kReplayed);
  status.crowded_messages = count(wire::Distrust::kCrowded);
}

/// Returns the signer and checker of messages; null without a key file.
base::Result<std::shared_ptr<wire::MessageAuth>> open_auth(const AuthOptions& options) {
  if (options.key_file.empty()) return std::shared_ptr<wire::MessageAuth>();
  wire::MessageKeys::Read read = wire::MessageKeys::from_file(options.key_file);
  if (!read.keys) return base::Failure{std::move(read.error)};
  wire::ReplayGuard::Limits limits;
  limits.senders = options.senders;
  limits.window_us = std::chrono::microseconds(options.window).count();
  return std::make_shared<wire::MessageAuth>(std::move(read.keys), limits);
}

/// Opens the page for Prometheus; null if the options ask for none.
base::Result<std::unique_ptr<HttpPage>> open_metrics(const DaemonOptions& options,
                                                     const LatestStatus& latest,
                                                     const std::shared_ptr<service::Log>& log) {
  if (options.metrics.port == 0) return std::unique_ptr<HttpPage>();
  HttpContent content;
  content.path = "/metrics";
  content.type = "text/plain; version=0.0.4; charset=utf-8";
  content.text = [&latest] { return metrics_text(latest.get()); };
  // Used by the page's thread alone, since limited logs are not thread-safe.
  const auto crowded = std::make_shared<service::LimitedLog>(log, service::LogLevel::kWarn,
                                                             "metrics", options.service.log_limits);
  content.full = [crowded, most = options.metrics_limits.connections] {
    crowded->write("the page of metrics has as many connections as it may",
                   {{"metrics.connections", most}});
  };
  return open_http_page(options.metrics, std::move(content), options.metrics_limits);
}

/// Returns the exit code for the outcome of a run. Ends the process itself after kAbandoned.
int exit_code_of(service::RunOutcome outcome, const std::string& url, service::Log& log) {
  switch (outcome) {
    case service::RunOutcome::kDrained:
      return EXIT_SUCCESS;
    case service::RunOutcome::kAbandoned:
      std::_Exit(EXIT_SUCCESS);
    case service::RunOutcome::kPrefixTaken:
      return kExitPrefix;
    case service::RunOutcome::kNotSubscribed:
      log.error("LCM takes no subscription", {{"url", url}, {"hint", service::multicast_hint()}});
      return kExitLcm;
    case service::RunOutcome::kTransportBroken:
      log.error("LCM failed", {{"url", url}});
      return kExitLcm;
  }
  return kExitLcm;
}

}  // namespace

int serve(const DaemonOptions& options, Reloader::Read read_again, scene::SceneStore& scenes,
          ConfiguredScenes& configured, const std::shared_ptr<service::Log>& log) {
  if (const std::string other = url_of_environment(); !other.empty() && other != options.lcm_url) {
    log->warn("LCM_DEFAULT_URL is set, but does not count",
              {{"LCM_DEFAULT_URL", other}, {"url", options.lcm_url}});
  }
  const base::Result<std::unique_ptr<service::Transport>> opened =
      service::open_lcm_transport(options.lcm_url, [&](const std::string& reason) {
        log->warn("what other hosts send is heard in spite of ttl 0", {{"reason", reason}});
      });
  if (!opened) {
    log->error("LCM cannot be used", {{"reason", opened.error}});
    return kExitLcm;
  }
  const base::Result<std::shared_ptr<wire::MessageAuth>> auth = open_auth(options.auth);
  if (!auth) {
    log->error("keys cannot be used",
               {{"setting", options.where("auth.key_file")}, {"reason", auth.error}});
    return kExitBadInput;
  }
  std::optional<service::AuthTransport> signing;
  if (*auth) {
    signing.emplace(**opened, *auth, options.auth.required,
                    service::LimitedLog(log, service::LogLevel::kWarn, "distrusted",
                                        options.service.log_limits));
    log->info("messages are signed",
              {{"unsigned_ones", options.auth.required ? "dropped" : "accepted"}});
  }
  service::Transport& transport = signing ? static_cast<service::Transport&>(*signing) : **opened;
  LatestStatus latest;
  const base::Result<std::unique_ptr<HttpPage>> metrics = open_metrics(options, latest, log);
  if (!metrics) {
    log->error("there can be no page of metrics", {{"reason", metrics.error}});
    return kExitMetrics;
  }
  const ServiceManager manager = ServiceManager::from_environment();
  ReloadRecord reloads;
  service::ServiceHooks hooks;
  hooks.ready = [&] { manager.ready("serving"); };
  hooks.stopping = [&] { manager.stopping(); };
  hooks.alive = [&] { manager.alive(); };
  if (*metrics) {
    log->info("page of metrics", {{"address", options.metrics.ip}, {"port", (*metrics)->port()}});
  }
  hooks.status = [&](status_t& status) {
    if (signing) {
      add_distrusted(signing->distrusted(), status);
      signing->tell_left_out();
    }
    status.signed_only = signing && options.auth.required ? 1 : 0;
    reloads.add_to(status);
    if (*metrics) latest.set(status);
  };
  hooks.alive_period = manager.alive_period();
  const service::Planner planner =
      [](const scene::Snapshot& snapshot, const planning::PlanRequest& request,
         const base::Deadline& deadline) { return planning::plan(snapshot, request, deadline); };
  if (const std::size_t files = service::remove_left_upload_files(); files > 0) {
    log->info("removed uploads that a daemon left behind", {{"files", files}});
  }
  service::ServiceConfig config = options.service;
  config.claim_window = options.share_prefix ? std::chrono::milliseconds(0) : kClaimWindow;
  service::Service service(transport, scenes, std::move(config), planner, log, std::move(hooks));
  log->info("serving", {{"url", options.lcm_url},
                        {"prefix", options.service.prefix},
                        {"workers", options.service.workers},
                        {"scene_workers", options.service.scene_workers},
                        {"queue", options.service.queue.jobs},
                        {"client_queue", options.service.queue.jobs_of_a_client}});
  Reloader reloader(options, std::move(read_again), configured, reloads, manager, log, *auth);
  const SignalWaiter signals(
      [&](int signal) {
        log->info("signal", {{"number", signal}});
        service.request_stop();
      },
      [&] { reloader.request(); });
  return exit_code_of(service.run(), options.lcm_url, *log);
}

}  // namespace camway::process
